#include "gap/diagnose/left_over_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMostTerms = 3;          // chosen
constexpr std::size_t kMostHeldOutFolds = 10;  // chosen: as Hastie et al. recommend
constexpr std::size_t kLeastRows = 12;         // chosen: fewer are too few for four numbers
constexpr double kBeyondNoise = 0.1;           // of the noise's energy, minimum residual (chosen)
constexpr double kSameCause = 0.5;    // correlation with a rejected candidate (chosen: a quarter of its variance)
constexpr double kSameNumbers = 0.8;  // with a selected one (chosen: the rest is less than half of it)
constexpr double kSameSign = 0.95;    // of the draws of the bootstrap (chosen)
constexpr std::size_t kDraws = 200;   // chosen: enough to tell 95 from 90 %
// Range of a late term's lateness over its own parameter: outside it is no delay, lag or limit (chosen).
constexpr double kLeastOfLate = 0.5, kMostOfLate = 1.6;

MatrixXd columns_of(const LeftOverRows& rows, const std::vector<std::size_t>& terms) {
  MatrixXd x(rows.x.rows(), static_cast<Index>(terms.size()));
  for (std::size_t t = 0; t < terms.size(); ++t)
    x.col(static_cast<Index>(t)) = rows.x.col(static_cast<Index>(terms[t]));
  return x;
}

class LeftOverSelection {
 public:
  LeftOverSelection(const LeftOverRows& rows, const std::vector<std::size_t>& unit_of_row)
      : rows_(rows), unit_(unit_of_row), robust_(robust_for(rows)) {
    units_ = 1 + *std::ranges::max_element(unit_);
    folds_ = std::min(units_, kMostHeldOutFolds);
    left_ = robust_.losses(rows.error).sum();
    beyond_ = left_ - robust_.of_run.dot(rows.sigma.cwiseAbs2());
    noise_ = left_ - beyond_;
  }

  LeftOverFit fit() {
    LeftOverFit result;
    const bool is_left = beyond_ > kBeyondNoise * noise_;
    if (units_ >= 2 && is_left) result.terms = terms();
    const MatrixXd x = columns_of(rows_, chosen_);
    const VectorXd slopes = robust_slopes(x, rows_.error, robust_, VectorXd::Ones(x.rows()));
    for (std::size_t t = 0; t < chosen_.size(); ++t) result.terms[t].slope = slopes[static_cast<Index>(t)];
    result.rest = rows_.error - x * slopes;
    result.weights = robust_.row_weights(result.rest);
    if (is_left) result.by_run = run_factor(rows_, result, robust_, beyond_);
    limit_shares(result);
    return result;
  }

 private:
  // If terms explain more than the residual beyond noise, the noise is overestimated: scales them to a sum of 1.
  static void limit_shares(LeftOverFit& fit) {
    double sum = fit.by_run ? fit.by_run->share : 0;
    for (const LeftOverTerm& term : fit.terms) sum += term.share;
    if (sum <= 1) return;
    for (LeftOverTerm& term : fit.terms) term.share /= sum;
    if (fit.by_run) fit.by_run->share /= sum;
    if (fit.by_run && fit.by_run->share < kLeastReported) fit.by_run.reset();
  }

  std::vector<LeftOverTerm> terms() {
    std::vector<LeftOverTerm> terms;
    std::vector<bool> barred(rows_.candidates.size(), false);
    VectorXd losses = held_out_losses({});
    while (terms.size() < kMostTerms) {
      // the best candidate, and its share on held-out units
      const auto best = best_candidate(barred, losses);
      if (!best) break;
      std::vector<std::size_t> with = chosen_;
      with.push_back(*best);
      const VectorXd left = held_out_losses(with);
      const double share = (losses - left).sum() / beyond_;
      barred[*best] = true;
      if (share < kLeastReported) break;

      // a chance gain or an unstable sign: neither this one nor its look-alikes
      if (!is_no_chance(losses - left) || !has_one_sign(with)) {
        bar_alike(barred, *best, kSameCause);
        continue;
      }

      // accepted; similar candidates are barred from now on
      chosen_ = with;
      losses = left;
      terms.push_back({*best, share, 0});
      bar_alike(barred, *best, kSameNumbers);
      // a second lateness would only correct the shape of the first
      if (is_late(rows_.candidates[*best].kind))
        for (std::size_t c = 0; c < barred.size(); ++c) barred[c] = barred[c] || is_late(rows_.candidates[c].kind);
    }
    return terms;
  }

  // Bars collinear candidates: a rejected term must not return under another name, nor the difference of two similar
  // ones.
  void bar_alike(std::vector<bool>& barred, std::size_t candidate, double correlation) const {
    const VectorXd x = rows_.x.col(static_cast<Index>(candidate)).normalized();
    for (std::size_t c = 0; c < barred.size(); ++c)
      if (std::abs(x.dot(rows_.x.col(static_cast<Index>(c)).normalized())) > correlation) barred[c] = true;
  }

  // The candidate with the least loss; among kinds with about equal losses the first.
  std::optional<std::size_t> best_candidate(const std::vector<bool>& barred, const VectorXd& before) const {
    std::map<Regressor, std::pair<double, std::size_t>> best_of_kind;
    for (std::size_t c = 0; c < rows_.candidates.size(); ++c) {
      if (barred[c]) continue;
      std::vector<std::size_t> with = chosen_;
      with.push_back(c);
      if (!is_plausible(with)) continue;
      const double gain = (before - held_out_losses(with)).sum();
      // delay, lag and limit are one kind with three shapes
      const Regressor of = is_late(rows_.candidates[c].kind) ? Regressor::delay : rows_.candidates[c].kind;
      const auto [kind, is_new] = best_of_kind.try_emplace(of, gain, c);
      if (!is_new && gain > kind->second.first) kind->second = {gain, c};
    }
    if (best_of_kind.empty()) return std::nullopt;
    double best = 0;
    for (const auto& [kind, found] : best_of_kind) best = std::max(best, found.first);
    for (const auto& [kind, found] : best_of_kind)
      if (found.first >= best - kClearlyMore * beyond_) return found.second;
    return std::nullopt;
  }

  VectorXd held_out_losses(const std::vector<std::size_t>& terms) const {
    const MatrixXd x = columns_of(rows_, terms);
    VectorXd residual = rows_.error;
    if (!terms.empty())
      for (std::size_t fold = 0; fold < folds_; ++fold) {
        VectorXd mask = VectorXd::Ones(x.rows());
        for (std::size_t i = 0; i < unit_.size(); ++i)
          if (unit_[i] % folds_ == fold) mask[static_cast<Index>(i)] = 0;
        const VectorXd slopes = robust_slopes(x, rows_.error, robust_, mask);
        residual -= (1 - mask.array()).matrix().cwiseProduct(x * slopes);
      }
    return robust_.losses(residual);
  }

  // Whether each delay, lag or limit agrees with its parameter, given the fraction that is measured at all.
  bool is_plausible(const std::vector<std::size_t>& with) const {
    if (std::ranges::none_of(with, [&](std::size_t c) { return is_late(rows_.candidates[c].kind); })) return true;
    const MatrixXd x = columns_of(rows_, with);
    const VectorXd slopes = robust_slopes(x, rows_.error, robust_, VectorXd::Ones(x.rows()));
    std::vector<LeftOverTerm> terms;
    for (std::size_t t = 0; t < with.size(); ++t) terms.push_back({with[t], 0, slopes[static_cast<Index>(t)]});
    for (const LeftOverTerm& term : terms) {
      const LeftOverCandidate& candidate = rows_.candidates[term.candidate];
      if (!is_late(candidate.kind)) continue;
      const double late = lateness(rows_, terms, term);
      const double of_parameter = candidate.kind == Regressor::ramp ? late : std::abs(late) / candidate.parameter;
      if (!(of_parameter > kLeastOfLate && of_parameter < kMostOfLate)) return false;
    }
    return true;
  }

  bool is_no_chance(const VectorXd& gains) const {
    std::vector<double> by_unit(units_, 0);
    for (std::size_t i = 0; i < unit_.size(); ++i) by_unit[unit_[i]] += gains[static_cast<Index>(i)];
    return is_above_chance(by_unit);
  }

  // Whether the last term's slope has one sign in a bootstrap over units.
  bool has_one_sign(const std::vector<std::size_t>& with) const {
    // the robust fit to all rows, whose weights every draw keeps
    const MatrixXd x = columns_of(rows_, with);
    const VectorXd slopes = robust_slopes(x, rows_.error, robust_, VectorXd::Ones(x.rows()));
    const VectorXd weights = robust_.row_weights(rows_.error - x * slopes);

    // per unit u its part of the normal equations: A_u = X_u' W_u X_u, b_u = X_u' W_u y_u
    std::vector<MatrixXd> square(units_, MatrixXd::Zero(x.cols(), x.cols()));
    std::vector<VectorXd> right(units_, VectorXd::Zero(x.cols()));
    for (std::size_t i = 0; i < unit_.size(); ++i) {
      const auto row = static_cast<Index>(i);
      square[unit_[i]] += weights[row] * x.row(row).transpose() * x.row(row);
      right[unit_[i]] += weights[row] * rows_.error[row] * x.row(row).transpose();
    }

    // a draw solves (sum of A_u) slopes = sum of b_u over the drawn units; count slopes with the fit's sign
    std::mt19937_64 random(1);
    std::size_t same = 0;
    for (std::size_t draw = 0; draw < kDraws; ++draw) {
      MatrixXd sum = MatrixXd::Zero(x.cols(), x.cols());
      VectorXd sum_right = VectorXd::Zero(x.cols());
      for (std::size_t i = 0; i < units_; ++i) {
        const std::size_t unit = random() % units_;
        sum += square[unit];
        sum_right += right[unit];
      }
      const VectorXd drawn = ridge_solution(sum, sum_right);
      if (drawn[drawn.size() - 1] * slopes[slopes.size() - 1] > 0) ++same;
    }
    return static_cast<double>(same) >= kSameSign * static_cast<double>(kDraws);
  }

  const LeftOverRows& rows_;
  const std::vector<std::size_t>& unit_;
  RobustRows robust_;
  std::size_t units_ = 0, folds_ = 0;
  double left_ = 0, beyond_ = 0, noise_ = 0;
  std::vector<std::size_t> chosen_;
};

}  // namespace

std::vector<std::size_t> held_out_together(const LeftOverRows& rows, std::span<const std::size_t> group_of_run) {
  constexpr std::size_t kLeastGroups = 4;
  constexpr double kStretches = 12;  // of all runs together; chosen: enough for ten folds
  constexpr double kShortest_s = 1;  // length of a stretch; chosen: longer than usual lags
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> number;
  std::map<std::size_t, double> duration;  // of each run
  std::map<std::size_t, std::size_t> groups;
  for (std::size_t i = 0; i < rows.run.size(); ++i) {
    groups.try_emplace(group_of_run[rows.run[i]], groups.size());
    duration[rows.run[i]] = rows.time_s[static_cast<Index>(i)];
  }
  double total_s = 0;
  for (const auto& [run, seconds] : duration) total_s += seconds;
  const bool by_time = groups.size() < kLeastGroups;
  const double stretch_s = std::max(kShortest_s, total_s / kStretches);
  std::vector<std::size_t> units;
  for (std::size_t i = 0; i < rows.run.size(); ++i) {
    const auto stretch = static_cast<std::size_t>(rows.time_s[static_cast<Index>(i)] / stretch_s);
    const auto key = by_time ? std::pair(rows.run[i], stretch) : std::pair(group_of_run[rows.run[i]], std::size_t{0});
    units.push_back(number.try_emplace(key, number.size()).first->second);
  }
  return units;
}

LeftOverFit fit_left_over(const LeftOverRows& rows, const std::vector<std::size_t>& unit_of_row) {
  if (rows.run.size() < kLeastRows) return {{}, std::nullopt, rows.error, VectorXd::Ones(rows.error.size())};
  return LeftOverSelection(rows, unit_of_row).fit();
}

double lateness(const LeftOverRows& rows, const std::vector<LeftOverTerm>& terms, const LeftOverTerm& term) {
  double measured_share = 1;
  for (const LeftOverTerm& other : terms)
    if (rows.candidates[other.candidate].kind == Regressor::simulated) measured_share += other.slope;
  return -term.slope / measured_share;
}

}  // namespace kenaf::gap::diagnose
