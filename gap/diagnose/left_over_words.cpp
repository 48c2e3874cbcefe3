#include "gap/diagnose/left_over_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Two numbers are the same in words where they differ by less than a quarter of what is told, or a twentieth (chosen).
constexpr double kSameShare = 0.25, kSameRatio = 0.05;
constexpr double kOneSided = 1.0 / 3;                  // of one side's slope: less is none (chosen)
constexpr double kNearlyEvery = 0.9, kMost = 2.0 / 3;  // of the runs (chosen)
constexpr double kSpeedsDiffer = 1.5;  // between the tenths of rows at either end: else there is one speed (chosen)

bool turns(Quantity quantity) {
  return quantity == Quantity::yaw_rate || quantity == Quantity::gyro;
}

// A term with its rows, over which parts are compared.
struct TermRows {
  const LeftOverRows& rows;
  VectorXd x, y;
  const VectorXd& weights;
  double slope;

  std::size_t size() const { return rows.run.size(); }
  // Of the rows that matter and for which `holds`.
  template <class Holds>
  double slope_where(Holds&& holds) const {
    std::vector<bool> chosen(size());
    for (std::size_t i = 0; i < size(); ++i) chosen[i] = holds(static_cast<Index>(i));
    return slope_through_zero(x, y, weights, chosen);
  }
  // Share of the sum of squares of x.
  template <class Holds>
  double part_where(Holds&& holds) const {
    double part = 0;
    for (Index i = 0; i < x.size(); ++i)
      if (holds(i)) part += x[i] * x[i];
    return part / std::max(1e-300, x.squaredNorm());
  }
};

TermRows rows_of_term(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return {rows, rows.x.col(static_cast<Index>(term.candidate)), left_to(rows, fit, term), fit.weights, term.slope};
}

// The same with what the size of the simulated quantity was told to do: to each side it is a part of the measured
// share.
TermRows with_size(const LeftOverRows& rows, const LeftOverFit& fit, const TermRows& term) {
  TermRows result = term;
  for (const LeftOverTerm& other : fit.terms)
    if (rows.candidates[other.candidate].kind == Regressor::turn_size && turns(rows.quantity.quantity))
      result.y += other.slope * rows.x.col(static_cast<Index>(other.candidate));
  return result;
}

// Of the runs that show it, the share whose own slope has the term's sign.
double share_of_runs(const TermRows& term) {
  std::vector<double> square(term.rows.runs, 0), product(term.rows.runs, 0), shown;
  for (std::size_t i = 0; i < term.size(); ++i) {
    const auto row = static_cast<Index>(i);
    square[term.rows.run[i]] += term.x[row] * term.x[row];
    product[term.rows.run[i]] += term.x[row] * term.y[row];
  }
  for (const double value : square)
    if (value > 0) shown.push_back(value);
  const double enough = quantile_of(shown, 0.5) / 4;
  double same = 0, all = 0;
  for (std::size_t r = 0; r < square.size(); ++r) {
    if (square[r] < enough || square[r] <= 0) continue;
    ++all;
    if (product[r] * term.slope > 0) ++same;
  }
  return all > 1 ? same / all : 1;
}

std::string in_runs(const TermRows& term) {
  const std::string_view what = turns(term.rows.quantity.quantity) ? "turn" : "run";
  if (term.rows.runs < 2 && what == "run") return "";
  const double share = share_of_runs(term);
  if (share >= 1) return fmt::format(", in every {}", what);
  if (share >= kNearlyEvery) return fmt::format(", in nearly every {}", what);
  return share >= kMost ? fmt::format(", in most {}s", what)
                        : fmt::format(", in {:.0f} % of the {}s", 100 * share, what);
}

bool alike(double a, double b, double told) {
  return std::abs(a - b) <= std::max(kSameRatio, kSameShare * std::abs(told));
}

// To which side it turns.
std::string by_side(const TermRows& term) {
  const auto left = [&](Index i) { return term.x[i] > 0; };
  const auto right = [&](Index i) { return term.x[i] < 0; };
  if (std::min(term.part_where(left), term.part_where(right)) < 0.05) return "";  // chosen: hardly any to one side
  const double of_left = term.slope_where(left), of_right = term.slope_where(right);
  if (alike(of_left, of_right, term.slope)) return "";
  return turns(term.rows.quantity.quantity)
             ? fmt::format(", {:.2f} to the left and {:.2f} to the right", 1 + of_left, 1 + of_right)
             : fmt::format(", {:.2f} forward and {:.2f} backward", 1 + of_left, 1 + of_right);
}

std::string at_speeds(const TermRows& term) {
  const double rms = std::sqrt(term.x.squaredNorm() / static_cast<double>(term.x.size()));
  std::vector<double> speeds;
  const auto matters = [&](Index i) { return std::abs(term.x[i]) > rms / 2 && std::isfinite(term.rows.speed_mps[i]); };
  for (Index i = 0; i < term.x.size(); ++i)
    if (matters(i)) speeds.push_back(term.rows.speed_mps[i]);
  if (speeds.size() < 8) return "";  // chosen: halves of fewer have no slope
  if (quantile_of(speeds, 0.9) < kSpeedsDiffer * quantile_of(speeds, 0.1)) return "";
  const double middle = quantile_of(speeds, 0.5);
  const double slow = term.slope_where([&](Index i) { return matters(i) && term.rows.speed_mps[i] <= middle; });
  const double fast = term.slope_where([&](Index i) { return matters(i) && term.rows.speed_mps[i] > middle; });
  if (alike(slow, fast, term.slope)) return ", at all speeds";
  return fmt::format(", {:.2f} where the tracks run slower than {:.2g} m/s and {:.2f} where faster", 1 + slow, middle,
                     1 + fast);
}

// A change by which the simulated quantity grows or shrinks in size.
std::string while_changing(const TermRows& term) {
  const auto grows = [&](Index i) { return term.x[i] * term.rows.simulated[i] > 0; };
  const auto shrinks = [&](Index i) { return term.x[i] * term.rows.simulated[i] < 0; };
  if (std::min(term.part_where(grows), term.part_where(shrinks)) < 0.05) return "";
  const double up = term.slope_where(grows) / term.slope, down = term.slope_where(shrinks) / term.slope;
  if (down < kOneSided * up) return ", only while it grows";
  if (up < kOneSided * down) return ", only while it falls";
  return ", whenever it changes";
}

std::string more_or_less(double slope) {
  return slope > 0 ? "more" : "less";
}

std::string sentence(const TermRows& term, const LeftOverFit& fit, const LeftOverTerm& of) {
  const Candidate& on = term.rows.candidates[of.candidate];
  const std::string_view unit = term.rows.quantity.unit;
  const double late = lateness(term.rows, fit.terms, of), slope = term.slope;
  switch (on.kind) {
    case Regressor::simulated:
      return fmt::format("measured {:.2f} of the simulated{}{}{}", 1 + slope, in_runs(term),
                         by_side(with_size(term.rows, fit, term)), at_speeds(term));
    case Regressor::delay:
      return fmt::format("measured {:.2g} s {} the simulated{}", std::abs(late), late > 0 ? "late behind" : "ahead of",
                         while_changing(term));
    case Regressor::lag:
      return late > 0 ? fmt::format("measured about {:.2g} s late behind the simulated, as by a lag{}", late,
                                    while_changing(term))
                      : fmt::format("measured about {:.2g} s ahead of the simulated, as if it lagged less{}", -late,
                                    while_changing(term));
    case Regressor::ramp:
      return fmt::format("measured late behind the simulated, as by a limit of {:.2g} m/s2{}", on.parameter,
                         while_changing(term));
    case Regressor::constant:
      return fmt::format("measured {:.2g} {} {} than the simulated{}", std::abs(slope), unit, more_or_less(slope),
                         in_runs(term));
    case Regressor::direction:
      return fmt::format("measured {:.2g} {} {} in size than the simulated, whatever its size{}", std::abs(slope), unit,
                         more_or_less(slope), in_runs(term));
    case Regressor::acceleration:
      if (unit == "m/s" && slope < 0 && term.rows.quantity.quantity == Quantity::forward)
        return fmt::format(
            "measured less than the simulated by {0:.2g} m/s for each m/s2 of forward acceleration, as if {0:.2g} s "
            "late{1}",
            -slope, in_runs(term));
      [[fallthrough]];
    default:
      return fmt::format("measured {} than the simulated by {:.2g} {} for each {} of {}{}", more_or_less(slope),
                         std::abs(slope), unit, on.unit, on.name, in_runs(term));
  }
}

}  // namespace

VectorXd left_to(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return fit.rest + term.slope * rows.x.col(static_cast<Index>(term.candidate));
}

std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return fmt::format("{}: {} ({:.0f} % of what is left)", rows.quantity.name,
                     sentence(rows_of_term(rows, fit, term), fit, term), 100 * term.share);
}

std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const RunFactor& by_run) {
  double common = 0;
  for (const LeftOverTerm& term : fit.terms) common += term.share;
  const std::string_view most = by_run.share > common ? "most of it differs" : "differs";
  const std::string what =
      by_run.of_simulated
          ? fmt::format("{:.2f} to {:.2f} of the simulated was measured", by_run.low, by_run.high)
          : fmt::format("measured minus simulated is {:.2g} to {:.2g} {}", by_run.low, by_run.high, rows.quantity.unit);
  return fmt::format("{}: {} from run to run: {} in the middle 80 % ({:.0f} % of what is left)", rows.quantity.name,
                     most, what, 100 * by_run.share);
}

std::vector<std::string> look_at(Quantity quantity, Regressor on) {
  struct Entry {
    Regressor on;
    std::vector<std::string> look_at;
  };
  using R = Regressor;
  static const std::vector<Entry> kOfTracks{
      {R::simulated,
       {"command_gain", "encoder_scale", "drive.sprocket_radius_m", "drive.max_speed_mps", "drive_asymmetry"}},
      {R::delay, {"command_delay", "drive_lag", "command_slew"}},
      {R::lag, {"drive_lag", "drive.time_constant_s", "command_slew", "command_delay"}},
      {R::ramp, {"command_slew", "drive.max_force_n", "drive_torque_limit", "drive_lag"}},
      {R::constant, {"drive_asymmetry", "encoder_scale"}},
      {R::direction, {"drive_coulomb"}},
      {R::command, {"command_gain", "drive.max_speed_mps", "drive_viscous"}},
      {R::turn, {"drive_asymmetry", "friction_across"}},
      {R::turn_size, {"friction_across", "drive.max_force_n", "drive_torque_limit"}},
      {R::load, {"battery_sag", "battery.internal_resistance_ohm", "drive.max_force_n"}},
      {R::pitch, {"body.mass_kg", "mass", "drive.max_force_n"}},
      {R::time, {"battery_sag", "battery.capacity_s"}}};
  static const std::vector<Entry> kOfCurrent{
      {R::simulated, {"drive.amperes_per_newton", "friction_across", "mass", "body.mass_kg"}},
      {R::delay, {"drive_lag", "command_delay"}},
      {R::lag, {"drive_lag", "drive.time_constant_s"}},
      {R::constant, {"drive.idle_amperes"}},
      {R::direction, {"drive.idle_amperes", "drive_coulomb", "rolling_resistance"}},
      {R::speed, {"drive_viscous", "rolling_resistance"}},
      {R::turn, {"friction_across", "com_left", "ground_bank"}},
      {R::turn_size, {"friction_across", "track.friction_across", "track.contact_length_m"}},
      {R::acceleration, {"mass", "body.mass_kg", "drive.moving_mass_kg"}},
      {R::pitch, {"mass", "body.mass_kg"}},
      {R::time, {"drive_coulomb", "battery.capacity_s"}}};
  static const std::vector<Entry> kOfBattery{{R::constant, {"battery.open_circuit_v"}},
                                             {R::load, {"battery.internal_resistance_ohm", "battery_sag"}},
                                             {R::speed, {"battery_sag", "drive_viscous"}},
                                             {R::turn_size, {"battery_sag", "friction_across"}},
                                             {R::acceleration, {"battery_sag", "drive.amperes_per_newton"}},
                                             {R::time, {"battery.capacity_s", "battery.open_circuit_v"}}};
  static const std::vector<Entry> kOfForward{
      {R::simulated, {"drive.sprocket_radius_m", "encoder_scale", "slip_with_speed", "tracking_scale"}},
      {R::delay, {"tracking_delay", "command_delay", "drive_lag"}},
      {R::lag, {"drive_lag", "tracking_delay", "friction_along"}},
      {R::constant, {"ground_slope"}},
      {R::direction, {"rolling_resistance", "friction_along"}},
      {R::turn, {"com_left", "ground_bank"}},
      {R::turn_size, {"friction_along", "friction_across", "com_forward"}},
      {R::acceleration, {"tracking_delay", "friction_along"}},
      {R::load, {"friction_along", "rolling_resistance"}},
      {R::pitch, {"friction_along", "ground_slope"}}};
  static const std::vector<Entry> kOfSideways{
      {R::simulated, {"friction_across", "com_forward"}}, {R::constant, {"ground_bank"}},
      {R::direction, {"friction_across", "ground_bank"}}, {R::speed, {"posture_mount", "drive_asymmetry"}},
      {R::turn, {"com_forward", "friction_across"}},      {R::delay, {"tracking_delay"}},
      {R::lag, {"tracking_delay", "friction_across"}}};
  static const std::vector<Entry> kOfYawRate{
      {R::simulated, {"track.separation_m", "track.contact_length_m", "friction_across", "gyro_scale"}},
      {R::delay, {"tracking_delay", "command_delay", "drive_lag"}},
      {R::lag, {"drive_lag", "yaw_inertia", "friction_across", "tracking_delay"}},
      {R::constant, {"drive_asymmetry", "ground_bank"}},
      {R::direction, {"friction_across"}},
      {R::speed, {"drive_asymmetry", "com_left"}},
      {R::turn_size, {"drive_asymmetry", "com_left"}},
      {R::acceleration, {"com_left", "drive_asymmetry", "yaw_inertia"}},
      {R::load, {"drive_asymmetry", "com_left"}}};
  static const std::vector<Entry> kOfPitch{{R::simulated, {"posture_scale"}},
                                           {R::delay, {"posture_delay"}},
                                           {R::lag, {"posture_delay", "pitch_inertia"}},
                                           {R::constant, {"posture_bias", "com_forward", "ground_slope"}},
                                           {R::speed, {"com_forward", "ground_compliance"}},
                                           {R::acceleration, {"com_up", "com_forward", "ground_compliance"}},
                                           {R::place_x, {"ground_slope", "obstacle_position"}}};
  static const std::vector<Entry> kOfRoll{{R::simulated, {"posture_scale"}},
                                          {R::delay, {"posture_delay"}},
                                          {R::lag, {"posture_delay", "roll_inertia"}},
                                          {R::constant, {"ground_bank", "com_left"}},
                                          {R::pitch, {"posture_mount"}},
                                          {R::turn, {"com_up", "ground_compliance"}},
                                          {R::place_y, {"ground_bank"}}};
  static const std::vector<Entry> kOfHeight{
      {R::constant, {"obstacle_height", "ground_compliance", "track.end_radius_m"}},
      {R::pitch, {"obstacle_height", "obstacle_position"}},
      {R::place_x, {"ground_slope", "obstacle_position"}},
      {R::place_y, {"ground_bank"}},
      {R::speed, {"ground_compliance"}}};
  const auto found_in = [&](const std::vector<Entry>& table) -> std::vector<std::string> {
    const auto entry = std::ranges::find(table, on, &Entry::on);
    return entry == table.end() ? std::vector<std::string>{} : entry->look_at;
  };
  switch (quantity) {
    case Quantity::track_mean:
    case Quantity::track_difference:
    case Quantity::left_track:
    case Quantity::right_track:
      return found_in(kOfTracks);
    case Quantity::current:
      return found_in(kOfCurrent);
    case Quantity::battery:
      return found_in(kOfBattery);
    case Quantity::forward:
      return found_in(kOfForward);
    case Quantity::sideways:
      return found_in(kOfSideways);
    case Quantity::yaw_rate:
    case Quantity::gyro:
      return found_in(kOfYawRate);
    case Quantity::pitch:
      return found_in(kOfPitch);
    case Quantity::roll:
      return found_in(kOfRoll);
    case Quantity::height:
      return found_in(kOfHeight);
  }
  return {};
}

std::vector<std::string> look_at_for_runs(Quantity quantity) {
  switch (quantity) {
    case Quantity::battery:
      return {"battery.open_circuit_v"};
    case Quantity::current:
      return {"friction_across", "drive_coulomb"};
    case Quantity::yaw_rate:
    case Quantity::gyro:
      return {"friction_across", "ground_bank"};
    case Quantity::forward:
    case Quantity::sideways:
      return {"friction_along", "ground_slope", "ground_bank"};
    case Quantity::pitch:
    case Quantity::roll:
    case Quantity::height:
      return {"ground_slope", "ground_bank"};
    default:
      return {"drive_torque_limit", "battery.open_circuit_v"};
  }
}

}  // namespace kenaf::gap
