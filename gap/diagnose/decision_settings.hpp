// Thresholds for calling something a gap, a cause, a rival.
//
// Thread safety: values.
#pragma once

#include <cstddef>

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap::diagnose {

struct DecisionSettings {
  double false_alarm = 0.005;       // probability of a verdict other than none without a gap, for both tests together
  double negligible = 0.25;         // of the noise's Euclidean norm over all bins: less is not a visible gap (chosen)
  double false_incomplete = 0.005;  // probability of calling a complete explanation incomplete
  double evidence = 16;       // deviance an effect must gain: 4 sigma, for the best of some 70 candidates (chosen)
  double rival_evidence = 9;  // deviance by which a rival must be worse: 3 sigma
  // Shares of the squared gap on held-out runs, in the kind of channels where an effect removes most: minimum for the
  // effect, and for the whole model (chosen).
  double effect_share = 0.2, model_share = 0.5;
  double stage_share = 0.1;  // minimum share of the stage's whole squared gap for an effect (chosen)
  double ordinary = 3;       // a number of the description is named beyond so many sigma of the population
  // Minimum of an effect over its spread between manoeuvres (chosen: five in six then agree on its sign).
  double agreement = 1;
  // Largest difference between values fitted to later and earlier parts of manoeuvres, as a fraction of the effect
  // (chosen; it is 1 if the effect grows from zero with time).
  double steady = 0.75;
  // Most that may be left of an effect's shift in a kind of channels that it should explain, rms: the sine of the angle
  // from which causes are distinguishable (isolability.hpp), as a cause at a smaller angle would leave less.
  double left_of_kind = 0.174;
  // Largest difference between the value of one kind of channels and that of all, as a fraction of the effect (chosen).
  double alike = 0.3;
  // In a set, two effects at least stand in for each other: the sine of the angle between their shifts is at most this
  // (chosen: half of what one does, squared, the other could do).
  double apart_in_set = 0.7;
  // Relative increase of the squared residual in another stage that refutes an effect (chosen), in the kinds of
  // channels in which the effect acts there.
  double more_left = 0.1;
  std::size_t most_effects = 6;
  SearchSettings search;
};

}  // namespace kenaf::gap::diagnose
