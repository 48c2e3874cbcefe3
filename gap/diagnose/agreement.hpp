// Whether the manoeuvres agree on a model's values. The right effect has one value; a combination that only looks like it
// needs another one in each manoeuvre.
//
// Stronger than what is left in all cells together: few degrees of freedom, in the direction in which a wrong model errs.
// Thread safety: pure functions.
#pragma once

#include <vector>

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

struct Agreement {
  double gained = 0;   // squared length that manoeuvres would explain beyond, each with values of its own
  double freedom = 0;  // how many values that are
  // Squared length that they would gain, were the right model's simulator off by one sigma of each of its numbers: the same in
  // all runs, so that it moves each manoeuvre's values its own way.
  double of_numerics = 0;
};
// `groups`: of repeats, as repeats_of() has them. A group has a value of its own of each effect that moves it by at least
// `visible` squared floors; of the others it says nothing, so that they keep the common value there. Of what the model explains in a group, `numerics` may be gained without counting. By curves.
// `shapes`: what the simulator's numbers shift in each run, as OpenShapes::numerics has them; none: they are known.
Agreement agreement(const EffectCurves& curves, const Model& model,
                    const std::vector<std::vector<std::size_t>>& groups, double visible, double numerics,
                    const std::vector<Eigen::MatrixXd>& shapes);

// Chance that a sum of `freedom` squared standard normals is larger (Wilson and Hilferty 1931: to 0.001 from three on); 1
// without freedom.
double p_of_squares(double sum, double freedom);

}  // namespace kenaf::gap
