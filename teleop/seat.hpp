// Decides which console has the robot, and which of its wishes counts. Plain values; the caller passes the time:
// wall-clock seconds of any steady clock, because a network does not follow robot time.
#pragma once

#include <cstdint>
#include <optional>

#include "link.hpp"

namespace kenaf::teleop {

struct Seat {
  std::uint64_t session = 0;   // 0: nobody has the robot
  std::optional<Wish> wish{};  // the newest one
  double heard_s = 0;          // its time of arrival
  std::uint32_t received = 0;  // wishes of this session, including late ones
  std::uint64_t left = 0;      // the last session that said Bye
};

enum class Admission : std::uint8_t {
  newest,  // it counts: from the console that has the robot; a free seat goes to the first to ask
  old,     // overtaken or duplicated, or after its session's Bye: dropped, and no sign of life
  taken,   // another console has the robot
};

// A console silent for `takeover_s` loses the robot to the next one that asks; until then it may return. A stray wish
// of a former console takes a free seat for that time, but moves nothing: see decide().
Admission admit(Seat& seat, const Wish& wish, double now_s, double takeover_s);

// The console has left: the seat is free. Another console's Bye changes nothing.
void leave(Seat& seat, std::uint64_t session);

}  // namespace kenaf::teleop
