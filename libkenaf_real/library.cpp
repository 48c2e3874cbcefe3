// What makes this library libkenaf_real.
#include "hrt/transport.hpp"
#include "libkenaf_real/can_transport.hpp"

namespace kenaf::hrt {

std::unique_ptr<Transport> make_transport() {
  return std::make_unique<real::CanTransport>();
}
extern const char* const kLibraryName = "real";

}  // namespace kenaf::hrt
