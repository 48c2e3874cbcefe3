// Any text is an electronic data sheet, or refused in words; what was read can be printed and compared.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "can/canlog/eds_check.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  try {
    const canopen::EdsFile file = canopen::read_eds({reinterpret_cast<const char*>(data), size});
    fuzz::require(!file.objects.empty() && file.objects.size() <= canopen::kMostEdsObjects);
    fuzz::require(file.faults.size() <= canopen::kMostEdsFaults);
    for (const canopen::EdsFault& fault : file.faults) fuzz::require(fault.line > 0 && !fault.words.empty());
    fuzz::require(!canlog::to_text(file, 1).empty());
    canlog::check_eds(file, bus, 0, 0.01);
  } catch (const std::runtime_error& refused) {
    fuzz::require(*refused.what() != '\0');
  }
  return 0;
}
