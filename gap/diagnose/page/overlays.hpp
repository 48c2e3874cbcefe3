// The runs that the page draws: of each manoeuvre one as it was measured, with the nominal simulation and the corrected
// one.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {

struct Overlay {
  std::size_t group, run;             // of Diagnosis::repeats; its representative
  std::vector<std::size_t> channels;  // that show most of the gap in this manoeuvre, of diagnosis_channels()
  std::vector<double> shares;         // of each of these channels, of what is beyond chance in all runs
  runs::Run nominal;
  std::optional<runs::Run> corrected;  // with corrections(), where there are some
};

// The groups of repeats with most of the gap, as many as a page has room for, in the order of the dataset.
std::vector<std::size_t> shown_groups(const Diagnosis& d);

// Simulates them. What a dataset that was never compared with its simulation (interrupted early) has is empty.
std::vector<Overlay> simulate_overlays(const Diagnosis& d);

// Two or more, at most four; of left and right, or of four flippers, only the one with most of it.
void choose_channels(const Diagnosis& d, std::vector<Overlay>& overlays);

// A column over time, without what was not measured; broken where nothing was measured for long. Angles do not jump.
std::vector<plot::Point> over_time(const runs::Run& run, std::size_t channel);

}  // namespace kenaf::gap::diagnose
