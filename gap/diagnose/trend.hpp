// Whether an effect has one value from the beginning of a manoeuvre to its end: what grows with the time has none.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/likelihood.hpp"

namespace kenaf::gap::diagnose {

// By how much the later part of a manoeuvre wants another value than the earlier one, each with half of what the effect
// shifts in it: rms over manoeuvres beyond noise, each as much as it says of the value. Of the kinds of channels that
// the effect explains and rests on, the one with the largest: a place that is reached late, as an obstacle is, tells
// only of the mean on the way there, and more than all the ways. 0 where noise explains all.
//
// `columns`: of each group, how all values shift it; the effect is column `effect`, `away` from its present value.
// `left`: what the model leaves of each group, less open shapes. Noise alone, for a value that differs in the course of
// time is what the discrepancy of a wrong effect looks like.
double trend(const StageData& data, const std::vector<Eigen::MatrixXd>& columns, Eigen::Index effect, double away,
             const GroupVectors& left);

}  // namespace kenaf::gap::diagnose
