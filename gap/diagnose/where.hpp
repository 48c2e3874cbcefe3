// Locates the gap: in which channels, and at which times and places of each manoeuvre.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/phases.hpp"

namespace kenaf::gap::diagnose {

struct ChannelGap {
  std::size_t channel;  // of diagnosis_channels()
  double rms, floor;    // of the bins' residuals, and of their noise, in the channel's unit
  double share;         // of all that is beyond chance
};

struct PhaseGap {
  std::string manoeuvre;
  std::string_view phase;
  double from_s, to_s, x_m, y_m;
  double share;       // of all that is beyond chance
  std::size_t group;  // of repeats_of()
};

struct GapPlaces {
  std::vector<ChannelGap> channels;  // measured ones, largest share first
  std::vector<PhaseGap> phases;      // of one run of each group of repeats, largest share first
  double beyond_chance = 0;          // total of the shares: sum over cells, in units of the squared noise floor
};

// The energy of a cell beyond chance, in units of the squared noise floor.
double beyond_chance(const Cell& cell);
// Subtracting an open shape, such as an offset of one count, leaves its negative elsewhere. So a cell has the smaller
// energy of those with and without shapes subtracted.
std::vector<Cell> cells_that_stand_out(const NoiseFloor& floor, const Coherence& coherence,
                                       const std::vector<Eigen::VectorXd>& residual);

// `features` and `residual`: of every run, in the channels' units.
GapPlaces locate(const Observations& observations, const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                 const std::vector<std::vector<std::size_t>>& repeats, const Coherence& coherence,
                 const std::vector<Eigen::VectorXd>& residual);

}  // namespace kenaf::gap::diagnose
