#include "gap/diagnose/separation.hpp"

#include <Eigen/QR>
#include <cmath>

namespace kenaf::gap::diagnose {
namespace {

constexpr int kAtMostRounds = 100;
constexpr double kFitSettled = 1e-6;  // standard deviations, of all bins together

}  // namespace

double separation(const Eigen::VectorXd& difference, const Eigen::MatrixXd& free) {
  Eigen::VectorXd left = difference;
  if (free.cols() > 0 && free.rows() > 0) {
    // Iteratively reweighted least squares with Huber's weights: kOfOneBin / |residual| beyond the threshold.
    Eigen::VectorXd root_weight = Eigen::VectorXd::Ones(difference.size());
    for (int round = 0; round < kAtMostRounds; ++round) {
      const Eigen::MatrixXd weighted = root_weight.asDiagonal() * free;
      const Eigen::VectorXd amounts = weighted.colPivHouseholderQr().solve(root_weight.cwiseProduct(difference));
      const Eigen::VectorXd next = difference - free * amounts;
      const double moved = (next - left).norm();
      left = next;
      if (round > 0 && moved < kFitSettled) break;
      root_weight =
          left.unaryExpr([](double bin) { return std::sqrt(kOfOneBin / std::max(kOfOneBin, std::abs(bin))); });
    }
  }
  return left.cwiseMax(-kOfOneBin).cwiseMin(kOfOneBin).norm();
}

}  // namespace kenaf::gap::diagnose
