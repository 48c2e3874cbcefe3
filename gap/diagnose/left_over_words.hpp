// A term of what is left as a plain sentence, with where it holds, and what to look at because of it.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "gap/diagnose/left_over_fit.hpp"

namespace kenaf::gap::diagnose {

// "yaw rate: measured 0.52 of the simulated, in every turn, at all speeds (84 % of what is left)".
std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term);
// "yaw rate: measured of the simulated differs from run to run: 0.41 to 0.66 in the middle 80 %".
std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const RunFactor& by_run);

// What is left without all terms but this one, of each row.
Eigen::VectorXd left_to(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term);

// Keys of the robot's description and names of effects, the likeliest first; empty where nothing is known to do it.
std::vector<std::string> look_at(Quantity quantity, Regressor on);
std::vector<std::string> look_at_for_runs(Quantity quantity);

}  // namespace kenaf::gap::diagnose
