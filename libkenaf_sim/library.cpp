// What makes this library libkenaf_sim.
#include "hrt/transport.hpp"
#include "libkenaf_sim/relay_transport.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<sim::RelayTransport>();
}
extern const char* const kLibraryName = "sim";

}  // namespace kenaf::hrt
