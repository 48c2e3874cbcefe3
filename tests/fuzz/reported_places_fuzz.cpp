// Any report's phases have times and shares, and its channels floors, that can be drawn, or it is said why not.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "gap/playback/reported_places.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gap::playback::ReportedPlaces places;
  try {
    places = gap::playback::parse_reported_places({reinterpret_cast<const char*>(data), size});
  } catch (const std::runtime_error&) {
    return 0;
  }
  for (const gap::playback::ReportedPhase& phase : places.phases) {
    if (!(phase.from_s >= 0 && phase.to_s >= phase.from_s && std::isfinite(phase.to_s))) __builtin_trap();
    if (!(phase.share >= 0 && phase.share <= 1)) __builtin_trap();
    const auto own = gap::playback::phases_of_run(places, phase.run, phase.manoeuvre, {});
    if (own.size() > places.phases.size()) __builtin_trap();
  }
  for (const auto& [column, floor] : places.channel_floor)
    if (!(floor > 0 && std::isfinite(floor))) __builtin_trap();
  return 0;
}
