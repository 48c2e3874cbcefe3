#include "gap/diagnose/trend.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/significance.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// p value above which differences between halves of manoeuvres count as chance (chosen).
constexpr double kNoTrend = 0.001;

// An effect explains a kind of channels if the residual there is smaller than its shift, and rests on it if its squared
// shift is this share of that in the kind where it is largest (chosen).
constexpr double kRestsOn = 0.1;

// Sums over bins for the estimate left / effect of a value: of the residual along the effect, and of the effect itself.
struct Along {
  double left = 0, effect = 0;
  Along& operator+=(const Along& more) {
    left += more.left;
    effect += more.effect;
    return *this;
  }
};

// The later half's estimate minus the earlier half's in one manoeuvre.
struct Trend {
  double difference, variance;
  double information;  // of the value: squares of the effect's derivative, in noise
};

// Information-weighted rms of trends, without their noise variance; 0 if chance explains them.
double rms_of(const std::vector<Trend>& trends) {
  double in_noise = 0, squares = 0, information = 0;
  for (const Trend& trend : trends) {
    const double square = trend.difference * trend.difference;
    in_noise += square / trend.variance;
    squares += trend.information * (square - trend.variance);
    information += trend.information;
  }
  if (trends.empty() || p_of_squares(in_noise, static_cast<double>(trends.size())) > kNoTrend) return 0;
  return std::sqrt(std::max(0.0, squares / information));
}

// The trend in one series of a group: halves are parted at half of the effect's squared shift.
std::optional<Trend> trend_in(const StageGroup& group, const Series& series, const Eigen::Ref<const VectorXd>& column,
                              const VectorXd& left) {
  const double all = (column.array().square() / group.variance.array()).segment(series.first, series.count).sum();
  Along early, late;
  for (Index i = series.first; i < series.first + series.count; ++i) {
    const double along = column[i] / group.variance[i];
    const Along here{along * left[i], along * column[i]};
    (early.effect + here.effect / 2 < all / 2 ? early : late) += here;
  }
  if (!(early.effect > 0) || !(late.effect > 0)) return std::nullopt;
  return Trend{late.left / late.effect - early.left / early.effect, 1 / late.effect + 1 / early.effect,
               late.effect + early.effect};
}

// Trends and sums over all series of one kind.
struct OfKind {
  std::vector<Trend> trends;
  double left = 0, taken_off = 0;  // squares of the residual and of the effect's shift, in noise
};

}  // namespace

double trend(const StageData& data, const std::vector<Eigen::MatrixXd>& columns, Index effect, double away,
             const GroupVectors& left) {
  std::vector<OfKind> kinds(kind_count());
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const StageGroup& group = data.groups[g];
    const auto column = columns[g].col(effect);
    for (const Series& series : group.series) {
      OfKind& kind = kinds[series.kind];
      const auto squares = [&](const VectorXd& of_bins) {
        return (of_bins.array().square() / group.variance.array()).segment(series.first, series.count).sum();
      };
      kind.left += squares(left[g]);
      kind.taken_off += squares(away * column);
      if (const auto trend = trend_in(group, series, column, left[g])) kind.trends.push_back(*trend);
    }
  }
  const double most = std::ranges::max(kinds, {}, &OfKind::taken_off).taken_off;
  double largest = 0;
  for (const OfKind& kind : kinds)
    if (kind.left < kind.taken_off && kind.taken_off > kRestsOn * most)
      largest = std::max(largest, rms_of(kind.trends));
  return largest;
}

}  // namespace kenaf::gap::diagnose
