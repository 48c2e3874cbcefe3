// Processes that compute one diagnosis together, on one or several machines.
//
// All run the same program on the same data and make the same decisions; only simulations are distributed. So the
// result is bit-identical for any number of processes, provided that processors and libraries match.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace kenaf::gap {

struct Ranks {
  int rank = 0, count = 1;
  // Each rank passes the results[j] with j % count == rank and receives all. Collective: all ranks call it together.
  std::function<void(std::vector<Eigen::VectorXd>& results)> share;
  // Returns whether the argument is true on any rank. Collective.
  std::function<bool(bool)> any;
};

}  // namespace kenaf::gap
