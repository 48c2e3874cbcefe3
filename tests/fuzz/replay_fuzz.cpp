// Any run is a replay or is refused with a RunFileError; what is accepted can be driven to its end.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rollout/driver.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto run = kenaf::runs::parse_run({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    const auto replay = kenaf::rollout::replay_of(run, "fuzz.csv");
    kenaf::rollout::Driver driver(replay, {});
    for (const auto& timed : replay.timed) driver.command(timed.t_s, {});
    if (driver.command(replay.at_most_s(), {})) __builtin_trap();
  } catch (const kenaf::runs::RunFileError&) {
  }
  return 0;
}
