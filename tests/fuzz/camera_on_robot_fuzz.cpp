// The real robot's cameras in a description: any text gives cameras within their ranges, or an error with a place.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "formats/description/description_error.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/camera_on_robot.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  try {
    const auto cameras = real::parse_cameras({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (cameras.size() > 8) std::abort();
    for (const real::CameraOnRobot& camera : cameras) {
      if (camera.name.empty() || camera.width < 16 || camera.width > 4096 || camera.height < 16 ||
          camera.height > 4096 || !(camera.rate_hz >= 0.1 && camera.rate_hz <= 120) || camera.jpeg_quality < 1 ||
          camera.jpeg_quality > 100)
        std::abort();
      try {
        if (&real::choose_camera(cameras, camera.name, "fuzz") != &camera) std::abort();
      } catch (const hrt::Error&) {
        if (!camera.device.empty()) std::abort();
      }
    }
  } catch (const description::DescriptionError& error) {
    if (!std::string_view(error.what()).starts_with("fuzz.toml")) std::abort();
  }
  return 0;
}
