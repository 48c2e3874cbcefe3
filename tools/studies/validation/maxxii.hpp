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
  std::string name;  // "on the spot", "curve, right track faster", "tracks differ by up to 0.1 m/s", ...
  std::size_t count = 0;
  // Turn over that of slipless tracks, medians: measured, with the median distance from it; by the description; with
  // the drive asymmetry.
  double measured = 0, measured_scatter = 0;
  double simulated = 0, corrected = 0;
};

struct SteadyStates {
  std::size_t count = 0;
  double drive_asymmetry = 0;  // as in physics::Effects; mean of the fits to the two halves of the states
  // Median of what the simulation leaves of the slips' difference between the tracks: by the description, and with the
  // asymmetry that was fitted to the other half.
  double median_mps = 0, corrected_median_mps = 0;
  std::vector<TurningKind> kinds;
};

// Throws runs::RunFileError if the file cannot be read or lacks a column.
SteadyStates compare_steady_states(const std::filesystem::path& table);

}  // namespace kenaf::validation
