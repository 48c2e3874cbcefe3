#include "libkenaf_real/camera_on_robot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "formats/description/description_file.hpp"
#include "formats/description/toml_reader.hpp"
#include "hrt/error.hpp"

namespace kenaf::real {

std::vector<CameraOnRobot> parse_cameras(std::string_view toml_text, const std::string& name_for_errors) {
  constexpr std::size_t kMaxCameras = 8;
  const toml::table root = description::parse_toml(toml_text, name_for_errors);
  description::TomlReader file(root, "", name_for_errors);
  std::vector<CameraOnRobot> cameras;
  // One [[camera]] after the other, each reported at its own key.
  for (description::TomlReader& table : file.tables("camera")) {
    CameraOnRobot camera{};
    // The name is what programs ask for, so it is unique.
    camera.name = table.text("name");
    if (camera.name.empty()) table.fail("name", "must not be empty");
    if (std::ranges::find(cameras, camera.name, &CameraOnRobot::name) != cameras.end())
      table.fail("name", "is the name of another camera too");

    // The device is optional (the simulator has none), but two cameras cannot share one.
    if (table.has("device")) {
      camera.device = table.text("device");
      if (!camera.device.starts_with('/'))
        table.fail("device", fmt::format("is \"{}\", but must be the path of a video device, such as \"/dev/video0\"",
                                         camera.device));
      if (std::ranges::find(cameras, camera.device, &CameraOnRobot::device) != cameras.end())
        table.fail("device", "is the device of another camera too");
    }

    // Settings of the device.
    camera.width = table.integer("width", 16, 4096);
    camera.height = table.integer("height", 16, 4096);
    camera.rate_hz = table.number("rate_hz", {.min = 0.1, .max = 120});
    camera.jpeg_quality = table.has("jpeg_quality") ? table.integer("jpeg_quality", 1, 100) : 80;
    cameras.push_back(camera);
    if (cameras.size() > kMaxCameras)
      table.fail("name", fmt::format("is one camera too many: at most {}", kMaxCameras));
  }
  return cameras;
}

std::vector<CameraOnRobot> load_cameras(const std::string& name_or_path) {
  const description::DescriptionFile file = description::read_description_file("robot", name_or_path, ".toml");
  return parse_cameras(file.text, file.path);
}

const CameraOnRobot& choose_camera(const std::vector<CameraOnRobot>& cameras, const std::string& name,
                                   const std::string& robot) {
  if (cameras.empty())
    throw hrt::Error(HRT_E_DEVICE, fmt::format("robot '{}' has no camera: its description has no [[camera]]", robot));
  const auto found = name.empty() ? cameras.begin() : std::ranges::find(cameras, name, &CameraOnRobot::name);
  if (found == cameras.end()) {
    std::string names;
    for (const CameraOnRobot& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
    throw hrt::Error(HRT_E_DEVICE, fmt::format("robot '{}' has no camera '{}'; it has: {}", robot, name, names));
  }
  if (found->device.empty()) {
    throw hrt::Error(
        HRT_E_DEVICE,
        fmt::format("camera '{}' of robot '{}' has no device: add device = \"/dev/video0\", or where it is, to "
                    "its [[camera]]",
                    found->name, robot));
  }
  return *found;
}

}  // namespace kenaf::real
