// Any frames at any times are a log: it is put into words, checked and measured without a fault, and each violation is
// of one of its lines.
#include <cstddef>
#include <cstdint>

#include "can/canlog/describe.hpp"
#include "can/canlog/figures.hpp"
#include "can/canlog/rules.hpp"
#include "tests/can/candrives/easy_robot.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf;
using fuzz::require;

namespace {

// Mostly identifiers of the robot's eight nodes: services in steps of 0x80, then the node.
canopen::Frame next_frame(fuzz::CanInput& input) {
  const std::uint8_t choice = input.byte();
  if (choice == 0xff) return input.any_frame();
  const auto id = static_cast<std::uint16_t>((choice >> 4) * 0x80 + (choice & 0x0f));
  return input.frame(id, input.byte() % 9);
}

canlog::Log next_log(fuzz::CanInput& input) {
  canlog::Log log{.interface = "vcan0"};
  canopen::Time at{};
  while (!input.empty()) {
    const std::uint8_t step = input.byte();
    at += std::chrono::microseconds(100) * (step & 0x3f) * (step & 0x40 ? 100 : 1);
    const auto kind = step & 0x80 ? static_cast<canopen::FrameKind>(input.byte() % 5) : canopen::FrameKind::data;
    const canopen::Frame frame = kind == canopen::FrameKind::data ? next_frame(input) : canopen::Frame{};
    log.frames.push_back({log.frames.size() + 1, at, kind, frame});
  }
  return log;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const canlog::Network network(candrives::easy_robot());
  fuzz::CanInput input{{data, size}};
  const canlog::Log log = next_log(input);
  for (const canlog::LogFrame& logged : log.frames) require(!describe(logged, network).empty());
  std::size_t last = 1;
  for (const canlog::Violation& one : check_rules(log, network)) {
    require(one.line >= last && one.line <= log.frames.size() && !one.words.empty());
    last = one.line;
  }
  const canlog::Figures figures = figures_of(log, network);
  require(figures.all.bits_per_s <= figures.all.worst_case_bits_per_s && !to_text(figures, 500e3).empty());
  return 0;
}
