// Decides the commands to the robot from the newest wish and its age. Plain values and one pure function, called once
// per turn of the control loop.
//
//   halted ── dead-man seen released ──> ready <── dead-man ──> driving
//     ^                                    │                      │
//     ├──── silence, old view, robot lost, another console ───────┤
//     └── released ── emergency stop <── wish or another console ─┘
//
// A halt ends only with the dead-man released and pressed again, because when a link comes back, the operator may hold
// the key as before without having noticed that the robot stopped, and his picture is old. The robot would then drive
// off from a place he has not seen. Releasing and pressing again shows that he has looked. For the same reason a
// flipper posture ordered during a halt is never carried out.
//
// A network that delays datagrams by seconds delivers wishes without a gap, each made for an earlier place of the
// robot. So a wish counts only while the newest status that it names is recent. This also neutralises datagrams that a
// former console left in the network.
#pragma once

#include <array>
#include <cstdint>

#include "link.hpp"
#include "seat.hpp"

namespace kenaf::teleop {

struct DrivingLimits {
  double silence_s = 0.5;       // the robot halts this long after the last new wish: 0.1 to 10, wall clock
  double view_s = 1;            // or once the operator's view is older than this: 0.2 to 60, wall clock
  double max_track_mmps = 400;  // faster wishes are limited to it
  double speed_up_mmps2 = 500;  // ramps, robot time; a halt has no ramp
  double slow_down_mmps2 = 1500;
};

// State kept between turns.
struct Driving {
  Mode mode = Mode::no_robot;
  Halt halt = Halt::start;
  bool had_robot = false;           // it was open earlier
  std::uint64_t session = 0;        // of the console whose wishes were followed last
  std::uint32_t flipper_order = 0;  // the newest one carried out or skipped
  std::array<double, kTrackCount> track_mmps{};
};

struct Situation {
  const Seat& seat;
  bool emergency_pressed;  // by a wish of any console since the last turn
  bool robot_open;
  double now_s;       // on the clock of seat.heard_s
  double robot_dt_s;  // robot time since the last turn, for the ramps
  double view_age_s;  // since the newest status named by seat.wish was sent; infinite: it names none
};

// Calls of hrt.h for one turn, in this order.
struct Order {
  bool stop;           // hrt_stop(): the tracks stop, and flippers that are moving hold where they are
  bool move_flippers;  // hrt_set_flippers(flipper_deg)
  std::array<double, kFlipperCount> flipper_deg;
  std::array<double, kTrackCount> track_mmps;  // hrt_set_tracks(), every turn: also the robot's sign of life
};

// The emergency stop latches, whoever requested it, and is released only by a wish of the console that has the robot,
// with the dead-man released. Without an open robot the Order has no meaning.
Order decide(Driving& driving, const Situation& situation, const DrivingLimits& limits);

}  // namespace kenaf::teleop
