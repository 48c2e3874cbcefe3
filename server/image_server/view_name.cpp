#include "server/image_server/view_name.hpp"

#include <algorithm>

#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::image_server {

namespace {

constexpr std::size_t kMostNamed = 16;

// A reader's bytes, made safe for a text answer.
std::string quoted(std::string_view text) {
  std::string out(text.substr(0, 80));
  std::ranges::replace_if(
      out, [](char c) { return c < ' ' || c > '~'; }, '?');
  return '"' + out + '"';
}

bool is_meant(const camera::RobotSnapshot& robot, std::string_view words) {
  if (words.starts_with('#')) return words == view_of(robot.id);
  return protocol::usarsim::equal_ignoring_case(robot.name, words);
}

}  // namespace

std::string view_of(physics::RobotId robot) {
  return '#' + std::to_string(static_cast<std::uint32_t>(robot));
}

std::optional<CameraId> find_view(const std::vector<camera::RobotSnapshot>& robots, std::string_view view) {
  const std::size_t slash = view.rfind('/');
  const bool names_robot = slash != std::string_view::npos;
  const std::string_view robot_name = view.substr(0, names_robot ? slash : 0);
  const std::string_view camera_name = view.substr(names_robot ? slash + 1 : 0);
  for (auto found = robots.rbegin(); found != robots.rend(); ++found) {  // clang 14 lacks std::views::reverse
    const camera::RobotSnapshot& robot = *found;
    if (names_robot && !is_meant(robot, robot_name)) continue;
    const auto& cameras = robot.description->cameras;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const bool is_default = view.empty();
      if (is_default || protocol::usarsim::equal_ignoring_case(cameras[i].name, camera_name))
        return CameraId{robot.id, i};
    }
  }
  return std::nullopt;
}

std::string no_such_view(const std::vector<camera::RobotSnapshot>& robots, std::string_view view) {
  if (robots.empty()) return "there is no robot in the world, hence no camera";
  std::string instead;
  std::size_t named = 0, cameras = 0;
  for (const camera::RobotSnapshot& robot : robots) {
    for (const physics::CameraDescription& camera : robot.description->cameras) {
      ++cameras;
      if (named == kMostNamed || instead.size() > 700) continue;
      ++named;
      instead += (instead.empty() ? "" : ", ") + robot.name.substr(0, 80) + '/' + camera.name.substr(0, 80);
    }
  }
  if (cameras == 0) return "no robot in the world has a camera";
  if (named < cameras) instead += " and " + std::to_string(cameras - named) + " more";
  return "there is no camera " + quoted(view) + "; there is " + instead;
}

}  // namespace kenaf::image_server
