// Checks of commands, of sensors that measure nothing, and of the pose.
#include <array>
#include <numbers>

#include "gap/logs/held_samples.hpp"
#include "gap/logs/run_checks.hpp"
#include "robot/parts.hpp"

namespace kenaf::gap::logs {
namespace {

// Chosen.
constexpr double kMoves_m = 0.1, kCarries_m = 0.3, kSeen_m = 0.2, kTurns_rad = 0.3;
constexpr std::size_t kFewestValues = 10;
// Below them a drive may stand: share of the other track's way, and mean speed.
constexpr double kSmallShare = 0.2, kSlow_mps = 0.05;
// Turns larger than a gyro's bias and differences of tracks larger than slip cause; the gauge of an unknown robot.
constexpr double kTurnWithin_s = 2, kTurnsByTracks_rad = 1, kWidest_m = 1;

// Whether all rows with a value have the same one, to the last bit. No sensor that works does that for long.
bool constant(std::span<const double> column) {
  std::size_t count = 0;
  double first = 0;
  for (const double value : column) {
    if (std::isnan(value)) continue;
    if (count++ == 0) first = value;
    if (value != first) return false;
  }
  return count >= kFewestValues;
}

double total_change(const Course& course) {
  double sum = 0;
  for (std::size_t i = 1; i < course.value.size(); ++i) sum += std::abs(course.value[i] - course.value[i - 1]);
  return sum;
}

}  // namespace

void RunChecks::check_commands() {
  // Without commands a run cannot be simulated.
  const bool tracks = has("cmd_track_left_mps") && has("cmd_track_right_mps");
  if (!tracks) {
    add(Severity::refuse, has("cmd_track_left_mps") ? "cmd_track_right_mps" : "cmd_track_left_mps",
        "is missing or empty: a run without commands cannot be simulated");
    return;
  }

  // Commands that are all zero contradict tracks that went somewhere; in a run at rest they only make it useless.
  const auto ever = [this](const std::string& name) {
    return std::ranges::any_of(column(name), [](double value) { return std::abs(value) > 0; });
  };
  if (ever("cmd_track_left_mps") || ever("cmd_track_right_mps")) return;

  const bool flippers_commanded = std::ranges::any_of(robot::kFlipperNames, [this](std::string_view flipper) {
    return range(column(fmt::format("cmd_flipper_{}_rad", flipper))) > 0;
  });
  const double travelled_m = std::max(total_change(belts(1, 0)), total_change(belts(0, 1)));
  if (travelled_m > kCarries_m)
    add(Severity::refuse, "cmd_track_left_mps",
        fmt::format(
            "is zero all the time, and so is cmd_track_right_mps, but the tracks went {:.3g} m: the commands were "
            "not recorded",
            travelled_m));
  else if (!flippers_commanded && range(column("x_m")) < 0.01 && range(column("y_m")) < 0.01 &&
           range(column("z_m")) < 0.01)
    add(Severity::warn, "cmd_track_left_mps",
        "is zero all the time, nothing else is commanded, and the robot does not move: this run contains no "
        "information");
}

bool RunChecks::turns() const {
  if (has("gyro_z_radps")) {
    // Over a window of kTurnWithin_s a turn is larger than what the bias of a gyro adds up to.
    const Course turned = rate("gyro_z_radps");
    for (const double t_s : turned.t_s)
      if (std::abs(mean_rate(turned, t_s, kTurnWithin_s)) * kTurnWithin_s > kTurns_rad) return true;
    return false;
  }
  if (!has("track_left_mps") && !has("track_left_m")) return false;
  const double gauge_m = robot_ != nullptr ? robot_->track_gauge_m() : kWidest_m;
  return range(belts(-1, 1).value) > kTurnsByTracks_rad * gauge_m;
}

void RunChecks::check_constants() {
  // Tracks: speed and travel must change while they are commanded to; a constant command may give a constant speed.
  const bool pose_moves = farthest_from_start() > kSeen_m;
  double most_commanded_m = 0;
  for (const std::string side : kSides)
    most_commanded_m = std::max(most_commanded_m, total_change(rate("cmd_track_" + side + "_mps")));
  for (const std::string side : kSides) {
    const double commanded_m = total_change(rate("cmd_track_" + side + "_mps"));
    if (commanded_m < kMoves_m) continue;
    // A drive need not start by a command that is slower than its dead band, or small beside the other track's.
    const bool must_start = commanded_m >= kSmallShare * most_commanded_m &&
                            commanded_m >= kSlow_mps * (column("t_s").back() - column("t_s").front());
    for (const std::string& name : {"track_" + side + "_mps", "track_" + side + "_m"}) {
      if (!constant(column(name))) continue;
      const bool turns = std::ranges::any_of(column(name), [](double value) { return std::abs(value) > 0; });
      const bool as_commanded = turns && constant(column("cmd_track_" + side + "_mps"));
      if (name.ends_with("_mps") && as_commanded) continue;
      const bool stands = !must_start && !turns;
      const bool other = has("track_" + side + (name.ends_with("_mps") ? "_m" : "_mps"));
      add(pose_moves && !stands ? Severity::refuse : Severity::warn, name,
          fmt::format(
              "never changes, although {:.3g} m are commanded{}: the encoder is dead or its column was not recorded{}",
              commanded_m, pose_moves ? " and the robot moves" : "",
              other || pose_moves ? "; leave the cells empty" : ", or the track is blocked"));
    }

    if (const std::string name = "track_" + side + "_a"; constant(column(name)))
      add(Severity::dead, name,
          "never changes while the track is driven; leave the cells empty where it is not measured");
  }

  // Flippers: an angle must follow its command.
  for (const std::string_view flipper : robot::kFlipperNames) {
    const std::string angle = fmt::format("flipper_{}_rad", flipper);
    if (const double commanded = range(column("cmd_" + angle)); commanded > kTurns_rad && constant(column(angle)))
      add(Severity::warn, angle,
          fmt::format("never changes, although {:.3g} rad are commanded: its encoder is dead, or the flipper is stuck",
                      commanded));
  }

  // Pose and inertial sensors: something must change while the tracks carry the robot.
  const double way_m = distance_of_belts();
  if (way_m < kCarries_m) return;
  if (has("x_m") && constant(column("x_m")) && constant(column("y_m")))
    add(Severity::refuse, "x_m",
        fmt::format("never changes, nor does y_m, although the tracks travel {:.3g} m: the pose is frozen; leave the "
                    "cells empty where nothing was measured",
                    way_m));
  else if (constant(column("yaw_rad")) && turns())
    add(Severity::refuse, "yaw_rad",
        "never changes while the robot turns: the heading is not measured; leave the column out");
  else if (constant(column("yaw_rad")))
    add(Severity::warn, "yaw_rad",
        "never changes while the robot drives: the heading is not measured, and the column should be left out, or it "
        "is written in steps larger than its change");

  for (const std::string name :
       {"gyro_x_radps", "gyro_y_radps", "gyro_z_radps", "acc_x_mps2", "acc_y_mps2", "acc_z_mps2"})
    if (constant(column(name)))
      add(Severity::dead, name, "never changes while the robot drives: the sensor is dead; leave the cells empty");
}

void RunChecks::check_held() {
  for (const std::string& name : run_.columns) {
    if (name == "t_s" || name.starts_with("cmd_") || found(name)) continue;
    const std::optional<HeldSamples> held = held_samples(column("t_s"), column(name));
    if (!held) continue;
    add(Severity::held, name,
        fmt::format("repeats each value for {:.2g} s, until the sensor's next one: rows are written more often than it "
                    "measures; leave the cells empty where nothing new was measured",
                    held->hold_s));
  }
}

void RunChecks::check_pose() {
  const auto t_s = column("t_s"), x = column("x_m"), y = column("y_m"), z = column("z_m"), yaw = column("yaw_rad");

  // A run needs a pose or at least its tracks.
  const bool tracks_measured = has("track_left_mps") || has("track_left_m");
  if (!has("x_m") || !has("y_m")) {
    add(tracks_measured ? Severity::warn : Severity::refuse, has("x_m") ? "y_m" : "x_m",
        tracks_measured
            ? "is missing or empty: the path of the robot is unknown; kenaf-gap merge adds the pose from motion "
              "capture to a run"
            : "is missing or empty, and the tracks were not measured either: there is nothing to compare with");
    return;
  }
  if (refused("x_m")) return;  // in another unit every step is a jump

  // One pass over the rows looks for jumps of heading and place, and for times in which the pose is frozen.
  constexpr double kLate_s = 0.5, kStart_s = 0.3, kStill_mps = 0.1, kFrozen_s = 1, kFrozenBelts_m = 0.2;
  constexpr double kJump_m = 0.1, kFall_mps = 5, kJump_rad = 0.5, kTumble_radps = 15, kSpeeds = 5;
  const double most_mps = robot_ != nullptr ? robot_->drive.max_speed_mps : 1;
  const Course left = belts(1, 0), right = belts(0, 1);
  const std::vector<bool> is_upright = upright();
  std::size_t jumps = 0, first_jump = 0, turns = 0, first_turn = 0, frozen = 0;
  double farthest_m = 0, longest_frozen_s = 0;
  std::optional<std::size_t> start, last, last_yaw, same_since;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    // Heading, while the robot is upright: faster than any robot turns or tumbles.
    if (!is_upright[i]) last_yaw.reset();
    if (i < yaw.size() && !std::isnan(yaw[i]) && is_upright[i]) {
      const double dt_s = last_yaw ? t_s[i] - t_s[*last_yaw] : 0;
      const double turn = last_yaw ? std::abs(std::remainder(yaw[i] - yaw[*last_yaw], 2 * std::numbers::pi)) : 0;
      if (turn > kJump_rad + kTumble_radps * dt_s && turns++ == 0) first_turn = i;
      last_yaw = i;
    }

    // Place: faster than kSpeeds times its speed plus a fall.
    if (std::isnan(x[i] + y[i])) continue;
    if (!start) start = i;
    if (last) {
      const double rise = z.empty() || std::isnan(z[i] + z[*last]) ? 0 : z[i] - z[*last];
      const double way_m = std::hypot(x[i] - x[*last], y[i] - y[*last], rise), dt_s = t_s[i] - t_s[*last];
      if (way_m > kJump_m + (kSpeeds * most_mps + kFall_mps) * dt_s) {
        if (jumps++ == 0) first_jump = i;
        farthest_m = std::max(farthest_m, way_m);
      }

      // Frozen: the longest time at the very same place during which both belts went far.
      if (way_m > 0) same_since.reset();
      if (way_m == 0 && !same_since) same_since = *last;
      if (same_since && t_s[i] - t_s[*same_since] > std::max(longest_frozen_s, kFrozen_s)) {
        const auto went = [&](const Course& belt) {
          return std::abs(value_at(belt, t_s[i]) - value_at(belt, t_s[*same_since]));
        };
        if (std::min(went(left), went(right)) > kFrozenBelts_m) {
          longest_frozen_s = t_s[i] - t_s[*same_since];
          frozen = *same_since;
        }
      }
    }
    last = i;
  }

  if (longest_frozen_s > 0)
    add(Severity::warn, "x_m",
        fmt::format("is constant to the last digit for {:.3g} s with y_m, although the tracks run: the last pose was "
                    "repeated where nothing was measured; empty the cells there",
                    longest_frozen_s),
        line(frozen));
  if (jumps > 0)
    add(Severity::warn, "x_m",
        fmt::format("jumps {} times with y_m and z_m, by up to {:.3g} m between two rows that have a pose: markers "
                    "were confused; empty the cells there",
                    jumps, farthest_m),
        line(first_jump));
  if (turns > 0 && !refused("yaw_rad"))
    add(Severity::warn, "yaw_rad",
        fmt::format("jumps {} times by more than a robot can turn between two rows: markers were confused; empty the "
                    "cells there",
                    turns),
        line(first_turn));

  // The run needs a first pose, near its first row, from which a simulation starts.
  if (!start)
    return add(tracks_measured ? Severity::warn : Severity::refuse, "x_m",
               "has no value in any row in which y_m has one: the path of the robot is unknown");
  if (t_s[*start] - t_s.front() > kLate_s)
    add(Severity::warn, "x_m",
        fmt::format("has no value before {:.3g} s: a simulation starts from the first pose of the run; remove the rows "
                    "before it",
                    t_s[*start]),
        line(*start));

  // Without track speeds the run must start at rest, as its initial speed is unknown.
  if (!tracks_measured) {
    for (std::size_t i = *start; i < t_s.size() && t_s[i] <= t_s[*start] + kStart_s; ++i)
      if (t_s[i] - t_s[*start] > 0.5 * kStart_s &&
          std::hypot(x[i] - x[*start], y[i] - y[*start]) > kStill_mps * (t_s[i] - t_s[*start]) + 0.02) {
        add(Severity::warn, "x_m",
            "moves from the first row on, and no track speed is measured there: the initial speed of the run is "
            "unknown");
        break;
      }
  }
}

}  // namespace kenaf::gap::logs
