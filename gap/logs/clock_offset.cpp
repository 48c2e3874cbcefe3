#include "gap/logs/clock_offset.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gap/logs/offset_refinement.hpp"

namespace kenaf::gap::logs {
namespace {

// All chosen.
constexpr Eigen::Index kMostGridPoints = 8192;  // of either log; a longer one gets a coarser grid
constexpr double kFollows = 0.8;                // least r squared with any gain, for a wrong unit or sign to be named
constexpr double kAbsurd = 10;                  // factor beyond the gain's bounds that only a wrong unit explains
constexpr double kRefuted = 2;                  // an offset is refuted by this many times the residual variance
constexpr double kEnoughMotion = 0.2;           // least share in the overlap of all motion in the log with less of it
constexpr double kWidestPeak_s = 2;             // widest range of offsets that fit about as well as the best
constexpr double kLargestError_s = 0.25;        // largest standard error of the result
constexpr double kBodyIsGoodEnough_s = 0.01;    // standard error with which quantities that slip are not needed

using Eigen::ArrayXd;
using Eigen::Index;

// Rates on a grid. Where a rate is unknown, value and mask are 0.
struct Rates {
  ArrayXd value, known;
  double energy() const { return value.square().sum(); }
};

Rates rates_on(const Course& course, double first_s, double step_s, double window_s, Index count) {
  Rates rates{ArrayXd::Zero(count), ArrayXd::Zero(count)};
  for (Index i = 0; i < count; ++i) {
    const double rate = mean_rate(course, first_s + static_cast<double>(i) * step_s, window_s);
    if (std::isnan(rate)) continue;
    rates.value[i] = rate;
    rates.known[i] = 1;
  }
  return rates;
}

// A time grid of each log with a common step. A lag pairs robot point i with capture point i - lag.
struct Grid {
  double window_s, step_s, robot_first_s, capture_first_s;
  Index robot_count, capture_count;

  double offset_s(Index lag) const { return robot_first_s - capture_first_s + static_cast<double>(lag) * step_s; }
  Index first_lag() const { return 1 - capture_count; }
  Index lag_count() const { return robot_count + capture_count - 1; }
};

struct Span {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  void add(const Course& course) {
    first_s = std::min(first_s, course.t_s.front());
    last_s = std::max(last_s, course.t_s.back());
  }
  double length_s() const { return last_s - first_s; }
};

Grid grid_for(const std::vector<CourseSeenTwice>& courses) {
  Span robot, capture;
  double longest_step_s = 0;
  for (const CourseSeenTwice& course : courses) {
    robot.add(course.robot);
    capture.add(course.capture);
    for (const Course* side : {&course.robot, &course.capture})
      longest_step_s = std::max(longest_step_s, median_step(side->t_s, side->value));
  }
  Grid grid{};

  // The window is long enough for the slower log, and for a grid of at most kMostGridPoints.
  const double longest_s = std::max(robot.length_s(), capture.length_s());
  grid.window_s =
      std::max(comparing_window_s(longest_step_s), kStepsPerWindow * longest_s / static_cast<double>(kMostGridPoints));
  grid.step_s = grid.window_s / kStepsPerWindow;
  grid.robot_first_s = robot.first_s;
  grid.capture_first_s = capture.first_s;
  grid.robot_count = static_cast<Index>(robot.length_s() / grid.step_s) + 1;
  grid.capture_count = static_cast<Index>(capture.length_s() / grid.step_s) + 1;
  return grid;
}

// One quantity at one lag: the robot's rates a fitted by the captured rates b times a gain g. Minimizing
// S(g) = sum (a - g b)^2 gives g = sum(a b) / sum(b b), clamped to its bounds. With independent normal residuals the
// log-likelihood over that of no relation (g = 0) is -n/2 log(S / sum(a a)) = -n/2 log(1 - r^2).
struct Fit {
  double count = 0, robot_energy = 0, capture_energy = 0, gain = 0, squares = 0;

  double r_squared() const { return robot_energy > 0 ? std::max(0.0, 1 - squares / robot_energy) : 0; }
  double log_likelihood() const {
    return r_squared() > 0 ? -0.5 * count * std::log(std::max(1e-9, 1 - r_squared())) : 0;
  }
};

Fit fit_at(const Rates& robot, const Rates& capture, Index lag, double least_gain, double most_gain) {
  const Index i = std::max<Index>(0, lag), j = i - lag;
  const Index count = std::min(robot.value.size() - i, capture.value.size() - j);
  const auto a = robot.value.segment(i, count), a_known = robot.known.segment(i, count);
  const auto b = capture.value.segment(j, count), b_known = capture.known.segment(j, count);

  // The masks restrict all sums to points known in both logs; unknown rates are 0 in the products.
  Fit fit;
  fit.count = (a_known * b_known).sum();
  fit.robot_energy = (a.square() * b_known).sum();
  fit.capture_energy = (a_known * b.square()).sum();
  const double product = (a * b).sum();
  if (!(fit.capture_energy > 0)) return fit.squares = fit.robot_energy, fit;
  fit.gain = std::clamp(product / fit.capture_energy, least_gain, most_gain);
  fit.squares = fit.robot_energy - 2 * fit.gain * product + fit.gain * fit.gain * fit.capture_energy;
  return fit;
}

struct Quantity {
  const CourseSeenTwice* seen;
  Rates robot, capture;
  std::vector<Fit> fits;  // of each lag
};

struct Coarse {
  Index best = 0;  // index in fits
  double log_likelihood = 0;
};

// The lag of highest joint likelihood: log-likelihoods of the quantities add up. Fits of less than 1 s do not count.
Coarse search(std::vector<Quantity>& quantities, const Grid& grid, bool any_gain) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  Coarse coarse;
  ArrayXd sum = ArrayXd::Zero(grid.lag_count());
  for (Quantity& quantity : quantities) {
    quantity.fits.resize(static_cast<std::size_t>(grid.lag_count()));
    for (Index k = 0; k < grid.lag_count(); ++k) {
      Fit& fit = quantity.fits[static_cast<std::size_t>(k)];
      fit = fit_at(quantity.robot, quantity.capture, grid.first_lag() + k, any_gain ? -kAny : quantity.seen->least_gain,
                   any_gain ? kAny : quantity.seen->most_gain);
      if (fit.count * grid.step_s >= kShortestOverlap_s) sum[k] += fit.log_likelihood();
    }
  }
  coarse.log_likelihood = sum.maxCoeff(&coarse.best);
  return coarse;
}

const Fit& at(const Quantity& quantity, Index k) {
  return quantity.fits[static_cast<std::size_t>(k)];
}

bool tells_something(const Quantity& quantity, Index k) {
  return at(quantity, k).r_squared() >= kTellsSomething;
}

// Whether enough of the motion lies in the overlap, measured by the log that saw less of it.
bool moves_in_overlap(const Quantity& quantity, Index k) {
  const Fit& fit = at(quantity, k);
  const double all = std::min(quantity.robot.energy(), fit.gain * fit.gain * quantity.capture.energy());
  return fit.robot_energy >= kEnoughMotion * all;
}

std::string what_a_gain_means(const CourseSeenTwice& seen, double gain) {
  const auto near = [&](double value) { return std::abs(std::log(std::abs(gain) / value)) < 0.4; };
  std::string words = fmt::format("{} of the run is {:.3g} times that of the motion capture", seen.name, gain);
  if (gain < 0)
    words += ": one of the two has the wrong sign; x forward, y left, z up, so that a left turn is positive";
  else if (near(1e-3))
    words += ": the motion capture looks like millimetres; give --mocap-units mm";
  else if (near(1e-2))
    words += ": the motion capture looks like centimetres; its columns are in metres";
  else if (near(1e3))
    words +=
        ": the run looks like millimetres, and its columns are in metres; or `--mocap-units mm` was given for data "
        "in metres";
  else if (near(1 / 57.29578))
    words += ": the motion capture looks like degrees; name its columns roll_deg, pitch_deg, yaw_deg";
  else if (near(57.29578))
    words += ": the run looks like degrees; its columns are in radians";
  return words;
}

// Throws NoOffset, with the unit or sign that explains it if the logs agree with a gain outside its bounds.
[[noreturn]] void no_agreement(std::vector<Quantity>& quantities, const Grid& grid) {
  const Coarse any = search(quantities, grid, true);
  double best = 0;
  for (const Quantity& quantity : quantities) best = std::max(best, at(quantity, any.best).r_squared());
  std::string words = "run and motion capture do not agree at any offset";
  for (const Quantity& quantity : quantities) {
    const Fit& fit = at(quantity, any.best);
    const bool odd = fit.gain < quantity.seen->least_gain || fit.gain > quantity.seen->most_gain;
    if (odd && fit.r_squared() >= kFollows) throw NoOffset(words + ". " + what_a_gain_means(*quantity.seen, fit.gain));
  }
  throw NoOffset(
      fmt::format("{} (correlation at most {:.2f}): do both record the same drive?", words, std::sqrt(best)));
}

// Throws if the two rates of a quantity agree but for a sign, or a factor that only a wrong unit explains.
void check_units(const std::vector<Quantity>& quantities, const Grid& grid, Index best) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  for (const Quantity& quantity : quantities) {
    const CourseSeenTwice& seen = *quantity.seen;
    const Fit fit = fit_at(quantity.robot, quantity.capture, grid.first_lag() + best, -kAny, kAny);
    const bool absurd = fit.gain < 0 || fit.gain < seen.least_gain / kAbsurd || fit.gain > seen.most_gain * kAbsurd;
    if (absurd && fit.r_squared() >= kFollows) throw NoOffset(what_a_gain_means(seen, fit.gain));
  }
}

// Throws if another offset, or too wide a range of offsets, explains the rates about as well.
void check_unique(const std::vector<Quantity>& quantities, const Grid& grid, Index best) {
  // A lag is refuted by any telling quantity whose residual variance there is more than kRefuted times that at the best
  // lag (at least a millionth of its mean square, for perfect fits), and also if its overlap has no motion.
  const auto refuted = [&](Index k) {
    bool moves = false;
    for (const Quantity& quantity : quantities) {
      if (!tells_something(quantity, best)) continue;
      const Fit &here = at(quantity, k), &there = at(quantity, best);
      if (here.count * grid.step_s < kShortestOverlap_s) continue;
      const double floor = 1e-6 * quantity.robot.energy() / quantity.robot.known.sum();
      if (here.squares / here.count > kRefuted * std::max(there.squares / there.count, floor)) return true;
      moves = moves || moves_in_overlap(quantity, k);
    }
    return !moves;
  };

  // The interval of lags around the best one that are not refuted: how well the offset is determined.
  Index low = best, high = best;
  while (low > 0 && !refuted(low - 1)) --low;
  while (high + 1 < grid.lag_count() && !refuted(high + 1)) ++high;
  if (static_cast<double>(high - low) * grid.step_s > kWidestPeak_s)
    throw NoOffset(
        fmt::format("every offset from {:.2f} to {:.2f} s fits about as well: the robot hardly changes its "
                    "speed or direction where both logs overlap; start and stop within both of them",
                    grid.offset_s(grid.first_lag() + low), grid.offset_s(grid.first_lag() + high)));

  // Beyond that interval any lag left is a second solution; the one with the longest overlap is reported.
  Index rival = -1;
  for (Index k = 0; k < grid.lag_count(); ++k)
    if ((k < low || k > high) && !refuted(k) &&
        (rival < 0 || at(quantities[0], k).count > at(quantities[0], rival).count))
      rival = k;
  if (rival >= 0)
    throw NoOffset(
        fmt::format("offsets of {:.2f} s and of {:.2f} s fit about as well: the drive repeats itself; begin both logs "
                    "before the robot moves and end them after it, or remove the part that only one of them covers",
                    grid.offset_s(grid.first_lag() + best), grid.offset_s(grid.first_lag() + rival)));
}

bool moves(const Course& course, double enough) {
  const auto [least, most] = std::ranges::minmax(course.value);
  return most - least >= enough;
}

}  // namespace

ClockOffset estimate_clock_offset(const std::vector<CourseSeenTwice>& courses) {
  // Only quantities with samples on both sides; both sides must move.
  std::vector<CourseSeenTwice> usable;
  bool robot_moves = false, capture_moves = false;
  for (const CourseSeenTwice& course : courses) {
    if (course.robot.t_s.size() < 2 || course.capture.t_s.size() < 2) continue;
    usable.push_back(course);
    robot_moves = robot_moves || moves(course.robot, course.enough);
    capture_moves = capture_moves || moves(course.capture, course.enough);
  }
  if (usable.empty())
    throw NoOffset("the run measured no quantity that motion capture also measures: tracks, turn rate or posture");
  if (!robot_moves) throw NoOffset("the robot does not move in the run");
  if (!capture_moves) throw NoOffset("the robot does not move in the motion capture");

  // The coarse search: mean rates on a common grid, best lag over all quantities.
  const Grid grid = grid_for(usable);
  std::vector<Quantity> quantities;
  for (const CourseSeenTwice& seen : usable)
    quantities.push_back({&seen,
                          rates_on(seen.robot, grid.robot_first_s, grid.step_s, grid.window_s, grid.robot_count),
                          rates_on(seen.capture, grid.capture_first_s, grid.step_s, grid.window_s, grid.capture_count),
                          {}});
  const Coarse coarse = search(quantities, grid, false);

  // Refuses the best lag if no quantity agrees there, if the robot hardly moves in the overlap, if other lags fit about
  // as well, or if only a wrong unit or sign explains a gain.
  const auto tells = [&](const Quantity& quantity) { return tells_something(quantity, coarse.best); };
  if (coarse.log_likelihood <= 0 || std::ranges::none_of(quantities, tells)) no_agreement(quantities, grid);
  if (std::ranges::none_of(quantities, [&](const Quantity& q) { return tells(q) && moves_in_overlap(q, coarse.best); }))
    throw NoOffset(
        "run and motion capture overlap where the robot hardly moves: were both recording during the drive?");
  check_unique(quantities, grid, coarse.best);
  check_units(quantities, grid, coarse.best);

  // Each quantity refines the offset by itself.
  ClockOffset result;
  const double start_s = grid.offset_s(grid.first_lag() + coarse.best);
  for (const Quantity& quantity : quantities) {
    if (const auto refined = refine_offset(*quantity.seen, {grid.window_s, grid.step_s}, start_s))
      result.quantities.push_back(*refined);
    result.overlap_s = std::max(result.overlap_s, at(quantity, coarse.best).count * grid.step_s);
  }

  // Where the body's own turns determine the offset well, tracks do not count: belts lead the body.
  const auto slips = [&](const QuantityOffset& quantity) {
    return std::ranges::find(usable, quantity.name, &CourseSeenTwice::name)->slips;
  };
  const bool body_is_enough = std::ranges::any_of(result.quantities, [&](const QuantityOffset& quantity) {
    return !slips(quantity) && quantity.standard_error_s < kBodyIsGoodEnough_s;
  });

  // The inverse-variance mean: o = sum(o_i / s_i^2) / sum(1 / s_i^2), with variance 1 / sum(1 / s_i^2).
  double weights = 0, sum = 0;
  result.from_tracks = true;
  for (QuantityOffset& quantity : result.quantities) {
    quantity.used = !body_is_enough || !slips(quantity);
    if (!quantity.used) continue;
    const double weight = 1 / (quantity.standard_error_s * quantity.standard_error_s);
    weights += weight;
    sum += weight * quantity.offset_s;
    result.from_tracks = result.from_tracks && slips(quantity);
  }
  if (!(weights > 0))
    throw NoOffset(
        fmt::format("run and motion capture agree roughly at an offset of {:.2f} s, but no quantity fits well enough "
                    "there to determine it: do both record the same part of the drive?",
                    start_s));
  result.offset_s = sum / weights;

  // The Birge ratio sqrt(chi^2 / (n - 1)) widens the error where quantities disagree by more than their own errors.
  double chi_squared = 0, count = 0;
  for (const QuantityOffset& quantity : result.quantities) {
    if (!quantity.used) continue;
    chi_squared += std::pow((quantity.offset_s - result.offset_s) / quantity.standard_error_s, 2);
    ++count;
  }
  const double birge = count > 1 ? std::max(1.0, std::sqrt(chi_squared / (count - 1))) : 1;
  result.standard_error_s = birge / std::sqrt(weights);
  if (!(result.standard_error_s <= kLargestError_s))
    throw NoOffset(
        fmt::format("the offset has a standard error of {:.2f} s: the robot changes its speed or direction too little "
                    "where both logs overlap",
                    result.standard_error_s));
  return result;
}

}  // namespace kenaf::gap::logs
