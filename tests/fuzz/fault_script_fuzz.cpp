// Faults in words, one a line: each is refused, or comes when it says, is of a node that the robot has, and ends once.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "can/candrives/fault_script.hpp"
#include "tests/can/candrives/easy_robot.hpp"

namespace {

using namespace kenaf;
using namespace kenaf::candrives;
using namespace std::chrono_literals;

void require(bool fine) {
  if (!fine) __builtin_trap();
}

// Those that were understood; each at most twice, as it begins and as it ends.
void run(FaultScript& script, std::size_t understood) {
  script.on_motion(1s);
  std::size_t came = 0;
  while (script.deadline() != canopen::Time::max()) {
    const canopen::Time next = script.deadline();
    const std::size_t now = script.due(next).size();
    require(now > 0);
    came += now;
  }
  require(came >= understood && came <= 2 * understood);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 4096) return 0;
  static const canbus::RobotBus bus = easy_robot();
  FaultScript script(canopen::Time::zero());
  std::size_t understood = 0;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    try {
      const PlannedFault planned = parse_fault(line, bus);
      require(planned.fault.node <= 8 && planned.delay >= 0s && (!planned.lasts || *planned.lasts >= 0s));
      require(!planned.at_once || (planned.delay == 0s && !planned.after_motion));
      script.add(planned, 0s);
      ++understood;
    } catch (const std::invalid_argument&) {
    }
  }
  run(script, understood);
  return 0;
}
