// Uncertainty of the values of a model's effects, and whether manoeuvres agree on them.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/fit_by_kind.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

struct Interval {
  double value = 0, from = 0, to = 0;  // 95 %
};
inline constexpr double kHalfWidth = 1.96;  // half width of an interval, in standard errors

// The value of one effect: a mean, and its spread between manoeuvres.
struct EffectValue {
  Interval value;
  // Standard deviation between manoeuvres beyond what noise and discrepancy explain (a random effect, DerSimonian and
  // Laird 1986); 0 if they agree.
  double spread = 0;
  double p_agree = 1;  // p value of their differences if they agree (Cochran's Q)
  double trend = 0;    // difference between values fitted to later and earlier parts of manoeuvres (trend.hpp)
  FitByKind by_kind{};
};
// One per effect of the model. Intervals and the manoeuvres' own estimates stay within the parameter's range.
// `borne_out`: the deviance by which a kind of channels has to prefer a value of its own.
std::vector<EffectValue> effect_values(const StageData& data, const StandingModel& standing, double borne_out);

// Derivatives of the model's shift by each value, for each group, from its curves.
std::vector<Eigen::MatrixXd> slopes(const StageData& data, const StandingModel& standing);

}  // namespace kenaf::gap::diagnose
