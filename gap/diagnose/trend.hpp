// Tests whether an effect has a constant value during a manoeuvre; one that grows with time does not.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/likelihood.hpp"

namespace kenaf::gap::diagnose {

// Difference between the values fitted to the later and the earlier part of a manoeuvre, each with half of the effect's
// squared shift: information-weighted rms over manoeuvres beyond noise, the largest over the kinds of channels that the
// effect explains and rests on. (A position reached late, e.g. of an obstacle, shows only the mean on the way there,
// yet outweighs the way itself.) 0 if noise explains it.
//
// `columns`: derivatives by all values, for each group; the effect is column `effect`, `away` from its present value.
// `left`: the model's residual for each group, without open shapes. Uses noise alone, as the discrepancy of a wrong
// effect would absorb a drifting value.
double trend(const StageData& data, const std::vector<Eigen::MatrixXd>& columns, Eigen::Index effect, double away,
             const GroupVectors& left);

}  // namespace kenaf::gap::diagnose
