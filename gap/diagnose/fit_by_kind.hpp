// Whether an effect fits in every kind of channels that shows it. The cause does, at one value; an effect that only
// resembles the cause is fitted where their shifts are alike, and misfits elsewhere: a gain of the commands explains
// track speeds like a scale of the encoders, but asks for other currents.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

struct FitByKind {
  // The residual's coherent part over the effect's shift, both rms: the sine of the angle between the gap and the
  // effect, if nothing else acts. The largest of the kinds of channels that the effect should explain:
  // those in which its shift is a large part of the gap, and no small part of the whole shift.
  double left = 0;
  std::size_t left_in = 0;  // of kind_name()
  // Likewise, the largest difference from the common value of a value fitted to one kind alone that the data bear out.
  double apart = 0;
  std::size_t apart_in = 0;
};

// One per effect of the model. `left`: the model's residual for each group, without open shapes. `borne_out`: the
// additional deviance of the common value from which a kind's own value differs.
std::vector<FitByKind> fit_by_kind(const StageData& data, const StandingModel& standing, const GroupVectors& left,
                                   double borne_out);

}  // namespace kenaf::gap::diagnose
