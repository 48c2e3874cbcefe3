// What decodes encodes to the same bytes again: there is one way to write each datagram. What is in it keeps the
// control process within its limits, and the screen within its characters.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "teleop/driving.hpp"
#include "teleop/link.hpp"
#include "teleop/screen.hpp"

namespace {

using kenaf::protocol::DecodeError;
using namespace kenaf::teleop;

void expect(bool condition) {
  if (!condition) std::abort();
}

void drive(const Wish& wish) {
  Seat seat;
  Driving driving;
  const DrivingLimits limits;
  admit(seat, wish, 10, 2);
  for (int i = 0; i < 4; ++i) {
    const Order order = decide(driving, {seat, wish.emergency_stop, true, 10, 0.1, 0.1}, limits);
    for (const double speed : order.track_mmps) expect(std::abs(speed) <= limits.max_track_mmps);
    if (wish.deadman) expect(order.track_mmps[kLeft] == 0);  // it was never seen released
  }
}

void show(const Status& status) {
  LinkHealth health;
  health.sent(1, 9);
  health.heard(status, 10);
  const Desk desk;
  const Wish wish = desk.wish(10);
  const View view{"control", "", "", &status, {}, health, desk, wish, 10};
  for (const auto& row : draw_screen(view).cells) {
    for (const Canvas::Cell& cell : row) expect(cell.character >= ' ' && cell.character <= '~');
  }
  plain_line(view);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  Datagram datagram = Bye{1};
  if (decode(bytes, datagram) != DecodeError::none) return 0;
  std::array<std::byte, kMaxDatagramBytes> again;
  const std::size_t used = encode(datagram, again);
  expect(std::equal(bytes.begin(), bytes.end(), again.begin(), again.begin() + static_cast<std::ptrdiff_t>(used)));
  if (const Wish* wish = std::get_if<Wish>(&datagram)) drive(*wish);
  if (const Status* status = std::get_if<Status>(&datagram)) show(*status);
  return 0;
}
