// A manoeuvre: what is driven, as data. One place for tests, benchmarks, the command line and the diagnosis.
//
// Each file in manoeuvres/ holds one or more manoeuvres that share their phases and differ in their world. A phase sets
// track speeds and flipper angles and lasts until an operator who watches posture and place would go on.
// docs/manoeuvres.md lists every key. SI units, radians, frames of REP 103; pitch positive nose down.
// Thread safety: values.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics/pose.hpp"
#include "physics/robot_command.hpp"

namespace kenaf::rollout {

// A phase ends when any of these holds, or its time is up.
struct PhaseEnd {
  std::optional<double> pitch_above_rad, pitch_below_rad;
  std::optional<double> x_above_m, x_below_m, z_above_m;
  std::optional<double> turned_rad;  // |yaw| since the phase began, at least
};

struct Phase {
  std::array<double, physics::kTrackCount> track_mps{};
  std::optional<std::array<double, physics::kFlipperCount>> flipper_rad;  // empty: as before
  double at_most_s = 0;
  PhaseEnd end;
};

// When the manoeuvre counts as done: where the robot is at its end.
struct Success {
  std::optional<double> x_above_m, z_above_m, z_below_m;
  double upright_within_rad = std::numeric_limits<double>::infinity();  // roll and pitch
};

struct Manoeuvre {
  std::string name, summary;
  std::string world;        // shipped name or path
  double start_lift_m = 0;  // above the start pose of the world
  std::vector<Phase> phases;
  std::optional<Success> success;
  double at_most_s() const;  // of all phases
};

// A shipped name ("step-200-flippers"), the path of a TOML file that holds one manoeuvre, or "replay:FILE.csv", which
// repeats the commands of a recorded run at their times. Throws physics::DescriptionError with file, line and column.
Manoeuvre load_manoeuvre(const std::string& name);
std::vector<Manoeuvre> parse_manoeuvres(std::string_view toml_text, const std::string& name_for_errors);
// All shipped ones, in the order of their names.
std::vector<Manoeuvre> shipped_manoeuvres();

}  // namespace kenaf::rollout
