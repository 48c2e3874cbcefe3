// What makes this library libkenaf_real.
#include "canbus/socket_bus.hpp"
#include "hrt/camera.hpp"
#include "hrt/error.hpp"
#include "hrt/transport.hpp"
#include "libkenaf_real/can_transport.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<real::CanTransport>([](const std::string& interface, std::span<const std::uint16_t> ids) {
    return std::make_unique<canbus::SocketBus>(interface, ids);
  });
}
std::string resolve_camera(const hrt_config&, const std::string&) {
  throw Error(HRT_E_DEVICE, "libkenaf_real does not read cameras yet");
}
std::unique_ptr<Camera> make_camera(const hrt_config& config, const std::string& camera) {
  (void)resolve_camera(config, camera);
  return nullptr;
}
extern const char* const kLibraryName = "real";

}  // namespace kenaf::hrt
