// A term of a residual as a plain sentence, with the conditions in which it holds and what to look at.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "gap/diagnose/left_over_fit.hpp"

namespace kenaf::gap::diagnose {

// "yaw rate: measured 0.52 of the simulated, in every turn, at all speeds (84 % of what is left)".
std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term);
// "yaw rate: differs from run to run: 0.41 to 0.66 of the simulated was measured in the middle 80 % (30 % of ...)".
std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const RunFactor& by_run);

// The residual of each row after all other terms.
Eigen::VectorXd left_to(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term);

// Keys of the robot's description and names of effects, likeliest first; empty without a known cause.
std::vector<std::string> look_at(Quantity quantity, Regressor on);
std::vector<std::string> look_at_for_runs(Quantity quantity);

}  // namespace kenaf::gap::diagnose
