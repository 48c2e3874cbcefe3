// What it takes to call something a gap, a cause, a rival.
//
// Thread safety: values.
#pragma once

#include <cstddef>

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap::diagnose {

struct DecisionSettings {
  double false_alarm = 0.005;  // chance of a verdict other than none where there is no gap
  double negligible = 0.25;    // of the noise's length: what explains less is no gap that anybody would see (chosen)
  double surprise = 0.005;     // chance to call a complete explanation incomplete
  double evidence = 16;       // deviance that an effect must gain: 4 sigma, for the best of some 70 candidates (chosen)
  double rival_evidence = 9;  // deviance by which a rival must be worse: 3 sigma
  // Of the squared gap of the kind of channels where an effect takes off most, on runs held out: what the effect must
  // take off, and what the whole model must (chosen).
  double effect_share = 0.2, model_share = 0.5;
  double stage_share = 0.1;  // of the stage's whole squared gap, what the effect must take off (chosen)
  double ordinary = 3;       // a number of the description is named beyond so many sigma of all of them
  double agreement = 1;      // an effect is at least as many times its spread between manoeuvres (chosen): then five in
                             // six of them agree on its sign
  double steady = 0.75;  // of an effect, by how much later parts of manoeuvres may want another value than earlier ones
                         // (chosen): what grows from nothing with the time differs by all of itself
  double more_left = 0.1;  // of the squares that another stage leaves, what it must leave more of with an effect to
                           // refute it (chosen)
  std::size_t most_effects = 6;
  SearchSettings search;
};

}  // namespace kenaf::gap::diagnose
