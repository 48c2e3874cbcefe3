// The cameras of the real robot: what of its description's [[camera]] the video devices are set to.
// docs/descriptions.md explains the keys; the simulator reads the others.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kenaf::real {

struct CameraOnRobot {
  std::string name;    // unique among the robot's cameras
  std::string device;  // "/dev/video0"; "": the description names none
  int width, height;   // pixels
  double rate_hz;
  int jpeg_quality;  // 1 to 100; of files encoded here
};

// Takes a shipped name ("kenaf") or the path of a TOML file. Throws DescriptionError with file, line and column.
std::vector<CameraOnRobot> load_cameras(const std::string& name_or_path);
std::vector<CameraOnRobot> parse_cameras(std::string_view toml_text, const std::string& name_for_errors);

// "" is the first. Throws hrt::Error(HRT_E_DEVICE) if there is no such camera, listing the existing ones, or if it has
// no device.
const CameraOnRobot& choose_camera(const std::vector<CameraOnRobot>& cameras, const std::string& name,
                                   const std::string& robot);

}  // namespace kenaf::real
