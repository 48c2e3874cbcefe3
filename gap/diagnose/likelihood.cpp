#include "gap/diagnose/likelihood.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/golden_section.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Sizes are estimated alternately until the relative change is below this (chosen: the precision of each).
constexpr double kSameSize = 0.03;
constexpr int kMostTurns = 20;
// Shapes shorter than this, in standard deviations, are negligible.
constexpr double kNoShape = 1e-3;
// Relative errors of a description's numbers: from invisible to those of a measured and weighed robot (chosen). Golden
// section over the logarithm, to 3 %.
constexpr double kLeastOff = 1e-4, kMostOff = 0.025;
constexpr int kSectionsOfOff = 11;
constexpr int kSizesOfOff = 48;  // of a posterior, equally spaced in the logarithm: 12 % apart
// Limit of the length of the vector of all errors: twelve errors of kMostOff exceed it once in a thousand times.
constexpr double kFarthestOff = 0.143;
// A usual error, in sigma (chosen).
constexpr double kUsual_sigma = 1;
constexpr double kNoneOff = 1e-8;
constexpr int kHalvingsOfOff = 20;

std::vector<VectorXd> whitened(const std::vector<GroupWhitener>& whiteners, const GroupVectors& residual) {
  std::vector<VectorXd> white;
  for (std::size_t g = 0; g < whiteners.size(); ++g) white.emplace_back(whiteners[g](residual[g]));
  return white;
}

// Inner products of shared shapes with each other and with a residual, over all groups.
struct SharedProducts {
  MatrixXd shapes;    // N' A^-1 N
  VectorXd residual;  // N' A^-1 r
};

SharedProducts shared_products(const std::vector<GroupWhitener>& whiteners, const std::vector<VectorXd>& white) {
  const Index count = whiteners.empty() ? 0 : whiteners.front().shared().cols();
  SharedProducts products{MatrixXd::Zero(count, count), VectorXd::Zero(count)};
  for (std::size_t g = 0; g < whiteners.size(); ++g) {
    const MatrixXd& shapes = whiteners[g].shared();
    products.shapes.noalias() += shapes.transpose() * shapes;
    products.residual.noalias() += shapes.transpose() * white[g];
  }
  return products;
}

// Scales the last `numbers` shapes by `part`.
SharedProducts with_numbers_off(SharedProducts products, Index numbers, double part) {
  VectorXd scale = VectorXd::Ones(products.residual.size());
  scale.tail(numbers).setConstant(part);
  products.shapes = scale.asDiagonal() * products.shapes * scale.asDiagonal();
  products.residual.array() *= scale.array();
  return products;
}

// Amounts of shared shapes, with the prior N(0, 1).
struct Amounts {
  VectorXd most_likely;
  // With all amounts integrated out, minus the values without shared shapes.
  double log_determinant = 0, chi_squared = 0;
  double deviance() const { return log_determinant + chi_squared; }
};

Amounts amounts_of(const SharedProducts& products) {
  if (products.residual.size() == 0) return {};
  MatrixXd normal = products.shapes;
  normal.diagonal().array() += 1;
  const Eigen::LLT<MatrixXd> factor(normal);
  Amounts amounts{factor.solve(products.residual), 2 * factor.matrixLLT().diagonal().array().log().sum(), 0};
  amounts.chi_squared = -products.residual.dot(amounts.most_likely);
  return amounts;
}

// Shared shapes of one group, each at 1 sigma.
MatrixXd shared_shapes(const StageGroup& group, double numbers_off) {
  if (numbers_off == 0) return group.shared_shapes;
  MatrixXd shapes(group.shared_shapes.rows(), group.shared_shapes.cols() + group.number_shapes.cols());
  shapes << group.shared_shapes, numbers_off * group.number_shapes;
  return shapes;
}

bool is_about(double a, double b) {
  return std::abs(a - b) <= kSameSize * std::max(a, b);
}
bool has_settled(const Discrepancies& before, const Discrepancies& now) {
  for (std::size_t k = 0; k < now.of_kind.size(); ++k)
    if (!is_about(before.of_kind[k].sigma, now.of_kind[k].sigma)) return false;
  return is_about(before.numbers_off, now.numbers_off);
}

// Most likely relative error of the description's numbers; `whole`: products for relative errors of 1.
double most_likely_numbers_off(const SharedProducts& whole, Index numbers) {
  if (numbers == 0) return 0;
  const auto deviance = [&](double off) { return amounts_of(with_numbers_off(whole, numbers, off)).deviance(); };
  const auto [log_off, least] = golden_section(std::log(kLeastOff), std::log(kMostOff), kSectionsOfOff,
                                               [&](double at) { return deviance(std::exp(at)); });
  return least < deviance(0) ? std::exp(log_off) : 0;
}

// Whether the length of all numbers' errors is within kFarthestOff: an error of a half is no member of a population of
// small errors.
bool is_within_reach(double off, const Amounts& amounts, Index numbers) {
  return off * amounts.most_likely.tail(numbers).norm() <= kFarthestOff;
}

// Reduces `off` until that holds.
double within_reach(const SharedProducts& whole, Index numbers, double off) {
  const auto reaches = [&](double at) {
    return is_within_reach(at, amounts_of(with_numbers_off(whole, numbers, at)), numbers);
  };
  if (off == 0 || reaches(off)) return off;
  double within = std::log(kNoneOff), beyond = std::log(off);
  for (int i = 0; i < kHalvingsOfOff; ++i) {
    const double middle = (within + beyond) / 2;
    (reaches(std::exp(middle)) ? within : beyond) = middle;
  }
  return std::exp(within);
}

// Amounts of all shared shapes, in their sigmas.
VectorXd most_likely_amounts(const std::vector<GroupWhitener>& whiteners, const GroupVectors& residual) {
  return amounts_of(shared_products(whiteners, whitened(whiteners, residual))).most_likely;
}

GroupVectors without_shared_shapes(const StageData& data, const std::vector<GroupWhitener>& whiteners,
                                   const GroupVectors& residual, double numbers_off) {
  const VectorXd amounts = most_likely_amounts(whiteners, residual);
  GroupVectors rest = residual;
  for (std::size_t g = 0; g < data.groups.size(); ++g) rest[g] -= shared_shapes(data.groups[g], numbers_off) * amounts;
  return rest;
}

// Subtracts local shapes at their most likely amounts from a residual; noise and discrepancy remain.
VectorXd without_local_shapes(const StageGroup& group, const GroupWhitener& whitener, VectorXd residual) {
  residual -= group.local_shapes * whitener.local_amounts(residual);
  return residual;
}

std::vector<Discrepancy> estimated(const StageData& data, const GroupVectors& rest) {
  std::vector<Discrepancy> result(kind_count());
  for (std::size_t kind = 0; kind < result.size(); ++kind) {
    std::vector<SeriesOfKind> all;
    for (std::size_t g = 0; g < data.groups.size(); ++g) {
      const StageGroup& group = data.groups[g];
      for (const Series& series : group.series) {
        if (series.kind != kind) continue;
        const auto first = group.t_s.begin() + series.first;
        all.push_back({{first, first + series.count},
                       group.variance.segment(series.first, series.count),
                       rest[g].segment(series.first, series.count)});
      }
    }
    if (!all.empty()) result[kind] = most_likely_discrepancy(all);
  }
  return result;
}

}  // namespace

Discrepancies no_discrepancy() {
  return {std::vector<Discrepancy>(kind_count()), 0};
}

GroupWhitener::GroupWhitener(const StageGroup& group, const Discrepancies& discrepancies) {
  const Index count = group.local_shapes.cols();
  squares_ = MatrixXd::Zero(count, count);
  for (const Series& series : group.series) {
    Part part{series.first,
              series.count,
              SeriesWhitener({group.t_s.data() + series.first, static_cast<std::size_t>(series.count)},
                             group.variance.segment(series.first, series.count), discrepancies.of_kind[series.kind]),
              {},
              {}};
    log_determinant_ += part.whitener.log_determinant();
    const auto shapes = group.local_shapes.middleRows(series.first, series.count);
    for (Index column = 0; column < count; ++column)
      if ((shapes.col(column).array() != 0).any()) part.local.push_back(column);
    part.shapes = shapes(Eigen::all, part.local);
    part.whitener.whiten(part.shapes);
    squares_(part.local, part.local) += part.shapes.transpose() * part.shapes;
    parts_.push_back(std::move(part));
  }

  // Covariance in whitened units: 1 + S S'. With S'S = V s^2 V', its inverse root is 1 - S V t V' S', where
  // t = (1 - (1 + s^2)^(-1/2)) / s^2.
  if (count > 0) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(squares_);
    const Eigen::ArrayXd squares = (eigen.eigenvalues().array() < kNoShape * kNoShape).select(0, eigen.eigenvalues());
    const Eigen::ArrayXd shrink = (squares > 0).select((1 - (1 + squares).rsqrt()) / squares, 0);
    shrink_ = eigen.eigenvectors() * shrink.matrix().asDiagonal() * eigen.eigenvectors().transpose();
    log_determinant_ += (1 + squares).log().sum();
  }
  shared_ = (*this)(shared_shapes(group, discrepancies.numbers_off));
}

void GroupWhitener::whiten_series(MatrixXd& columns) const {
  for (const Part& part : parts_) part.whitener.whiten(columns.middleRows(part.first, part.count));
}

MatrixXd GroupWhitener::local_products(const MatrixXd& white) const {
  MatrixXd products = MatrixXd::Zero(squares_.cols(), white.cols());
  for (const Part& part : parts_)
    products(part.local, Eigen::all) += part.shapes.transpose() * white.middleRows(part.first, part.count);
  return products;
}

MatrixXd GroupWhitener::operator()(MatrixXd columns) const {
  whiten_series(columns);
  const MatrixXd along = shrink_ * local_products(columns);
  for (const Part& part : parts_)
    columns.middleRows(part.first, part.count) -= part.shapes * along(part.local, Eigen::all);
  return columns;
}

VectorXd GroupWhitener::local_amounts(const VectorXd& residual) const {
  if (squares_.cols() == 0) return {};
  MatrixXd white = residual;
  whiten_series(white);
  MatrixXd normal = squares_;
  normal.diagonal().array() += 1;
  return normal.llt().solve(local_products(white));
}

std::vector<GroupWhitener> whiteners_of(const StageData& data, const Discrepancies& discrepancies) {
  std::vector<GroupWhitener> whiteners;
  for (const StageGroup& group : data.groups) whiteners.emplace_back(group, discrepancies);
  return whiteners;
}

MatrixXd inner_products(const std::vector<GroupWhitener>& whiteners, const std::vector<MatrixXd>& columns,
                        std::span<const double> weights) {
  const Index count = columns.front().cols(), shared = whiteners.front().shared().cols();
  MatrixXd sum = MatrixXd::Zero(count + shared, count + shared);
  for (std::size_t g = 0; g < whiteners.size(); ++g) {
    const double weight = weights.empty() ? 1 : weights[g];
    if (weight == 0) continue;
    MatrixXd all(columns[g].rows(), count + shared);
    all << whiteners[g](columns[g]), whiteners[g].shared();
    sum.noalias() += weight * (all.transpose() * all);
  }

  // amounts of shared shapes, N(0, 1), integrated out: x'A^-1 y - x'A^-1 N (1 + N'A^-1 N)^-1 N'A^-1 y (Woodbury)
  MatrixXd normal = sum.bottomRightCorner(shared, shared);
  normal.diagonal().array() += 1;
  return sum.topLeftCorner(count, count) -
         sum.topRightCorner(count, shared) * normal.llt().solve(sum.bottomLeftCorner(shared, count));
}

Likelihood likelihood_with(const StageData& data, const GroupVectors& residual, const Discrepancies& discrepancies) {
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
  const std::vector<VectorXd> white = whitened(whiteners, residual);
  const Amounts amounts = amounts_of(shared_products(whiteners, white));
  Likelihood result{amounts.log_determinant, amounts.chi_squared, discrepancies};
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    result.chi_squared += white[g].squaredNorm();
    result.deviance += whiteners[g].log_determinant();
  }
  result.deviance += result.chi_squared;
  return result;
}

GroupVectors less(GroupVectors a, const GroupVectors& b) {
  for (std::size_t g = 0; g < a.size(); ++g) a[g] -= b[g];
  return a;
}

Likelihood likelihood_of(const StageData& data, const GroupVectors& residual, const Discrepancies& start) {
  const Index numbers = data.groups.empty() ? 0 : data.groups.front().number_shapes.cols();
  Discrepancies discrepancies = start;
  for (int round = 0; round < kMostTurns; ++round) {
    const Discrepancies before = discrepancies;
    // first the numbers' errors, which are the same in all groups
    discrepancies.numbers_off = 1;
    const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
    const SharedProducts whole = shared_products(whiteners, whitened(whiteners, residual));
    discrepancies.numbers_off = within_reach(whole, numbers, most_likely_numbers_off(whole, numbers));

    // then open shapes at their most likely amounts, and the most likely discrepancies of the rest
    VectorXd amounts = amounts_of(with_numbers_off(whole, numbers, discrepancies.numbers_off)).most_likely;
    amounts.tail(numbers) *= discrepancies.numbers_off;
    GroupVectors rest;
    for (std::size_t g = 0; g < data.groups.size(); ++g)
      rest.push_back(
          without_local_shapes(data.groups[g], whiteners[g], residual[g] - shared_shapes(data.groups[g], 1) * amounts));
    discrepancies.of_kind = estimated(data, rest);
    if (has_settled(before, discrepancies)) break;
  }
  return likelihood_with(data, residual, discrepancies);
}

std::vector<VectorXd> whitened_rest(const StageData& data, const GroupVectors& residual,
                                    const Discrepancies& discrepancies) {
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
  std::vector<VectorXd> white = whitened(whiteners, residual);
  const VectorXd amounts = amounts_of(shared_products(whiteners, white)).most_likely;
  for (std::size_t g = 0; g < data.groups.size(); ++g) white[g] -= whiteners[g].shared() * amounts;
  return white;
}

GroupVectors without_shared_shapes(const StageData& data, const GroupVectors& residual,
                                   const Discrepancies& discrepancies) {
  return without_shared_shapes(data, whiteners_of(data, discrepancies), residual, discrepancies.numbers_off);
}

GroupVectors without_open_shapes(const StageData& data, const GroupVectors& residual,
                                 const Discrepancies& discrepancies) {
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
  GroupVectors rest = without_shared_shapes(data, whiteners, residual, discrepancies.numbers_off);
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    rest[g] = without_local_shapes(data.groups[g], whiteners[g], std::move(rest[g]));
  return rest;
}

VectorXd most_likely_numbers(const StageData& data, const GroupVectors& residual, const Discrepancies& discrepancies) {
  const Index numbers = data.groups.front().number_shapes.cols();
  if (discrepancies.numbers_off == 0) return VectorXd::Zero(numbers);
  const VectorXd sigmas = most_likely_amounts(whiteners_of(data, discrepancies), residual).tail(numbers);
  return discrepancies.numbers_off * sigmas.cwiseMax(-kUsual_sigma).cwiseMin(kUsual_sigma);
}

double numbers_off_of_intervals(const StageData& data, const GroupVectors& residual, const Discrepancies& most_likely) {
  if (most_likely.numbers_off == 0) return 0;
  const Index numbers = data.groups.front().number_shapes.cols();
  Discrepancies whole_errors = most_likely;
  whole_errors.numbers_off = 1;
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, whole_errors);
  const SharedProducts whole = shared_products(whiteners, whitened(whiteners, residual));

  // sizes are equally spaced in the logarithm, so a uniform prior gives each a weight like its size
  const double least = amounts_of(with_numbers_off(whole, numbers, most_likely.numbers_off)).deviance();
  double weights = 0, squares = 0;
  for (int i = 0; i <= kSizesOfOff; ++i) {
    const double off = kLeastOff * std::pow(kMostOff / kLeastOff, static_cast<double>(i) / kSizesOfOff);
    const Amounts amounts = amounts_of(with_numbers_off(whole, numbers, off));
    if (!is_within_reach(off, amounts, numbers)) break;
    const double weight = off * std::exp((least - amounts.deviance()) / 2);
    weights += weight, squares += weight * off * off;
  }
  return weights > 0 ? std::max(most_likely.numbers_off, std::sqrt(squares / weights)) : most_likely.numbers_off;
}

std::vector<double> deviance_of_groups(const StageData& data, const GroupVectors& residual,
                                       const Discrepancies& discrepancies) {
  const std::vector<VectorXd> white = whitened_rest(data, residual, discrepancies);
  std::vector<double> result;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    result.push_back(white[g].squaredNorm() + GroupWhitener(data.groups[g], discrepancies).log_determinant());
  return result;
}

}  // namespace kenaf::gap::diagnose
