// A manoeuvre: what is driven, as data. One place for tests, benchmarks, the command line and the diagnosis.
//
// Each file in share/manoeuvres/ holds one or more manoeuvres that share their phases and differ in their world. A
// phase sets track speeds and flipper angles and lasts until an operator who watches posture and place would go on.
// docs/manoeuvres.md lists every key. SI units, radians, frames of REP 103; pitch positive nose down.
//
// Thread safety: values.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/pose.hpp"
#include "robot/command.hpp"
#include "rollout/measured_motion.hpp"

namespace kenaf::rollout {

constexpr double kLongestManoeuvre_s = 3600;

// A phase ends when any of these holds, or its time is up.
struct PhaseEnd {
  std::optional<double> pitch_above_rad{}, pitch_below_rad{};
  std::optional<double> x_above_m{}, x_below_m{}, z_above_m{};
  std::optional<double> turned_rad{};  // |yaw| since the phase began, at least
};

// Where and how a robot stands that gets no further; all that is stated must hold, and something is.
struct GiveUp {
  std::optional<double> x_below_m{}, pitch_below_rad{};
};

struct Phase {
  std::string name;  // may be empty
  std::array<double, robot::kTrackCount> track_mps{};
  std::optional<std::array<double, robot::kFlipperCount>> flipper_rad;  // empty: as before
  double at_most_s = 0;
  PhaseEnd end;
  // Where this holds when the phase's turn comes, the operator gives up: the last phase follows instead. Not of the
  // first phase, which always begins, nor of the last.
  std::optional<GiveUp> give_up{};
};

// When the manoeuvre counts as done: where the robot is at its end.
struct Success {
  std::optional<double> x_above_m{}, z_above_m{}, z_below_m{};
  double upright_within_rad = std::numeric_limits<double>::infinity();  // roll and pitch
};

struct TimedCommand {
  double t_s;
  robot::Command command;
};

// A start that is not the world's: that of a recorded run, where the robot is once it has settled.
struct Start {
  double x_m, y_m, yaw_rad;
  std::optional<double> z_m;                                            // empty: on the ground
  std::optional<std::array<double, robot::kFlipperCount>> flipper_rad;  // empty: as the robot's description says
  std::optional<StartMotion> motion{};                                  // empty: it stands
};

struct Manoeuvre {
  std::string name, summary;
  std::string world;        // shipped name or path; empty: a replay that does not know
  double start_lift_m = 0;  // above the start pose of the world
  std::vector<Phase> phases;
  std::optional<Success> success;

  // A replay instead of phases: each command holds until the next one, the last one's time ends it.
  std::vector<TimedCommand> timed;
  std::optional<Start> start;
  // Belts and flippers that follow this exactly instead of their commands, as if their drives were ideal.
  std::optional<MeasuredMotion> measured{};

  double at_most_s() const;  // of all phases
};

// A shipped name ("step-200-flippers"), the path of a TOML file that holds one manoeuvre, "replay:FILE.csv", which
// is replay_of() that recorded run, or "replay-measured:FILE.csv", replay_measured_of() it. Where that file is a run of
// the dataset.toml beside it, it has that run's manoeuvre name and world. Throws DescriptionError with file, line and
// column, for a replay runs::RunFileError.
Manoeuvre load_manoeuvre(const std::string& name);
// The manoeuvres of a file, whose own worlds are beside it.
std::vector<Manoeuvre> parse_manoeuvres(std::string_view toml_text, const std::string& name_for_errors);
// All shipped ones, in the order of their names.
std::vector<Manoeuvre> shipped_manoeuvres();

// The commands of a run, from the pose, the flipper angles and the motion of its first rows on. An empty cell holds
// what was commanded before. Throws runs::RunFileError where there is no command or no start in it, or it lasts
// more than an hour.
Manoeuvre replay_of(const runs::Run& run, const std::string& name_for_errors);
// The same with belts and flippers that turn as they were measured (rollout/measured_motion.hpp), so that command and
// drives play no part in what the body does. What was never measured follows its command through its drive; where both
// tracks were measured a run needs no commands. Throws runs::RunFileError too where nothing was measured.
Manoeuvre replay_measured_of(const runs::Run& run, const std::string& name_for_errors);

}  // namespace kenaf::rollout
