// What makes this library libkenaf_real.
#include "canbus/socket_bus.hpp"
#include "hrt/transport.hpp"
#include "libkenaf_real/can_transport.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<real::CanTransport>([](const std::string& interface, std::span<const std::uint16_t> ids) {
    return std::make_unique<canbus::SocketBus>(interface, ids);
  });
}
extern const char* const kLibraryName = "real";

}  // namespace kenaf::hrt
