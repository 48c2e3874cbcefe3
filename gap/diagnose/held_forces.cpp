#include "gap/diagnose/held_forces.hpp"

#include <algorithm>
#include <iterator>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

// How much of a bin precedes the first command to move.
double share_at_rest(const Bin& bin, const StageFeatures& run) {
  return std::clamp(run.at_rest_s / run.span_s - static_cast<double>(bin.span), 0.0, 1.0);
}

}  // namespace

std::vector<std::size_t> motor_currents(std::span<const std::size_t> channels) {
  std::vector<std::size_t> currents;
  std::ranges::copy_if(channels, std::back_inserter(currents),
                       [](std::size_t channel) { return diagnosis_channels()[channel].unit == "A"; });
  return currents;
}

Eigen::MatrixXd held_forces(const StageFeatures& run, std::span<const std::size_t> currents) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(std::ssize(run.bins), std::ssize(currents));
  for (Eigen::Index column = 0; column < shapes.cols(); ++column) {
    double sum = 0, rest = 0;
    for (Eigen::Index b = 0; b < shapes.rows(); ++b) {
      const Bin& bin = run.bins[static_cast<std::size_t>(b)];
      if (bin.channel != currents[static_cast<std::size_t>(column)]) continue;
      shapes(b, column) = share_at_rest(bin, run);
      sum += shapes(b, column) * run.measured[b];
      rest += shapes(b, column);
    }
    if (rest > 0) shapes.col(column) *= sum / rest;
  }
  return shapes;
}

}  // namespace kenaf::gap::diagnose
