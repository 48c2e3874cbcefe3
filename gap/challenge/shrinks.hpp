// How far the gap of runs shrinks with what a report found, beside how far it shrinks with what was hidden.
#pragma once

#include <filesystem>
#include <optional>

#include "physics/effects.hpp"

namespace kenaf::gap {

struct Shrinks {
  double before = 0, floor = 0;  // rms in noise floors, as in reports
  double told = 0;               // with the effects of the report
  double hidden = 0;             // with those that were hidden
};

// Of all runs of a dataset, by the diagnosis' own simulation and floor, which is that of the model with the hidden effects.
// Deterministic, on any number of threads. Throws as observe() does.
Shrinks shrinks_on(const std::filesystem::path& dataset, const physics::Effects& told, const physics::Effects& hidden,
                   unsigned threads);

// Of one case; nothing where it was not measured.
struct CaseShrinks {
  std::optional<Shrinks> heldout;  // on the runs that the report is of; `told` is the report's figure, of held-out runs
  std::optional<Shrinks> unseen;   // on runs of a manoeuvre that the diagnosis did not have
};

}  // namespace kenaf::gap
