#include "libkenaf_real/v4l2_camera.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "formats/protocol/image_message.hpp"
#include "hrt/error.hpp"

namespace kenaf::real {
namespace {

using Encoding = hrt::CameraPicture::Encoding;
using SteadyTime = std::chrono::steady_clock::time_point;

// As many as the driver fills while the reading thread is held up.
constexpr std::uint32_t kBufferCount = 4;
// A webcam may take a second for its first picture; after that it counts as silent when this, or the time of ten
// pictures, has passed.
constexpr double kSilence_s = 3;
constexpr double kSilentPictures = 10;

constexpr struct {
  std::uint32_t pixel_format;
  Encoding encoding;
} kFormats[] = {
    {V4L2_PIX_FMT_MJPEG, Encoding::jpeg}, {V4L2_PIX_FMT_JPEG, Encoding::jpeg}, {V4L2_PIX_FMT_YUYV, Encoding::yuyv}};

std::string format_name(std::uint32_t pixel_format) {
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) name += static_cast<char>(pixel_format >> shift & 0x7f);
  std::ranges::replace_if(
      name, [](char c) { return c < 0x20 || c == 0x7f; }, '?');
  return name;
}

template <typename Struct>
Struct of_capture() {
  Struct argument{};
  argument.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return argument;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> bytes_of_buffer(Encoding encoding, int width, int height,
                                                         std::size_t row_bytes, std::span<const std::uint8_t> buffer) {
  if (encoding == Encoding::jpeg) {
    if (!protocol::image::is_whole_jpeg(buffer)) return std::nullopt;
    return std::vector<std::uint8_t>(buffer.begin(), buffer.end());
  }
  const std::size_t row = std::size_t{2} * static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  if (row_bytes < row || buffer.size() < row_bytes * (rows - 1) + row) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(row * rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto from = buffer.subspan(i * row_bytes, row);
    bytes.insert(bytes.end(), from.begin(), from.end());
  }
  return bytes;
}

V4l2Camera::V4l2Camera(CameraOnRobot camera)
    : camera_(std::move(camera)), interrupt_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (interrupt_ < 0) throw hrt::Error(HRT_E_INTERNAL, fmt::format("eventfd: {}", std::strerror(errno)));
}

V4l2Camera::~V4l2Camera() {
  for (const Buffer& buffer : buffers_) munmap(buffer.memory, buffer.bytes);
  if (device_ >= 0) ::close(device_);  // which also ends the stream
  ::close(interrupt_);
}

void V4l2Camera::interrupt() {
  const std::uint64_t one = 1;
  // The write fails only if the eventfd's count would overflow, and then it is readable already.
  [[maybe_unused]] const ssize_t written = write(interrupt_, &one, sizeof one);
}

void V4l2Camera::fail(const std::string& why) const {
  throw hrt::Error(HRT_E_DEVICE,
                   fmt::format("camera '{}': {} {}; the next call reopens it", camera_.name, camera_.device, why));
}

bool V4l2Camera::control(unsigned long request, void* argument, const char* what, int expected) const {
  int result = 0;
  do {
    result = ioctl(device_, request, argument);
  } while (result < 0 && errno == EINTR);
  if (result >= 0) return true;
  if (expected != 0 && errno == expected) return false;
  if (errno == ENODEV) fail("is gone: it was unplugged");
  if (errno == EBUSY) fail("is in use by another program");
  fail(fmt::format("{}: {}", what, std::strerror(errno)));
}

void V4l2Camera::open() {
  device_ = ::open(camera_.device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device_ < 0) {
    if (errno == ENOENT) fail("does not exist: is the camera plugged in, and its driver loaded?");
    if (errno == EACCES) fail("is not accessible: add this user to the group video");
    fail(fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  check_that_it_is_a_camera();
  set_format();
  set_rate();
  map_buffers();
}

void V4l2Camera::check_that_it_is_a_camera() const {
  v4l2_capability has{};
  if (!control(VIDIOC_QUERYCAP, &has, "", ENOTTY)) fail("is not a video device");
  const std::uint32_t can = (has.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? has.device_caps : has.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0)
    fail("is a video device, but takes no pictures: the second device of a webcam has its metadata");
}

void V4l2Camera::set_format() {
  // All formats that the device offers, for the choice and for the error message.
  std::vector<std::uint32_t> offered;
  auto description = of_capture<v4l2_fmtdesc>();
  for (; description.index < 256 && control(VIDIOC_ENUM_FMT, &description, "names no formats", EINVAL);
       ++description.index)
    offered.push_back(description.pixelformat);

  // The first of kFormats that the device sets exactly as asked: S_FMT may answer with another format or size.
  std::string sizes;
  for (const auto& [pixel_format, encoding] : kFormats) {
    if (std::ranges::find(offered, pixel_format) == offered.end()) continue;
    auto format = of_capture<v4l2_format>();
    format.fmt.pix.width = static_cast<std::uint32_t>(camera_.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(camera_.height);
    format.fmt.pix.pixelformat = pixel_format;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    (void)control(VIDIOC_S_FMT, &format, "refuses a format");
    const v4l2_pix_format& set = format.fmt.pix;
    if (set.pixelformat == pixel_format && set.width == static_cast<std::uint32_t>(camera_.width) &&
        set.height == static_cast<std::uint32_t>(camera_.height)) {
      encoding_ = encoding;
      row_bytes_ = set.bytesperline;
      return;
    }
    sizes += fmt::format("{}{} {}", sizes.empty() ? "" : "; ", format_name(pixel_format), sizes_of(pixel_format));
  }

  // No match: report the sizes of the supported formats or, without such formats, the device's formats.
  if (sizes.empty()) {
    std::string names;
    for (const std::uint32_t format : offered) names += (names.empty() ? "" : ", ") + format_name(format);
    fail(fmt::format("gives neither MJPG nor YUYV; it has: {}", names.empty() ? "nothing" : names));
  }
  fail(fmt::format("has no pictures of {} x {}; it has: {}; set width and height of its [[camera]]", camera_.width,
                   camera_.height, sizes));
}

std::string V4l2Camera::sizes_of(std::uint32_t pixel_format) const {
  std::string sizes;
  v4l2_frmsizeenum size{};
  size.pixel_format = pixel_format;
  for (; size.index < 32 && control(VIDIOC_ENUM_FRAMESIZES, &size, "names no sizes", EINVAL); ++size.index) {
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
      return fmt::format("{} x {} to {} x {} in steps of {} x {}", size.stepwise.min_width, size.stepwise.min_height,
                         size.stepwise.max_width, size.stepwise.max_height, size.stepwise.step_width,
                         size.stepwise.step_height);
    }
    sizes += fmt::format("{}{} x {}", sizes.empty() ? "" : ", ", size.discrete.width, size.discrete.height);
  }
  return sizes.empty() ? "of other sizes" : sizes;
}

void V4l2Camera::set_rate() {
  auto parameters = of_capture<v4l2_streamparm>();
  v4l2_fract& period = parameters.parm.capture.timeperframe;
  period = {.numerator = 1000, .denominator = static_cast<std::uint32_t>(std::lround(1000 * camera_.rate_hz))};
  // Devices with a fixed rate do not support the request.
  const bool known = control(VIDIOC_S_PARM, &parameters, "refuses a rate", ENOTTY);
  period_ = std::chrono::duration<double>(1 / camera_.rate_hz);
  if (known && period.numerator > 0 && period.denominator > 0)
    period_ = std::chrono::duration<double>(static_cast<double>(period.numerator) / period.denominator);
}

void V4l2Camera::map_buffers() {
  v4l2_requestbuffers wanted = of_capture<v4l2_requestbuffers>();
  wanted.count = kBufferCount;
  wanted.memory = V4L2_MEMORY_MMAP;
  (void)control(VIDIOC_REQBUFS, &wanted, "gives no buffers");
  for (std::uint32_t i = 0; i < wanted.count; ++i) {
    auto buffer = of_capture<v4l2_buffer>();
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    (void)control(VIDIOC_QUERYBUF, &buffer, "gives no buffer");
    void* memory = mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_, buffer.m.offset);
    if (memory == MAP_FAILED) fail(fmt::format("its buffers cannot be mapped: {}", std::strerror(errno)));
    buffers_.push_back({memory, buffer.length});
  }
}

void V4l2Camera::start() {
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    auto buffer = of_capture<v4l2_buffer>();
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    (void)control(VIDIOC_QBUF, &buffer, "takes no buffer");
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)control(VIDIOC_STREAMON, &type, "does not start");
  streams_ = true;
  first_number_ = newest_number_ + 1;  // the driver's count restarts at 0
}

void V4l2Camera::pause() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (streams_) (void)control(VIDIOC_STREAMOFF, &type, "does not stop");
  streams_ = false;
}

std::optional<hrt::CameraPicture> V4l2Camera::next() {
  if (!streams_) start();
  const auto silence = std::chrono::duration<double>(std::max(kSilence_s, kSilentPictures * period_.count()));
  const SteadyTime until =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::milliseconds>(silence);
  for (;;) {
    // Takes the newest of several filled buffers: the others are only older.
    std::optional<hrt::CameraPicture> newest;
    for (bool was_filled = true; was_filled;) {
      if (std::optional<hrt::CameraPicture> picture = take(was_filled)) newest = std::move(picture);
    }
    if (newest) return newest;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()).count();
    if (left <= 0) fail(fmt::format("has given no whole picture for {:.1f} s", silence.count()));
    std::array<pollfd, 2> watched{{{device_, POLLIN, 0}, {interrupt_, POLLIN, 0}}};
    poll(watched.data(), watched.size(), static_cast<int>(left));
    if (watched[1].revents != 0) return std::nullopt;
    // A device that is gone is always ready, with an error; dequeuing a buffer tells which.
    if ((watched[0].revents & (POLLERR | POLLHUP)) != 0 && (watched[0].revents & POLLIN) == 0) {
      bool was_filled = false;
      if (std::optional<hrt::CameraPicture> picture = take(was_filled)) return picture;
      if (!was_filled) fail("is gone: it was unplugged, or its driver has stopped it");
    }
  }
}

std::optional<hrt::CameraPicture> V4l2Camera::take(bool& was_filled) {
  auto buffer = of_capture<v4l2_buffer>();
  buffer.memory = V4L2_MEMORY_MMAP;
  was_filled = control(VIDIOC_DQBUF, &buffer, "gives no picture", EAGAIN);
  if (!was_filled) return std::nullopt;
  if (buffer.index >= buffers_.size()) fail("gives a buffer that does not exist");
  hrt::CameraPicture picture;
  const bool is_damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  const Buffer& filled = buffers_[buffer.index];
  const std::span<const std::uint8_t> bytes(static_cast<const std::uint8_t*>(filled.memory),
                                            std::min<std::size_t>(buffer.bytesused, filled.bytes));
  std::optional<std::vector<std::uint8_t>> copy;
  if (!is_damaged) copy = bytes_of_buffer(encoding_, camera_.width, camera_.height, row_bytes_, bytes);
  v4l2_buffer empty = buffer;  // the returned buffer loses the information about its picture
  (void)control(VIDIOC_QBUF, &empty, "takes no buffer back");
  if (!copy) return std::nullopt;
  picture.encoding = encoding_;
  picture.width = camera_.width;
  picture.height = camera_.height;
  picture.number = newest_number_ = std::max(newest_number_ + 1, first_number_ + buffer.sequence);
  picture.jpeg_quality = camera_.jpeg_quality;
  picture.camera = camera_.name;
  picture.bytes = *std::move(copy);
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    // CLOCK_MONOTONIC, which is the steady clock's
    const auto stamp =
        std::chrono::seconds(buffer.timestamp.tv_sec) + std::chrono::microseconds(buffer.timestamp.tv_usec);
    SteadyTime exposed_at{std::chrono::duration_cast<SteadyTime::duration>(stamp)};
    // A stamp at the end of a picture comes after exposure and readout: up to one picture period late.
    if ((buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) != V4L2_BUF_FLAG_TSTAMP_SRC_SOE)
      exposed_at -= std::chrono::duration_cast<SteadyTime::duration>(period_);
    picture.exposed_at = exposed_at;
  }
  return picture;
}

}  // namespace kenaf::real
