// The parts that are specific to libkenaf_real.
#include "can/canbus/socket_bus.hpp"
#include "hrt/camera.hpp"
#include "hrt/transport.hpp"
#include "libkenaf_real/camera_on_robot.hpp"
#include "libkenaf_real/can_transport.hpp"
#include "libkenaf_real/translated_errors.hpp"
#include "libkenaf_real/v4l2_camera.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<real::CanTransport>([](const std::string& interface, std::span<const std::uint16_t> ids) {
    return std::make_unique<canbus::SocketBus>(interface, ids);
  });
}
namespace {

real::CameraOnRobot described_camera(const hrt_config& config, const std::string& name) {
  return real::with_translated_errors(
      [&] { return real::choose_camera(real::load_cameras(config.robot), name, config.robot); });
}

}  // namespace

std::string resolve_camera(const hrt_config& config, const std::string& name) {
  return described_camera(config, name).name;
}
std::unique_ptr<Camera> make_camera(const hrt_config& config, const std::string& camera) {
  return std::make_unique<real::V4l2Camera>(described_camera(config, camera));
}
extern const char* const kLibraryName = "real";

}  // namespace kenaf::hrt
