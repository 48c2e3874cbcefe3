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
    canopen::Frame frame{};
    std::uint32_t error_class = 0;
    if (kind == canopen::FrameKind::data || kind == canopen::FrameKind::remote) frame = next_frame(input);
    if (kind == canopen::FrameKind::remote) frame.data = {};
    if (kind == canopen::FrameKind::error) {
      frame = input.frame(0, 8);
      error_class = input.word();
    }
    log.frames.push_back({log.frames.size() + 1, at, kind, frame, error_class, log.clock_steps.size()});
  }
  return log;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const canlog::Network network(candrives::easy_robot());
  fuzz::CanInput input{{data, size}};
  const canlog::Log log = next_log(input);
  canlog::Describer describer(network);
  for (const canlog::LogFrame& logged : log.frames) require(!describer.describe(logged).empty());
  std::size_t last = 1;
  for (const canlog::Violation& one : check_rules(log, network)) {
    require(one.line >= last && one.line <= log.frames.size() && !one.words.empty());
    last = one.line;
  }
  const canlog::Figures figures = figures_of(log, network);
  require(figures.all.bits_per_s <= figures.all.worst_case_bits_per_s && !to_text(figures, 500e3).empty());
  return 0;
}
