// Which console has the robot, and which of its wishes counts. Plain values; the caller brings the time: wall-clock
// seconds of any steady clock, because a network knows no robot time.
#pragma once

#include <cstdint>
#include <optional>

#include "link.hpp"

namespace kenaf::teleop {

struct Seat {
  std::uint64_t session = 0;   // 0: nobody has the robot
  std::optional<Wish> wish{};  // the newest one
  double heard_s = 0;          // when it came
  std::uint32_t received = 0;  // wishes of this session, old ones too
  std::uint64_t left = 0;      // the session that said Bye last
};

enum class Admission : std::uint8_t {
  newest,  // it counts: from the console that has the robot, which a free seat gives to whoever asks first
  old,     // overtaken or doubled on the way, or by its session's Bye: dropped, and no sign of life either
  taken,   // another console has the robot
};

// A console that was silent for `takeover_s` loses the robot to the next one that asks; until then it finds its place
// again. A stray wish of a console long gone takes a free seat for as long, but moves nothing: see decide().
Admission admit(Seat& seat, const Wish& wish, double now_s, double takeover_s);

// The console has left: the seat is free. Somebody else's Bye changes nothing.
void leave(Seat& seat, std::uint64_t session);

}  // namespace kenaf::teleop
