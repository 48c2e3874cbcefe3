// The runs that the page draws: one measured run per manoeuvre, with its nominal and its corrected simulation.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {

struct Overlay {
  std::size_t group, run;             // index into Diagnosis::repeats; its representative
  std::vector<std::size_t> channels;  // those with most of the gap in this manoeuvre, of diagnosis_channels()
  std::vector<double> shares;         // of each of these channels, in everything beyond chance in all runs
  runs::Run nominal;
  std::optional<runs::Run> corrected;  // with corrections(), if there are any
};

// The groups of repeats with most of the gap, as many as a page has room for, in the order of the dataset.
std::vector<std::size_t> shown_groups(const Diagnosis& d);

// The nominal robot with corrections(), if there are any and it is possible.
std::optional<Variation> corrected_robot(const Diagnosis& d, const Predictor& predictor);

// Simulates them. Empty for a dataset that was never compared with its simulation (interrupted early).
std::vector<Overlay> simulate_overlays(const Diagnosis& d);

// Chooses two to four channels each; of left and right, or of four flippers, only the one with most of the gap.
void choose_channels(const Diagnosis& d, std::vector<Overlay>& overlays);

// A column over time, without missing values; broken at long gaps. Angles are unwrapped.
std::vector<plot::Point> over_time(const runs::Run& run, std::size_t channel);

}  // namespace kenaf::gap::diagnose
