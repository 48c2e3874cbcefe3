// The parts that are specific to libkenaf_sim.
#include "hrt/camera.hpp"
#include "hrt/transport.hpp"
#include "libkenaf_sim/image_client.hpp"
#include "libkenaf_sim/relay_transport.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<sim::RelayTransport>();
}
std::string resolve_camera(const hrt_config&, const std::string& name) {
  return name;  // only the server knows its cameras
}
std::unique_ptr<Camera> make_camera(const hrt_config& config, const std::string& camera) {
  return std::make_unique<sim::ImageClient>(config, camera);
}
extern const char* const kLibraryName = "sim";

}  // namespace kenaf::hrt
