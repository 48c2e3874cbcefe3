#include "gap/diagnose/left_over_regressors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kStandsStill = 0.05;  // of the quantity's rms: smaller values have no sign (chosen)
constexpr double kNearlyAll = 0.9;     // of the rows: a regressor has to be known in these (chosen)

// Steps of sqrt(2): the free slope compensates for values in between (chosen).
std::vector<double> steps(double from, double to) {
  std::vector<double> values;
  for (double value = from; value < to * 1.01; value *= std::sqrt(2.0)) values.push_back(value);
  return values;
}

bool is_track(Quantity quantity) {
  return quantity == Quantity::track_mean || quantity == Quantity::track_difference ||
         quantity == Quantity::left_track || quantity == Quantity::right_track;
}
bool is_turning(Quantity quantity) {
  return quantity == Quantity::yaw_rate || quantity == Quantity::gyro;
}
// Quantities for which a fraction or a delay is meaningful.
bool is_motion(Quantity quantity) {
  return is_track(quantity) || is_turning(quantity) || quantity == Quantity::forward ||
         quantity == Quantity::sideways || quantity == Quantity::current;
}
bool is_angle(Quantity quantity) {
  return quantity == Quantity::pitch || quantity == Quantity::roll;
}

std::vector<LeftOverCandidate> regressors_for(const QuantityInfo& info) {
  const Quantity q = info.quantity;
  std::vector<LeftOverCandidate> all;
  const auto add = [&](Regressor kind, std::string_view name, std::string_view unit, double parameter = 0) {
    all.push_back({kind, parameter, name, unit});
  };
  // 0.05 to 1.6 s, and limits from very slow to imperceptible (chosen)
  if (is_motion(q) || is_angle(q)) {
    add(Regressor::simulated, "simulated", info.unit);
    for (const double delay_s : steps(0.05, 1.6)) add(Regressor::delay, "change of the simulated", "", delay_s);
    for (const double lag_s : steps(0.05, 3.2)) add(Regressor::lag, "lagged change of the simulated", "", lag_s);
  }
  if (is_track(q))
    for (const double limit : steps(0.25, 8))
      add(Regressor::ramp, "what a limit holds back of the simulated", info.unit, limit);
  add(Regressor::constant, "constant", "");
  if (is_motion(q)) add(Regressor::direction, "direction", "");
  if (is_track(q)) add(Regressor::command, "commanded speed", "m/s");
  if (!is_track(q) && q != Quantity::forward) add(Regressor::speed, "speed", "m/s");
  // a measured rate shares its noise with a quantity derived from the same channel
  if (!is_turning(q) && q != Quantity::track_difference) add(Regressor::turn, "turn rate", "rad/s");
  add(Regressor::turn_size, "size of the turn rate", "rad/s");
  if (!is_track(q)) add(Regressor::acceleration, "forward acceleration", "m/s2");
  if (q != Quantity::current) add(Regressor::load, "current", "A");
  if (q != Quantity::pitch) add(Regressor::pitch, "pitch", "rad");
  add(Regressor::time, "time since the start", "s");
  add(Regressor::place_x, "place along x", "m");
  add(Regressor::place_y, "place along y", "m");
  return all;
}

// A simulated quantity by span, with its value at the start of the run: half a span before the middle of the first one,
// in which a step at the start is nearly complete.
struct CourseOfBins {
  VectorXd values;
  double start, span_s;

  double before(Index i) const { return i == 0 ? start : values[i - 1]; }
  double apart_s(Index i) const { return i == 0 ? span_s / 2 : span_s; }
};

// Assumes a steady state before the run, like the functions below.
VectorXd delayed(const CourseOfBins& course, double delay_s) {
  VectorXd result(course.values.size());
  for (Index i = 0; i < result.size(); ++i) {
    const double at = static_cast<double>(i) - delay_s / course.span_s;
    const auto after = static_cast<Index>(std::ceil(std::max(at, 0.0)));
    const double to_go = (static_cast<double>(after) - at) * course.span_s / course.apart_s(after);
    const double last = course.before(after), next = course.values[after];
    result[i] = to_go >= 1 ? last : next + to_go * (last - next);
  }
  return result;
}

// First-order lag of a piecewise linear input of slope m: the distance d = input - output evolves as
// m lag + exp(-dt / lag) (d0 - m lag).
VectorXd lagged(const CourseOfBins& course, double lag_s) {
  VectorXd result(course.values.size());
  double behind = 0;  // input minus output
  for (Index i = 0; i < result.size(); ++i) {
    const double apart_s = course.apart_s(i), decay = std::exp(-apart_s / lag_s);
    const double slope = (course.values[i] - course.before(i)) / apart_s;
    // a linear input is followed at a distance of slope * lag
    behind = slope * lag_s + decay * (behind - slope * lag_s);
    result[i] = course.values[i] - behind;
  }
  return result;
}

VectorXd limited(const CourseOfBins& course, double limit) {
  VectorXd result(course.values.size());
  double now = course.start;
  for (Index i = 0; i < result.size(); ++i) {
    const double most = limit * course.apart_s(i);
    now += std::clamp(course.values[i] - now, -most, most);
    result[i] = now;
  }
  return result;
}

// Measurements of one run, by span; empty if not measured.
struct Measured {
  VectorXd left_mps, right_mps, speed_mps, turn_radps, load_a, pitch_rad, x_m, y_m, command_left, command_right;
};

VectorXd mean_of(const VectorXd& a, const VectorXd& b) {
  return a.size() > 0 && b.size() > 0 ? VectorXd((a + b) / 2) : VectorXd();
}

Measured measured_in(const LeftOverRun& run) {
  Measured m;
  m.left_mps = column_by_span(run, "track_left_mps");
  m.right_mps = column_by_span(run, "track_right_mps");
  m.speed_mps = mean_of(m.left_mps, m.right_mps);
  m.turn_radps = column_by_span(run, "gyro_z_radps");
  if (m.turn_radps.size() == 0) m.turn_radps = series_of(run, Quantity::yaw_rate).measured;
  m.load_a = mean_of(column_by_span(run, "track_left_a"), column_by_span(run, "track_right_a"));
  m.pitch_rad = column_by_span(run, "pitch_rad");
  m.x_m = column_by_span(run, "x_m");
  m.y_m = column_by_span(run, "y_m");
  m.command_left = column_by_span(run, "cmd_track_left_mps");
  m.command_right = column_by_span(run, "cmd_track_right_mps");
  return m;
}

VectorXd command_of(const Measured& m, Quantity quantity) {
  if (quantity == Quantity::left_track) return m.command_left;
  if (quantity == Quantity::right_track) return m.command_right;
  if (quantity != Quantity::track_difference) return mean_of(m.command_left, m.command_right);
  return m.command_left.size() > 0 && m.command_right.size() > 0 ? VectorXd(m.command_right - m.command_left)
                                                                 : VectorXd();
}

// The measured initial value of the quantity, where the simulation also started; NaN if not measured.
double at_start(const LeftOverRun& run, Quantity quantity) {
  const auto first = [&](std::string_view column) {
    const auto values = run.observation->run.column(column);
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values.front();
  };
  const double left = first("track_left_mps"), right = first("track_right_mps");
  switch (quantity) {
    case Quantity::left_track:
      return left;
    case Quantity::right_track:
      return right;
    case Quantity::track_difference:
      return right - left;
    case Quantity::track_mean:
    case Quantity::forward:
      return (left + right) / 2;
    case Quantity::gyro:
    case Quantity::yaw_rate:
      return first("gyro_z_radps");
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

// A regressor's column for one run; empty if it was not measured there.
VectorXd regressor_of(const LeftOverCandidate& candidate, const LeftOverRun& run, const Measured& m,
                      const QuantityInfo& info, const CourseOfBins& course) {
  const VectorXd& simulated = course.values;
  const double span_s = run.features->span_s();
  // delay and lag are per second of their parameter, so that a slope is minus the lateness
  switch (candidate.kind) {
    case Regressor::simulated:
    case Regressor::direction:  // rows_of() makes it one once it knows all runs
      return simulated;
    case Regressor::delay:
      return (simulated - delayed(course, candidate.parameter)) / candidate.parameter;
    case Regressor::lag:
      return (simulated - lagged(course, candidate.parameter)) / candidate.parameter;
    case Regressor::ramp:
      return simulated - limited(course, candidate.parameter);
    case Regressor::constant:
      return VectorXd::Ones(simulated.size());
    case Regressor::command:
      return command_of(m, info.quantity);
    case Regressor::speed:
      return m.speed_mps;
    case Regressor::turn:
      return m.turn_radps;
    case Regressor::turn_size:
      return is_turning(info.quantity) ? VectorXd(simulated.cwiseAbs()) : VectorXd(m.turn_radps.cwiseAbs());
    case Regressor::acceleration:
      return rate_of(m.speed_mps, span_s);
    case Regressor::load:
      return m.load_a;
    case Regressor::pitch:
      return m.pitch_rad;
    case Regressor::time:
      return (VectorXd::LinSpaced(simulated.size(), 0.5, static_cast<double>(simulated.size()) - 0.5)) * span_s;
    case Regressor::place_x:
      return m.x_m;
    case Regressor::place_y:
      return m.y_m;
  }
  return {};
}

bool is_about_mean(Regressor kind) {
  return kind == Regressor::time || kind == Regressor::place_x || kind == Regressor::place_y;
}

// Drops regressors that are rarely known or constant; unknown values of the others have no influence.
void keep_useful(LeftOverRows& rows) {
  std::vector<LeftOverCandidate> kept;
  Index next = 0;
  const double rms = std::sqrt(rows.simulated.squaredNorm() / static_cast<double>(rows.simulated.size()));
  for (std::size_t c = 0; c < rows.candidates.size(); ++c) {
    VectorXd column = rows.x.col(static_cast<Index>(c));
    const Regressor kind = rows.candidates[c].kind;
    const auto known = (column.array() == column.array());  // not NaN
    const auto count = static_cast<double>(known.count());
    if (count < kNearlyAll * static_cast<double>(column.size())) continue;
    if (kind == Regressor::direction)
      column = (column.array().abs() > kStandsStill * rms).select(column.array().sign(), 0.0);
    const double mean = known.select(column, 0.0).sum() / count;
    const double spread = std::sqrt(known.select(column.array() - mean, 0.0).square().sum() / count);
    if (kind != Regressor::constant && !(spread > 1e-9 * std::max(1.0, std::abs(mean)))) continue;
    // places and times are centred: their 0 has no meaning
    const VectorXd from_zero = is_about_mean(kind) ? VectorXd(column.array() - mean) : column;
    rows.x.col(next++) = known.select(from_zero, 0.0);
    kept.push_back(rows.candidates[c]);
  }
  rows.candidates = std::move(kept);
  rows.x.conservativeResize(Eigen::NoChange, next);
}

}  // namespace

bool is_late(Regressor kind) {
  return kind == Regressor::delay || kind == Regressor::lag || kind == Regressor::ramp;
}

LeftOverRows rows_of(std::span<const LeftOverRun> runs, const QuantityInfo& quantity) {
  LeftOverRows rows{.quantity = quantity,
                    .candidates = regressors_for(quantity),
                    .x = {},
                    .error = {},
                    .sigma = {},
                    .simulated = {},
                    .speed_mps = {},
                    .time_s = {},
                    .run = {},
                    .runs = runs.size()};
  std::vector<double> error, sigma, simulated, speed, time;
  std::vector<VectorXd> regressors;  // one for each row
  for (std::size_t r = 0; r < runs.size(); ++r) {
    // the regressors of the whole run, as late ones need its course
    const QuantitySeries series = series_of(runs[r], quantity.quantity);
    if (series.measured.size() == 0) continue;
    const Measured measured = measured_in(runs[r]);
    CourseOfBins course{filled(series.simulated), at_start(runs[r], quantity.quantity), runs[r].features->span_s()};
    if (std::isnan(course.start)) course.start = course.values[0];
    std::vector<VectorXd> columns;
    for (const LeftOverCandidate& candidate : rows.candidates)
      columns.push_back(regressor_of(candidate, runs[r], measured, quantity, course));

    // one row per span in which the quantity and its noise are known
    const bool has_speed = measured.speed_mps.size() > 0;
    for (Index i = 0; i < series.measured.size(); ++i) {
      const double left = series.measured[i] - series.simulated[i];
      if (!std::isfinite(left) || !std::isfinite(series.sigma[i])) continue;
      error.push_back(left);
      sigma.push_back(series.sigma[i]);
      simulated.push_back(series.simulated[i]);
      speed.push_back(has_speed ? (std::abs(measured.left_mps[i]) + std::abs(measured.right_mps[i])) / 2
                                : std::numeric_limits<double>::quiet_NaN());
      time.push_back((static_cast<double>(i) + 0.5) * runs[r].features->span_s());
      rows.run.push_back(r);
      VectorXd row(static_cast<Index>(columns.size()));
      for (std::size_t c = 0; c < columns.size(); ++c)
        row[static_cast<Index>(c)] = columns[c].size() > 0 ? columns[c][i] : std::numeric_limits<double>::quiet_NaN();
      regressors.push_back(std::move(row));
    }
  }

  // as vectors and one matrix, with useful regressors only
  const auto vector_of = [](const std::vector<double>& values) {
    return VectorXd(Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size())));
  };
  rows.error = vector_of(error);
  rows.sigma = vector_of(sigma);
  rows.simulated = vector_of(simulated);
  rows.speed_mps = vector_of(speed);
  rows.time_s = vector_of(time);
  rows.x.resize(rows.error.size(), static_cast<Index>(rows.candidates.size()));
  for (std::size_t i = 0; i < regressors.size(); ++i) rows.x.row(static_cast<Index>(i)) = regressors[i];
  if (rows.error.size() > 0) keep_useful(rows);
  return rows;
}

}  // namespace kenaf::gap::diagnose
