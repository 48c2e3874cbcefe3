// Processes that make one diagnosis together, on one machine or on several.
//
// All of them run the same program on the same data and decide alike; only simulations are shared out between them.
// So the result does not depend on how many there are, bit for bit, as long as their processors and libraries agree.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace kenaf::gap {

struct Ranks {
  int rank = 0, count = 1;
  // Each rank comes with those results[j] for which j % count is its rank, and leaves with all. All ranks call it
  // together.
  std::function<void(std::vector<Eigen::VectorXd>& results)> share;
  // Whether it is true of any rank. All ranks call it together.
  std::function<bool(bool)> any;
};

}  // namespace kenaf::gap
