// Steady states of MAXXII, a real robot on two tracks (arXiv 2409.18641), against its simulation.
//
// The table is a CSV file with motor_left_radps, motor_right_radps, slip_left_mps and slip_right_mps: the speed of a
// track by its motor, less that of the ground under it along the track.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kenaf::validation {

struct TurningKind {
  std::string name;  // "on the spot", "curve, right track faster", ...
  std::size_t count = 0;
  double measured = 0, measured_sd = 0;  // turn over that of slipless tracks
  double simulated = 0, corrected = 0;   // by the description; with what was fitted to the other half of the states
};

struct SteadyStates {
  std::size_t count = 0;
  // Fitted to one half of the states' slips and averaged over both halves: how much less the ground moves than a motor
  // says, per side, in parts of the track's speed, and the growth of that with the speed.
  double left_share = 0, right_share = 0, growth_spm = 0;
  double rms_mps = 0, corrected_rms_mps = 0;  // of the slips, over the states left out of each fit
  std::vector<TurningKind> kinds;
};

// Throws runs::RunFileError if the file cannot be read or lacks a column.
SteadyStates compare_steady_states(const std::filesystem::path& table);

}  // namespace kenaf::validation
