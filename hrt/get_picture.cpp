#include "hrt/get_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "hrt/error.hpp"
#include "hrt/picture_codec.hpp"

namespace kenaf::hrt {
namespace {

using PictureClock = CameraStream::Clock;

// The wait ends at most this long after the robot's link breaks.
constexpr std::chrono::milliseconds kWaitSlice{50};

std::shared_ptr<const CameraPicture> wait_for_picture(Robot& robot, CameraStream& stream, std::uint64_t had,
                                                      double timeout_s) {
  const PictureClock::time_point now = PictureClock::now();
  std::shared_ptr<const CameraPicture> found = stream.wait(had, now);
  if (found || timeout_s == 0) return found;
  const PictureClock::time_point until =
      now + std::chrono::duration_cast<PictureClock::duration>(std::chrono::duration<double>(timeout_s));
  robot.wait_while_cycling([&] {
    const PictureClock::time_point slice = std::min(until, PictureClock::now() + kWaitSlice);
    found = stream.wait(had, slice);
    return found || slice == until;
  });
  return found;
}

}  // namespace

void get_picture(Robot& robot, Cameras& cameras, const std::string& camera, int format, std::span<std::uint8_t> data,
                 double timeout_s, hrt_picture& picture) {
  robot.note_call();
  const std::shared_ptr<CameraStream> stream = cameras.stream(camera);
  std::shared_ptr<const CameraPicture> found;
  try {
    found = wait_for_picture(robot, *stream, picture.number, timeout_s);
  } catch (const Error&) {
    if (!robot.is_lost()) cameras.drop(stream);
    throw;
  }
  if (!found) {
    throw Error(HRT_E_TIMEOUT,
                fmt::format("hrt_get_picture: no {} picture of {} within {} s", picture.number == 0 ? "first" : "other",
                            camera.empty() ? "the first camera" : "camera " + camera, timeout_s));
  }

  // A picture that cannot be decoded counts as delivered: the next call must not get it again.
  const std::uint64_t had = std::exchange(picture.number, found->number);
  const PictureSize size = picture_size(*found);
  std::vector<std::uint8_t> made;
  std::span<const std::uint8_t> file;
  if (format == HRT_PICTURE_JPEG) file = jpeg_file(*found, made);
  const std::size_t bytes = format == HRT_PICTURE_JPEG ? file.size() : size.rgb_bytes();
  const auto describe = [&] {
    picture.format = format;
    picture.width = size.width;
    picture.height = size.height;
    picture.bytes = bytes;
    std::ranges::fill(picture.camera, '\0');
    found->camera.copy(picture.camera, sizeof picture.camera - 1);
  };
  if (bytes > data.size()) {
    picture.number = had;
    describe();
    throw Error(
        HRT_E_ARGUMENT,
        fmt::format(
            "hrt_get_picture: the picture of {} x {} pixels needs {} bytes (see picture->bytes), but capacity is {}",
            size.width, size.height, bytes, data.size()));
  }
  if (format == HRT_PICTURE_JPEG) {
    std::ranges::copy(file, data.begin());
  } else {
    write_rgb(*found, data.first(bytes));
  }
  describe();
  picture.time_s = picture.age_ms = -1;
  if (found->robot_time_s) picture.time_s = *found->robot_time_s;
  if (found->exposed_at) {
    if (!found->robot_time_s) picture.time_s = robot.robot_time_at(*found->exposed_at).value_or(-1);
    picture.age_ms = std::chrono::duration<double, std::milli>(PictureClock::now() - *found->exposed_at).count();
  }
}

}  // namespace kenaf::hrt
