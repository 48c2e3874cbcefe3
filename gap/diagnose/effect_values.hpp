// How sure the values of a model's effects are, and whether all manoeuvres want the same.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

struct Interval {
  double value = 0, from = 0, to = 0;  // 95 %
};
inline constexpr double kHalfWidth = 1.96;  // half of an interval, in standard errors

// The value of one effect: a mean, and how far it differs from manoeuvre to manoeuvre.
struct EffectValue {
  Interval value;
  // Standard deviation between manoeuvres beyond what noise and discrepancy explain (a random effect, DerSimonian and
  // Laird 1986); 0 where they agree.
  double spread = 0;
  double p_agree = 1;  // chance that manoeuvres that agree differ as much (Cochran's Q)
  double trend = 0;    // by how much later parts of manoeuvres want another value than earlier ones (trend.hpp)
};
// Of each effect of a model that stands. Intervals and what manoeuvres want by themselves stay in the parameter's
// range.
std::vector<EffectValue> effect_values(const StageData& data, const StandingModel& standing);

// How the model's shift changes with each value, of each group, by its curves.
std::vector<Eigen::MatrixXd> slopes(const StageData& data, const StandingModel& standing);

}  // namespace kenaf::gap::diagnose
