// Any file is a log of some format, or refused in words: its frames are in the order of the file and of one time, and
// are put into words, checked and measured without a fault.
#include <cstddef>
#include <cstdint>
#include <sstream>

#include "can/canlog/describe.hpp"
#include "can/canlog/figures.hpp"
#include "can/canlog/rules.hpp"
#include "tests/can/candrives/easy_robot.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf;
using fuzz::require;

namespace {

void use(const canlog::Log& log, const canlog::Network& network) {
  canlog::Describer describer(network);
  for (std::size_t i = 0; i < log.frames.size(); ++i) {
    require(!describer.describe(log.frames[i]).empty());
    if (i == 0) continue;
    const canlog::LogFrame &before = log.frames[i - 1], &frame = log.frames[i];
    require(frame.line > before.line && frame.at >= before.at && frame.clock_steps >= before.clock_steps);
  }
  for (const canlog::ClockStep& step : log.clock_steps) require(step.back > canopen::Time::zero());
  for (const canlog::Violation& one : check_rules(log, network)) require(!one.words.empty());
  require(!to_text(figures_of(log, network), 500e3).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const canlog::Network network(candrives::easy_robot());
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  try {
    use(canlog::read_log(text), network);
  } catch (const std::runtime_error& refused) {
    require(!std::string_view(refused.what()).empty());
  }
  return 0;
}
