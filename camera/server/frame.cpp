#include "camera/server/frame.hpp"

#include <fmt/format.h>

namespace kenaf::camera {

namespace {

constexpr std::size_t kStartOfImage_bytes = 2;
constexpr std::size_t kLongestName = 128;

}  // namespace

double age_s(const Frame& frame, SteadyTime now) {
  return std::chrono::duration<double>(now - frame.exposed).count();
}

std::string stamped_start(const Frame& frame, double age_s) {
  const std::string text = fmt::format("kenaf-frame/1 number={} robot_time_s={:.6f} age_ms={:.3f} robot={} camera={}",
                                       frame.number, frame.robot_time_s, 1e3 * age_s,
                                       frame.robot.substr(0, kLongestName), frame.camera.substr(0, kLongestName));
  const std::size_t length = text.size() + 2;  // of the segment, its length included
  std::string out("\xff\xd8\xff\xfe", 4);
  out += static_cast<char>(length >> 8);
  out += static_cast<char>(length & 0xff);
  return out + text;
}

std::span<const std::uint8_t> after_start(std::span<const std::uint8_t> jpeg) {
  return jpeg.subspan(kStartOfImage_bytes);
}

}  // namespace kenaf::camera
