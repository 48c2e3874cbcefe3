// Any frame is one message of CANopen or none, and what is read from it is written as the same frame again. Any
// statusword is a power state, with a controlword that CiA 402 has. A set-point is handed over by the handshake's
// rules.
#include <array>
#include <cstddef>
#include <vector>

#include "can/canopen/drive.hpp"
#include "can/canopen/emergency.hpp"
#include "can/canopen/nmt.hpp"
#include "can/canopen/pdo.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf::canopen;
using kenaf::fuzz::require;

namespace {

void check_messages(const Frame& frame) {
  int readings = is_sync(frame) ? 1 : 0;
  if (const auto order = nmt_order_from(frame)) {
    ++readings;
    require(encode(*order) == frame);
  }
  if (const auto heartbeat = heartbeat_from(frame)) {
    ++readings;
    require(encode(*heartbeat) == frame && !describe(heartbeat->state).empty());
  }
  if (const auto emergency = emergency_from(frame)) {
    ++readings;
    require(encode(*emergency) == frame && !describe(*emergency).empty());
  }
  require(readings <= 1);
  require(worst_case_bits(frame) >= 55 && worst_case_bits(frame) <= 135);
}

void check_pdo(const Frame& frame, std::uint8_t number, std::span<const std::uint8_t> types) {
  Pdo pdo{PdoDirection::transmit, static_cast<std::uint8_t>(number % 4 + 1), 1, {}};
  for (const std::uint8_t type : types) pdo.objects.push_back({{0x2000, type}, static_cast<ObjectType>(type % 6)});
  std::vector<std::int64_t> values(pdo.objects.size(), 12345);
  if (unpack(pdo, frame, values)) {
    require(make_frame(frame.id, std::span(frame.data).first(frame.length)) == frame);
    Frame packed = pack(pdo, 1, values);
    packed.id = frame.id;
    require(packed == frame);
  } else {
    for (const std::int64_t value : values) require(value == 12345);
  }
}

void check_drive(const Frame& frame) {
  const auto statusword = static_cast<std::uint16_t>(get_unsigned(frame.data, 0, 2));
  const auto previous = static_cast<std::uint16_t>(get_unsigned(frame.data, 2, 2));
  const PowerState state = power_state_of(statusword);
  require(!describe(state).empty());
  const std::uint16_t control = control_towards_operation(state, previous);
  // power comes only where the drive is on its way, and the reset only as an edge
  const bool on_the_way = state == PowerState::switched_on || state == PowerState::operation_enabled;
  require((control == kControlEnable) == on_the_way);
  if (control == kControlFaultReset) require(state == PowerState::fault && (previous & kControlFaultReset) == 0);
}

void check_set_points(kenaf::fuzz::CanInput& input) {
  SetPointHandshake handshake;
  bool up = false;
  while (!input.empty()) {
    const auto target = static_cast<std::int8_t>(input.byte());
    const std::uint16_t statusword = input.word();
    const bool acknowledged = (statusword & kStatusSetPointAcknowledged) != 0;
    const std::uint16_t bits = handshake.step(target, statusword);
    const bool now_up = (bits & kControlNewSetPoint) != 0;
    require((bits | kControlNewSetPoint) == (kControlNewSetPoint | kControlChangeAtOnce));
    if (!up && now_up) require(!acknowledged);
    if (up) require(now_up == !acknowledged);
    up = now_up;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kenaf::fuzz::CanInput input{{data, size}};
  const Frame frame = input.any_frame();
  check_messages(frame);
  const std::array<std::uint8_t, 4> types{input.byte(), input.byte(), input.byte(), input.byte()};
  check_pdo(frame, input.byte(), std::span(types).first(input.byte() % (types.size() + 1)));
  check_drive(frame);
  check_set_points(input);
  return 0;
}
