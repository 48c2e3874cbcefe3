// Checks of units, signs and time, by comparing quantities that should be equal up to slip.
#include <array>
#include <numbers>

#include "gap/logs/run_checks.hpp"
#include "robot/parts.hpp"

namespace kenaf::gap::logs {
namespace {

// Chosen. Least correlation of quantities that go together; least factors that no slip, gain or gear explains, so that
// they come from a wrong unit.
constexpr double kTogether = 0.8, kLengthFactor = 20, kAngleFactor = 15,
                 kYawFactor = 30;  // smaller ones: check_factors()
constexpr double kSameWay = 1.4, kAsCommanded = 4;
// Yaw over gyro, and turns over those of belts without slip, as check_factors.cpp takes them for possible.
constexpr double kMostYawOverGyro = 1.5, kLeastTurnOfBelts = 0.08, kMostTurnOfBelts = 1.5;
constexpr double kLeastMove_m = 0.1, kLeastTurn_rad = 0.2;
constexpr double kDegreesInARadian = 180 / std::numbers::pi;
constexpr double kDragged = 0.2;      // share of the travel commanded to the other track
constexpr double kMostSpeed_mps = 5;  // of an unknown robot
// A robot slides against its tracks on slopes only. Elsewhere it goes as far as they do, or less because of slip; in
// turns far less.
constexpr double kLevel_rad = 0.1, kLeastGrip = 0.5, kLeastGripInTurns = 0.15, kMostGrip = 1.25;
// Current that no motor of an unknown robot has. Times a described motor's largest, which descriptions often guess.
constexpr double kNoCurrent_a = 1000, kFarAbove = 10;

std::string length_unit(double factor) {
  return factor > 300 ? "millimetres" : "centimetres";
}

}  // namespace

void RunChecks::check_clock() {
  constexpr double kCoarse_s = 0.5, kGapSteps = 10, kOddShare = 0.1, kEpoch_s = 1e6, kLongestStep_s = 10;
  const auto t_s = column("t_s");
  const double median_s = median_step(t_s, t_s);

  // With t_s in another unit, an accumulated quantity changes more slowly than its rate says, by the unit's factor.
  std::vector<std::optional<Relation>> relations;
  if (median_s >= kCoarse_s) {
    for (const std::string side : kSides)
      relations.push_back(relate(adding("track_" + side + "_m"), rate("track_" + side + "_mps")));
    for (const char* speed : {"track_{}_mps", "cmd_track_{}_mps"}) {
      const std::string left = fmt::format(fmt::runtime(speed), "left"),
                        right = fmt::format(fmt::runtime(speed), "right");
      if (!has(left) || !has(right)) continue;
      const auto a = column(left), b = column(right);
      std::vector<double> mean(t_s.size());
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5 * (a[i] + b[i]);
      relations.push_back(relate(forward(), course_of_rate(t_s, mean, 1e300)));
    }
    relations.push_back(relate(upright_angle("yaw_rad"), rate("gyro_z_radps")));
  }

  for (const auto& [per_second, name] : {std::pair{1e3, "milliseconds"}, {1e6, "microseconds"}})
    for (const auto& relation : relations)
      if (relation && relation->correlation >= kTogether &&
          std::abs(std::log(relation->ratio * per_second)) < std::log(3))
        return add(Severity::refuse, "t_s",
                   fmt::format("looks like {}: it steps by {:.3g}, and the travel over that time is {:.3g} times that "
                               "of the speeds; divide it by {:.0f}",
                               name, median_s, relation->ratio, per_second));
  if (median_s > kLongestStep_s)
    return add(
        Severity::refuse, "t_s",
        fmt::format("steps by {:.3g}, too long for seconds: it is in another unit, or no log of a drive; convert "
                    "it to seconds",
                    median_s));
  if (median_s >= kCoarse_s)
    add(Severity::warn, "t_s",
        fmt::format("steps by {:.3g} s: too coarse for a diagnosis, if it is in seconds", median_s));

  if (std::abs(t_s.front()) > kEpoch_s)
    add(Severity::warn, "t_s", fmt::format("begins at {:.0f} s; it counts from the start of the run", t_s.front()),
        line(0));

  // Gaps and odd steps, compared with the median step.
  std::size_t gaps = 0, first_gap = 0, odd = 0;
  double longest_s = 0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double step_s = t_s[i] - t_s[i - 1];
    if (step_s < 0.5 * median_s || step_s > 2 * median_s) ++odd;
    if (step_s <= std::max(kGapSteps * median_s, kCoarse_s)) continue;
    if (gaps++ == 0) first_gap = i;
    longest_s = std::max(longest_s, step_s);
  }

  if (gaps > 0)
    add(Severity::warn, "t_s",
        fmt::format("has {} gaps of up to {:.3g} s between rows that are {:.3g} s apart: rows were lost, or the file "
                    "contains several runs",
                    gaps, longest_s, median_s),
        line(first_gap));
  if (static_cast<double>(odd) > kOddShare * static_cast<double>(t_s.size()))
    add(Severity::warn, "t_s",
        fmt::format("{} of {} steps are less than half or more than twice the median of {:.3g} s: use the times of "
                    "measurement, not of writing",
                    odd, t_s.size() - 1, median_s));
}

void RunChecks::check_same_length(const std::string& name, const std::string& other,
                                  const std::optional<Relation>& relation) {
  if (!relation || relation->correlation < kTogether || found(name) || found(other)) return;
  const bool first_large = relation->ratio > kLengthFactor;
  if (!first_large && relation->ratio > 1 / kLengthFactor) return;
  const double factor = first_large ? relation->ratio : 1 / relation->ratio;
  add(Severity::refuse, first_large ? name : other,
      fmt::format("looks like {}: it is {:.3g} times what {} says; columns are in metres", length_unit(factor), factor,
                  first_large ? other : name));
}

void RunChecks::check_same_angle(const std::string& name, const std::string& other,
                                 const std::optional<Relation>& relation, double enough, double least_factor) {
  if (!relation || relation->correlation < kTogether || std::min(relation->first, relation->second) < enough) return;
  if (found(name) || found(other)) return;
  const bool first_large = relation->ratio > least_factor;
  if (!first_large && relation->ratio > 1 / least_factor) return;
  const double factor = first_large ? relation->ratio : 1 / relation->ratio;
  add(Severity::refuse, first_large ? name : other,
      fmt::format("looks like degrees: it is {:.3g} times what {} says; columns are in radians", factor,
                  first_large ? other : name));
}

void RunChecks::check_turned_sign(const std::string& name, const std::string& other,
                                  const std::optional<Relation>& relation, double enough_first, double enough_second,
                                  const std::string& what_to_do) {
  if (!relation || relation->correlation > -kTogether || found(name) || found(other)) return;
  if (relation->first < enough_first || relation->second < enough_second) return;
  add(Severity::refuse, name,
      fmt::format("has the opposite sign of {} (correlation {:.2f}): {}", other, relation->correlation, what_to_do));
}

void RunChecks::check_against_tracks(const std::string& name, const std::optional<Relation>& relation,
                                     const std::optional<Relation>& on_level, double enough, double least_ratio,
                                     double most_ratio, const std::string& what_to_do) {
  // Refused only where a turned sign is certain: on level ground, and about as far as the tracks.
  const auto against = [&](const std::optional<Relation>& one) {
    return one && one->correlation <= -kTogether && one->first >= enough && one->second >= 2 * kLeastMove_m;
  };
  if (!against(relation) || found(name)) return;
  if (against(on_level) && on_level->ratio >= least_ratio && on_level->ratio <= most_ratio)
    return add(
        Severity::refuse, name,
        fmt::format("has the opposite sign of the tracks (correlation {:.2f}): {}", on_level->correlation, what_to_do));
  add(Severity::warn, name,
      fmt::format("is opposite to the tracks (correlation {:.2f}), as for a robot that slides down a slope; on level "
                  "ground the sign is wrong: {}",
                  relation->correlation, what_to_do));
}

// Slip and a blocked robot only make the pose's path shorter than the tracks'.
void RunChecks::check_pose_against_tracks() {
  const auto along = relate(forward(), belts(0.5, 0.5)), turning = relate(upright_angle("yaw_rad"), belts(-1, 1));
  const bool knows_slope = has("pitch_rad") || has("posture_pitch_rad");
  // Lengths: the robot cannot be far beyond where its tracks carried it and where it may have slid.
  const double way_m = distance_of_belts(), farthest_m = farthest_from_start();
  constexpr double kSlide_m = 1;  // without its tracks: down a slope, off an edge
  if (farthest_m > kLengthFactor * (way_m + 0.1) && farthest_m > kLengthFactor * kSlide_m && has("cmd_track_left_mps"))
    add(Severity::refuse, "x_m",
        fmt::format("looks like {} together with y_m: the robot is up to {:.4g} from its start, but its tracks went "
                    "{:.3g} m; columns are in metres",
                    length_unit(farthest_m / (way_m + 0.1)), farthest_m, way_m));
  // Sign of the way forward.
  check_against_tracks("x_m", along, knows_slope ? relate(forward(kLevel_rad), belts(0.5, 0.5)) : along,
                       2 * kLeastMove_m, kLeastGrip, kMostGrip,
                       "x is forward at the start, and yaw the heading of the robot's front");
  // Unit and sign of yaw: without slip, turn = (right - left) / gauge.
  if (turning && turning->correlation >= kTogether && robot_ != nullptr && !found("yaw_rad")) {
    // With slip a robot turns less than its tracks say, never several times as much.
    const double turned = turning->ratio * robot_->track_gauge_m();
    if (turned > kAngleFactor && turning->first > kLeastTurn_rad * kDegreesInARadian / 4)
      add(Severity::refuse, "yaw_rad",
          fmt::format(
              "looks like degrees: the robot turns {:.3g} times as far as its tracks turn it; columns are in radians",
              turned));
  }
  const double by_gauge = robot_ != nullptr ? 1 / robot_->track_gauge_m() : 0;
  check_against_tracks(
      "yaw_rad", turning, knows_slope ? relate(upright_angle("yaw_rad", kLevel_rad), belts(-1, 1)) : turning,
      2 * kLeastTurn_rad, kLeastGripInTurns * by_gauge, robot_ != nullptr ? kMostGrip * by_gauge : 1e300,
      "a left turn is positive, and then the right track is the faster one");
}

// Degrees whose steps from pose to pose are beyond pi: read as radians they unwrap to the wrong turns, so that yaw goes
// with nothing. Read as degrees it goes with the gyro, or else with the tracks.
void RunChecks::check_coarse_degrees() {
  struct Other {
    const char* name;
    Course course;
    double least, most;  // of yaw over it
  };
  std::vector<Other> others;
  if (has("gyro_z_radps"))
    others.push_back({"gyro_z_radps says", rate("gyro_z_radps"), 1 / kMostYawOverGyro, kMostYawOverGyro});
  if (robot_ != nullptr)
    others.push_back({"the tracks turn it", belts(-1, 1), kLeastTurnOfBelts / robot_->track_gauge_m(),
                      kMostTurnOfBelts / robot_->track_gauge_m()});
  const Course as_read = upright_angle("yaw_rad"),
               as_degrees = upright_angle("yaw_rad", kUpright_rad, kDegreesInARadian);
  for (const Other& other : others) {
    const auto read = relate(as_read, other.course), degrees = relate(as_degrees, other.course);
    // Where it goes with the other as read, and far enough, steps are small, and the other checks judge.
    if (read && read->correlation >= kTogether && read->ratio >= other.least) return;
    if (!degrees || degrees->correlation < kTogether || degrees->first < kLeastTurn_rad) continue;
    if (degrees->ratio < other.least || degrees->ratio > other.most || found("yaw_rad")) continue;
    return add(
        Severity::refuse, "yaw_rad",
        fmt::format("looks like degrees: read so, the robot turns as {} (correlation {:.2f}), read as radians it "
                    "does not (correlation {:.2f}); columns are in radians: multiply by pi/180",
                    other.name, degrees->correlation, read ? read->correlation : 0));
  }
}

void RunChecks::check_scales() {
  // A track whose command is small compared with the other's may be dragged by it, against its own command.
  double most_asked_m = 0;
  for (const std::string side : kSides) {
    const auto asked = rate("cmd_track_" + side + "_mps");
    if (const auto itself = relate(asked, asked)) most_asked_m = std::max(most_asked_m, itself->first);
  }

  // Tracks: command, speed and travel of each side against each other.
  const double enough_asked_m = std::max(kLeastMove_m, kDragged * most_asked_m);
  for (const std::string side : kSides) {
    const std::string command = "cmd_track_" + side + "_mps", speed = "track_" + side + "_mps",
                      travel = "track_" + side + "_m";
    const auto by_command = relate(rate(command), rate(speed)), by_travel = relate(adding(travel), rate(speed));
    const auto may_be_dragged = [&](const std::optional<Relation>& asked) {
      return asked && asked->first < kDragged * most_asked_m;
    };
    if (!may_be_dragged(by_command)) check_same_length(command, speed, by_command);
    check_same_length(travel, speed, by_travel);
    const std::string words = "a track that carries the robot forward is positive, on both sides";
    // With a turned sign a track goes about as far as commanded. One that goes much farther is dragged, one that hardly
    // moves is within a dead band.
    if (!by_command || std::abs(std::log(by_command->ratio)) < std::log(kAsCommanded))
      check_turned_sign(speed, command, by_command, enough_asked_m, kLeastMove_m,
                        words + "; or are left and right exchanged?");
    check_turned_sign(travel, speed, by_travel, kLeastMove_m, kLeastMove_m, words);
    if (!has(speed)) {
      const auto both = relate(rate(command), adding(travel));
      if (!may_be_dragged(both)) check_same_length(command, travel, both);
      if (!both || std::abs(std::log(both->ratio)) < std::log(kAsCommanded))
        check_turned_sign(travel, command, both, enough_asked_m, kLeastMove_m, words);
    }
  }

  // Sides exchanged: each track follows the other one's command.
  const auto crossed = [this](const std::string& side, const std::string& other_side) {
    const auto own = relate(rate("cmd_track_" + side + "_mps"), rate("track_" + side + "_mps"));
    const auto across = relate(rate("cmd_track_" + side + "_mps"), rate("track_" + other_side + "_mps"));
    return own && across && own->correlation < 0.5 && across->correlation > 0.95;
  };
  if (crossed("left", "right") && crossed("right", "left") && !found("track_left_mps"))
    add(Severity::refuse, "track_left_mps",
        "follows cmd_track_right_mps, and track_right_mps the left one: left and right are exchanged");

  // Flippers: angle against command, by value.
  for (const std::string_view flipper : robot::kFlipperNames) {
    const std::string angle = fmt::format("flipper_{}_rad", flipper), command = "cmd_" + angle;
    const auto relation = relate_values(command, angle);
    check_same_angle(command, angle, relation, kLeastTurn_rad, kAngleFactor);
    // A servo too weak for its load lets the arm go the other way, too, but not as far.
    if (relation && std::abs(std::log(relation->ratio)) > std::log(kSameWay)) continue;
    check_turned_sign(angle, command, relation, kLeastTurn_rad, kLeastTurn_rad,
                      "0 is straight out along the body, tip up is positive, for all four flippers");
  }

  // The pose's angles against the gyro.
  check_coarse_degrees();
  for (const auto& [angle, axis] : {std::pair{"yaw_rad", "z"}, {"pitch_rad", "y"}, {"roll_rad", "x"}}) {
    const std::string gyro = std::string("gyro_") + axis + "_radps";
    const auto relation = relate(upright_angle(angle), rate(gyro));
    check_same_angle(angle, gyro, relation, kLeastTurn_rad / 5, angle[0] == 'y' ? kYawFactor : kAngleFactor);
    check_turned_sign(angle, gyro, relation, kLeastTurn_rad, kLeastTurn_rad,
                      "x forward, y left, z up: roll is positive right side down, pitch nose down, yaw to the left");
  }
  check_pose_against_tracks();
}

void RunChecks::check_ranges() {
  const auto largest = [this](const std::string& name) {
    double most = 0;
    for (const double value : column(name)) most = std::isnan(value) ? most : std::max(most, std::abs(value));
    return most;
  };
  const auto line_above = [this](const std::string& name, double limit) {
    const auto values = column(name);
    return line(static_cast<std::size_t>(
        std::ranges::find_if(values, [limit](double v) { return std::abs(v) > limit; }) - values.begin()));
  };
  const auto refuse_above = [&](const std::string& name, double limit, const std::string& text) {
    if (const double most = largest(name); most > limit)
      add(Severity::refuse, name, fmt::format("is {:.4g} {}", most, text), line_above(name, limit));
  };

  // Speeds, angles, turn rates, voltage and currents that no robot has.
  const double most_mps = robot_ != nullptr ? robot_->drive.max_speed_mps : kMostSpeed_mps;
  for (const std::string name : {"cmd_track_left_mps", "cmd_track_right_mps", "track_left_mps", "track_right_mps"})
    refuse_above(
        name, kLengthFactor * most_mps,
        fmt::format("although the highest speed is {:.3g} m/s: it looks like millimetres or centimetres per second",
                    most_mps));
  // z-y-x angles lie in these ranges by their definition.
  constexpr double kRounding = 0.01;
  refuse_above("pitch_rad", 0.5 * std::numbers::pi + kRounding,
               "at most, beyond pi/2, the limit of pitch: it looks like degrees");
  refuse_above("roll_rad", 2 * std::numbers::pi + kRounding, "at most, beyond a whole turn: it looks like degrees");
  for (const std::string name : {"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"})
    refuse_above(name, 60, "rad/s at most, ten turns per second: it looks like degrees per second");
  refuse_above("battery_v", 1000, "V: it looks like millivolts");
  const auto check_current = [&](const std::string& name, double largest_a) {
    if (!(largest_a > 0)) return refuse_above(name, kNoCurrent_a, "A: it looks like milliamperes");
    refuse_above(
        name, kFarAbove * largest_a,
        fmt::format("A, although the robot's description allows {:.3g} A at most: it looks like milliamperes; divide "
                    "by 1000",
                    largest_a));
  };
  const double of_track_a =
      robot_ != nullptr ? robot_->drive.idle_amperes + robot_->drive.amperes_per_newton * robot_->drive.max_force_n : 0;
  const double of_flipper_a =
      robot_ != nullptr && robot_->has_flippers() ? robot_->servo.amperes_per_nm * robot_->servo.max_torque_nm : 0;
  for (const std::string side : kSides) check_current("track_" + side + "_a", of_track_a);
  for (const std::string_view flipper : robot::kFlipperNames)
    check_current(fmt::format("flipper_{}_a", flipper), of_flipper_a);

  // Flippers against their limits: far beyond, the unit is wrong; somewhat beyond, a warning.
  if (robot_ != nullptr && robot_->has_flippers()) {
    const physics::FlipperDescription& limits = robot_->flipper.front();
    const double limit = std::max(std::abs(limits.min_angle_rad), std::abs(limits.max_angle_rad));
    for (const std::string_view flipper : robot::kFlipperNames)
      for (const std::string& name :
           {fmt::format("cmd_flipper_{}_rad", flipper), fmt::format("flipper_{}_rad", flipper)}) {
        refuse_above(name, 3 * limit, fmt::format("although its limit is {:.3g} rad: it looks like degrees", limit));
        constexpr double kLoose_rad = 0.5;  // of an encoder with an offset, a stop that gives way
        if (const double most = largest(name); most > limit + kLoose_rad && !found(name))
          add(Severity::warn, name, fmt::format("goes to {:.3g} rad, beyond its limit of {:.3g} rad", most, limit),
              line_above(name, limit + kLoose_rad));
      }
  }

  // Accelerometer: the median of its norm should be about g.
  const auto x = column("acc_x_mps2"), y = column("acc_y_mps2"), z = column("acc_z_mps2");
  std::vector<double> norms;
  for (std::size_t i = 0; i < std::min({x.size(), y.size(), z.size()}); ++i)
    if (const double norm = std::hypot(x[i], y[i], z[i]); !std::isnan(norm)) norms.push_back(norm);
  if (norms.empty()) return;
  const auto middle = norms.begin() + std::ssize(norms) / 2;
  std::ranges::nth_element(norms, middle);
  if (*middle > 0.8 && *middle < 1.2)
    add(Severity::refuse, "acc_x_mps2",
        fmt::format("looks like multiples of g, with acc_y and acc_z: their norm is {:.3g}; at rest it is 9.81 m/s2",
                    *middle));
  else if (*middle > 500)
    add(Severity::refuse, "acc_x_mps2",
        fmt::format("looks like millimetres or centimetres, with acc_y and acc_z: their norm is {:.4g}; at rest it is "
                    "9.81 m/s2",
                    *middle));
  else if (*middle < 5 || *middle > 20)
    add(Severity::warn, "acc_x_mps2",
        fmt::format("its norm with acc_y and acc_z is usually {:.3g}; at rest it is 9.81 m/s2, gravity included",
                    *middle));
}

}  // namespace kenaf::gap::logs
