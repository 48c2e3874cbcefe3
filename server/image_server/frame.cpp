#include "server/image_server/frame.hpp"

#include "formats/protocol/image_message.hpp"

namespace kenaf::image_server {

namespace {

constexpr std::size_t kStartOfImage_bytes = 2;
constexpr std::size_t kLongestName = 128;

}  // namespace

double age_s(const Frame& frame, SteadyTime now) {
  return std::chrono::duration<double>(now - frame.exposed).count();
}

std::string stamped_start(const Frame& frame, double age_s) {
  return "\xff\xd8" + protocol::image::frame_note_segment({frame.number, frame.robot_time_s, 1e3 * age_s,
                                                           frame.robot.substr(0, kLongestName),
                                                           frame.camera.substr(0, kLongestName)});
}

std::span<const std::uint8_t> after_start(std::span<const std::uint8_t> jpeg) {
  return jpeg.subspan(kStartOfImage_bytes);
}

}  // namespace kenaf::image_server
