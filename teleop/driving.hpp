// What the control process tells the robot, decided from the newest wish and the time since it came. Plain values and
// one pure function, called once in every turn of the control loop.
//
//   halted ── dead-man seen released ──> ready <── dead-man ──> driving
//     ^                                    │                      │
//     ├──── silence, old view, robot lost, another console ───────┤
//     └── released ── emergency stop <── wish or another console ─┘
//
// Why a halt ends only with the dead-man released and pressed again: when a link comes back, the operator may hold the
// key as before without having noticed that the robot stopped, and his picture is old. A robot that then drove off by
// itself would do so from a place he has not seen. Letting go and pressing again is the sign that he has looked.
// For the same reason a posture of the flippers that was ordered while the robot was halted is never carried out.
//
// A network that holds datagrams back for seconds brings wishes without a gap, each of them made for where the robot
// was long ago. So a wish counts only while the newest status that it names is young. That also makes harmless what a
// console long gone has left in the network.
#pragma once

#include <array>
#include <cstdint>

#include "link.hpp"
#include "seat.hpp"

namespace kenaf::teleop {

struct DrivingLimits {
  double silence_s = 0.5;       // without a new wish the robot halts: 0.1 to 10, wall clock
  double view_s = 1;            // or where the operator saw nothing newer than that: 0.2 to 60, wall clock
  double max_track_mmps = 400;  // faster wishes are cut to it
  double speed_up_mmps2 = 500;  // ramps, robot time; a halt has none
  double slow_down_mmps2 = 1500;
};

// What is remembered from turn to turn.
struct Driving {
  Mode mode = Mode::no_robot;
  Halt halt = Halt::start;
  bool had_robot = false;           // it was open before
  std::uint64_t session = 0;        // of the console whose wishes were followed last
  std::uint32_t flipper_order = 0;  // the newest one that was carried out or passed over
  std::array<double, kTrackCount> track_mmps{};
};

struct Situation {
  const Seat& seat;
  bool emergency_pressed;  // by a wish since the last turn, of whatever console
  bool robot_open;
  double now_s;       // of the clock that seat.heard_s has
  double robot_dt_s;  // robot time since the last turn, for the ramps
  double view_age_s;  // since the newest status that seat.wish names was sent; infinite: it names none
};

// One turn's calls of hrt.h, in this order.
struct Order {
  bool stop;           // hrt_stop(): the tracks stand, flippers on their way stay where they are
  bool move_flippers;  // hrt_set_flippers(flipper_deg)
  std::array<double, kFlipperCount> flipper_deg;
  std::array<double, kTrackCount> track_mmps;  // hrt_set_tracks(), in every turn: it is also the robot's sign of life
};

// The emergency stop latches, wherever it came from, and is released only by a wish of the console that has the robot,
// with the dead-man not held. Without an open robot nothing of the Order means anything.
Order decide(Driving& driving, const Situation& situation, const DrivingLimits& limits);

}  // namespace kenaf::teleop
