#include "libkenaf_sim/image_client.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hrt/error.hpp"

namespace kenaf::sim {
namespace {

// A Kenaf server answers 'J' within a second, if only with the previous picture.
constexpr std::chrono::milliseconds kOldServerAfter{1000};
// A Kenaf server whose world has stopped before the first picture reports that after 10 s. This patience keeps no
// caller waiting: the calls have their own time limits.
constexpr double kPatienceWithSilence = 5;
// A picture is requested once this share of the interval between the last two has passed. It does not exist earlier, so
// nothing is lost, and the age, which counts from the request, is hardly too large. If the world's speed changes, at
// most one picture is late by this.
constexpr double kRequestAfter = 0.8;
constexpr std::chrono::milliseconds kLongestPause{100};
// Limit on the server text that is passed on.
constexpr std::size_t kMaxRefusalBytes = 400;

std::string printable(std::span<const std::uint8_t> words) {
  std::string text(words.begin(),
                   words.begin() + static_cast<std::ptrdiff_t>(std::min(words.size(), kMaxRefusalBytes)));
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

ImageClient::ImageClient(const hrt_config& config, const std::string& camera, AskForAddresses ask)
    : server_(config.camera_server),
      camera_(camera),
      ask_(std::move(ask)),
      patience_(config.connect_timeout_s),
      silence_(kPatienceWithSilence * patience_),
      interrupt_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (interrupt_ < 0) throw hrt::Error(HRT_E_INTERNAL, fmt::format("eventfd: {}", std::strerror(errno)));
}

ImageClient::~ImageClient() {
  if (socket_ >= 0) ::close(socket_);
  ::close(interrupt_);
}

void ImageClient::interrupt() {
  const std::uint64_t one = 1;
  // The write fails only if the eventfd's count would overflow, and then it is readable already.
  [[maybe_unused]] const ssize_t written = write(interrupt_, &one, sizeof one);
}

ImageClient::Ready ImageClient::wait_for(short events, Clock::time_point until) const {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    std::array<pollfd, 2> watched{{{socket_, events, 0}, {interrupt_, POLLIN, 0}}};
    const int ready = poll(watched.data(), watched.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (watched[1].revents != 0) return Ready::interrupted;
    if (ready > 0) return Ready::yes;
    if (left <= 0) return Ready::time_is_up;
  }
}

std::optional<int> ImageClient::connect_to(const Address& address, Clock::time_point until) {
  socket_ = socket(address.address.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return errno;
  if (connect(socket_, address.plain(), address.size) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  switch (wait_for(POLLOUT, until)) {
    case Ready::interrupted:
      return std::nullopt;
    case Ready::time_is_up:
      return ETIMEDOUT;
    case Ready::yes:
      break;
  }
  int wrong = 0;
  socklen_t size = sizeof wrong;
  getsockopt(socket_, SOL_SOCKET, SO_ERROR, &wrong, &size);
  return wrong;
}

void ImageClient::open() {
  const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(patience_);
  const std::optional<Addresses> found = look_up("camera_server", server_, SOCK_STREAM, deadline, interrupt_, ask_);
  if (!found) return;
  std::string why;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const std::optional<int> wrong = connect_to((*found)[i], end_of_share(Clock::now(), deadline, found->size() - i));
    if (!wrong) return;
    if (*wrong == 0) {
      const int on = 1;
      setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      // An old server understands requests for pictures only, so nothing else is sent unless a certain camera is
      // requested.
      if (!camera_.empty()) send_all(protocol::image::select_request(camera_));
      return;
    }
    why = std::strerror(*wrong);
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }
  throw hrt::Error(
      HRT_E_LINK,
      fmt::format("no server of camera pictures at {}: {}; start kenaf-world or kenaf-relayd --embedded, or set "
                  "camera_server in kenaf.toml or KENAF_CAMERA_SERVER",
                  server_, why));
}

void ImageClient::lose(const std::string& why) const {
  throw hrt::Error(HRT_E_LINK, fmt::format("the camera server at {} {}; the next call reconnects", server_, why));
}

void ImageClient::send_all(std::string_view bytes) {
  // A few bytes into an empty kernel buffer: if they do not fit, the server has not read for a long time.
  const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent < 0) lose(fmt::format("is gone: {}", std::strerror(errno)));
  if (static_cast<std::size_t>(sent) != bytes.size()) lose("does not take requests");
}

void ImageClient::request() {
  requested_at_ = Clock::now();
  send_all(is_old_server_ ? protocol::image::kOldRequest : protocol::image::kJpegRequest);
}

bool ImageClient::receive_some() {
  const ssize_t size = recv(socket_, buffer_.data(), buffer_.size(), 0);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (size < 0) lose(fmt::format("is gone: {}", std::strerror(errno)));
  if (size == 0) lose("closed the connection");
  unread_ = std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(size));
  return true;
}

bool ImageClient::read_answer() {
  const auto patience = std::chrono::duration_cast<Clock::duration>(silence_);
  Clock::time_point until = requested_at_ + std::max<Clock::duration>(patience, kOldServerAfter + patience / 2);
  bool may_be_old = !is_kenaf_server_ && !is_old_server_;
  for (;;) {
    try {
      if (reader_.take(unread_)) return true;
    } catch (const std::runtime_error& error) {
      lose(fmt::format("sent {}", error.what()));
    }
    const Clock::time_point old_at = requested_at_ + kOldServerAfter;
    switch (wait_for(POLLIN, may_be_old ? std::min(old_at, until) : until)) {
      case Ready::interrupted:
        return false;
      case Ready::yes:
        // A large picture over a slow network takes long; silence must not.
        if (receive_some()) until = std::max(until, Clock::now() + patience);
        break;
      case Ready::time_is_up:
        if (!may_be_old || !reader_.is_between())
          lose(fmt::format("says nothing{}", reader_.is_between() ? "" : " more in the middle of a picture"));
        may_be_old = false;
        is_old_server_ = true;
        request();
        until = requested_at_ + patience;
    }
  }
}

std::optional<hrt::CameraPicture> ImageClient::next() {
  if (socket_ < 0) return std::nullopt;  // interrupted while connecting
  if (wait_for(0, request_at_) == Ready::interrupted) return std::nullopt;
  request();
  if (!read_answer()) return std::nullopt;
  return picture_of_answer();
}

hrt::CameraPicture ImageClient::picture_of_answer() {
  protocol::image::Answer answer = std::exchange(reader_.answer, {});
  if (answer.type == protocol::image::kRefused)
    throw hrt::Error(HRT_E_DEVICE, fmt::format("{}: {}", camera_.empty() ? "no camera" : "camera '" + camera_ + "'",
                                               printable(answer.data)));
  hrt::CameraPicture picture;
  if (answer.type == protocol::image::kRaw) {
    std::optional<protocol::image::RawPicture> raw = protocol::image::read_raw_picture(answer.data);
    if (!raw) lose(fmt::format("sent a raw picture of {} bytes, which are not those of its size", answer.data.size()));
    picture.encoding = hrt::CameraPicture::Encoding::rgb;
    picture.width = raw->width;
    picture.height = raw->height;
    picture.bytes = std::move(raw->rgb);
  } else {
    if (!protocol::image::is_whole_jpeg(answer.data)) lose("sent a picture that is not a complete JPEG");
    picture.bytes = std::move(answer.data);
  }
  std::optional<protocol::image::FrameNote> note;
  if (picture.encoding == hrt::CameraPicture::Encoding::jpeg) note = protocol::image::read_frame_note(picture.bytes);
  if (note) {
    is_kenaf_server_ = true;
    is_old_server_ = false;  // it was only slow
  }
  if (!note) {
    picture.number = ++counted_;
    return picture;
  }
  const Clock::time_point now = Clock::now();
  request_at_ = now;
  if (note->number != newest_number_) {
    const auto pause = std::chrono::duration_cast<Clock::duration>(kRequestAfter * (now - newest_at_));
    request_at_ += std::min<Clock::duration>(pause, kLongestPause);
    newest_number_ = note->number;
    newest_at_ = now;
  }
  picture.number = note->number;
  picture.robot_time_s = note->robot_time_s;
  picture.camera = note->camera;
  // The picture was sent after it was requested: counted from the request, the age is never too small.
  const std::chrono::duration<double, std::milli> age(note->age_ms);
  constexpr std::chrono::hours kOldest{24 * 365};
  picture.exposed_at =
      requested_at_ - (age < kOldest ? std::chrono::duration_cast<Clock::duration>(age) : Clock::duration(kOldest));
  return picture;
}

}  // namespace kenaf::sim
