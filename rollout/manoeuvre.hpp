// A manoeuvre, as data: one place for tests, benchmarks, the command line and the diagnosis.
//
// Each file in share/manoeuvres/ holds one or more manoeuvres that share their phases and differ in their world. A
// phase sets track speeds and flipper angles and lasts until an operator who watches posture and position would go on.
// docs/descriptions.md lists every key. SI units, radians, frames of REP 103; pitch positive nose down.
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

// A phase ends when any of these holds, or when its time is up.
struct PhaseEnd {
  std::optional<double> pitch_above_rad{}, pitch_below_rad{};
  std::optional<double> x_above_m{}, x_below_m{}, z_above_m{};
  std::optional<double> turned_rad{};  // |yaw| since the phase began, at least
};

// Position and posture of a robot that is stuck. All stated conditions must hold; at least one is stated.
struct GiveUp {
  std::optional<double> x_below_m{}, pitch_below_rad{};
};

struct Phase {
  std::string name;  // may be empty
  std::array<double, robot::kTrackCount> track_mps{};
  std::optional<std::array<double, robot::kFlipperCount>> flipper_rad;  // empty: as before
  double at_most_s = 0;
  PhaseEnd end;
  // If this holds when the phase would begin, the operator gives up: the last phase follows instead. Not for the first
  // phase, which always begins, nor for the last.
  std::optional<GiveUp> give_up{};
};

// The manoeuvre succeeds if the robot ends within these limits.
struct Success {
  std::optional<double> x_above_m{}, z_above_m{}, z_below_m{};
  double upright_within_rad = std::numeric_limits<double>::infinity();  // roll and pitch
};

struct TimedCommand {
  double t_s;
  robot::Command command;
};

// A start other than the world's: that of a recorded run, once the robot has settled.
struct Start {
  double x_m, y_m, yaw_rad;
  std::optional<double> z_m;                                              // empty: on the ground
  std::array<std::optional<double>, robot::kFlipperCount> flipper_rad{};  // empty: as the robot's description says
  std::optional<StartMotion> motion{};                                    // empty: it is at rest
};

struct Manoeuvre {
  std::string name, summary;
  std::string world;        // shipped name or path; empty: a replay without a known world
  double start_lift_m = 0;  // above the start pose of the world
  std::vector<Phase> phases;
  std::optional<Success> success;

  // A replay has these instead of phases: each command holds until the next one; the time of the last one ends it.
  std::vector<TimedCommand> timed;
  std::optional<Start> start;
  // Belts and flippers that follow this exactly instead of their commands, as if their drives were ideal.
  std::optional<MeasuredMotion> measured{};

  double at_most_s() const;  // of all phases
};

// Loads a manoeuvre: a shipped name ("step-200-flippers"), the path of a TOML file that holds one manoeuvre,
// "replay:FILE.csv" (replay_of() that recorded run), or "replay-measured:FILE.csv" (replay_measured_of() it). If the
// file is a run of the dataset.toml beside it, the replay gets that run's manoeuvre name and world. Throws
// DescriptionError with file, line and column; for a replay, runs::RunFileError.
Manoeuvre load_manoeuvre(const std::string& name);
// Parses the manoeuvres of a file; worlds of its own are looked up beside it.
std::vector<Manoeuvre> parse_manoeuvres(std::string_view toml_text, const std::string& name_for_errors);
// All shipped manoeuvres, sorted by name.
std::vector<Manoeuvre> shipped_manoeuvres();

// Replays a run's commands, from the pose, the flipper angles and the motion of its first rows on. An empty cell
// repeats the command before it. A run whose tracks were measured, but not x, y or yaw, starts at 0 of what is missing.
// Throws runs::RunFileError if the run has no command, neither a start nor tracks, or lasts more than an hour.
Manoeuvre replay_of(const runs::Run& run, const std::string& name_for_errors);
// The same with belts and flippers that turn as they were measured (rollout/measured_motion.hpp), so that commands and
// drives do not influence the body. A track or flipper that was never measured follows its command through its drive;
// if both tracks were measured, a run needs no commands. Also throws runs::RunFileError if nothing was measured.
Manoeuvre replay_measured_of(const runs::Run& run, const std::string& name_for_errors);

}  // namespace kenaf::rollout
