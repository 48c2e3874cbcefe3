// A recorded run and its simulations, sampled at the same times for display.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "gap/diagnose/phases.hpp"
#include "gap/playback/reported_places.hpp"
#include "gap/playback/run_gap.hpp"
#include "physics/effects.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"

namespace kenaf::gap::playback {

enum class PoseFrom { measured, dead_reckoning, nothing };

struct PlayedBody {
  std::string_view kind;  // "recorded", "nominal", "corrected"
  PoseFrom pose_from = PoseFrom::measured;
  // Pose of frame B in W at each time; NaN if unknown. Empty lists if it is never known.
  std::array<std::vector<double>, 3> p_WB_m;       // x, y, z
  std::array<std::vector<double>, 3> angles_rad;   // roll, pitch, yaw
  std::array<std::vector<double>, 4> flipper_rad;  // measured, or commanded, or 0
  std::array<std::vector<double>, 2> track_m;
  std::map<std::string, std::vector<double>> channels;  // by column, where there are any
};

struct PlayedRun {
  runs::DatasetRun entry;
  std::size_t rows;                    // in the file
  std::vector<double> times_s;         // from 0
  std::vector<PlayedBody> bodies;      // the recorded one first
  std::vector<diagnose::RunGap> gaps;  // of each body but the recorded one
  std::vector<diagnose::PhaseSpan> phases;
  std::vector<ReportedPhase> marks;  // of the report, largest share first
  std::vector<std::string> notes;    // unexpected facts, in sentences
};

// The robots, shared by the runs of a dataset.
struct PlayedRobots {
  physics::RobotDescription nominal;
  std::optional<physics::RobotDescription> corrected;
};

// Simulates the run with the nominal and, if there is one, the corrected robot, as a diagnosis does: the same commands
// from the same start, without noise. `path` names the file in notes. Shows at most `most_times` times. A run that
// cannot be simulated is shown alone, with a note. `floors`: as floors_of() returns them.
PlayedRun play_run(const runs::DatasetRun& entry, const runs::Run& run, const std::string& path,
                   const PlayedRobots& robots, const physics::WorldDescription& world, std::size_t most_times,
                   const std::map<std::string, Floor>& floors);

}  // namespace kenaf::gap::playback
