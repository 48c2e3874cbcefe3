// Measures how far the gap of runs shrinks with the findings of a report and with the hidden effects.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "gap/challenge/compared_runs.hpp"

namespace kenaf::gap::challenge {

struct Shrinks {
  double before = 0, floor = 0;  // rms in units of noise, as in reports
  double report = 0;             // with the robot of the report
  double hidden = 0;             // with the hidden effects
};

struct ShrinksOfRuns {
  std::array<Shrinks, kEachChannelOnce.size()> of_stage;  // each in its own replay
  Shrinks together;                                       // each kind of channels of each stage weighted by its own gap
};

// Measures all runs of a dataset by the diagnosis' own simulation, floor and measure (gap_size.hpp); the floor is that
// of the model with the hidden effects. Deterministic, on any number of threads. Throws as observe() does.
ShrinksOfRuns shrinks_on(const std::filesystem::path& dataset, const physics::RobotDescription& report,
                         const physics::RobotDescription& hidden, unsigned threads);

// The shrinks of one case; empty if not measured.
struct CaseShrinks {
  std::vector<Shrinks>
      heldout;  // of each stage in which the report names something; `report` is its figure, of held-out runs
  std::optional<Shrinks> unseen;  // on runs of a manoeuvre that the diagnosis did not have, all stages together
};

}  // namespace kenaf::gap::challenge
