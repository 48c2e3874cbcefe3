#include "gap/logs/wrapped_travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/logs/course.hpp"
#include "gap/logs/median.hpp"
#include "gap/logs/run_checks.hpp"

namespace kenaf::gap::logs {
namespace {

constexpr double kLeastModulus_m = 0.05, kTimesStep = 5, kTimesUsual = 10, kSameModulus = 0.05;

struct TravelStep {
  std::size_t row;  // of its later sample
  double excess_m;  // over what the speed, or the steps beside it, make of it
  double expected_m;
};

std::vector<TravelStep> steps_of(std::span<const double> t_s, std::span<const double> travel,
                                 std::span<const double> speed) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < travel.size(); ++i)
    if (!std::isnan(travel[i])) rows.push_back(i);
  const double gap_s = longest_gap_s(median_step(t_s, travel));
  const Course integral = course_of_rate(t_s, speed, longest_gap_s(median_step(t_s, speed)));
  const auto rate_of = [&](std::size_t k) {  // of the step to sample k
    return (travel[rows[k]] - travel[rows[k - 1]]) / (t_s[rows[k]] - t_s[rows[k - 1]]);
  };

  std::vector<TravelStep> steps;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double dt_s = t_s[rows[k]] - t_s[rows[k - 1]], step_m = travel[rows[k]] - travel[rows[k - 1]];
    if (dt_s > gap_s) continue;
    double expected_m = value_at(integral, t_s[rows[k]]) - value_at(integral, t_s[rows[k - 1]]);
    if (integral.t_s.empty() && k > 1 && k + 1 < rows.size())
      expected_m = 0.5 * dt_s * (rate_of(k - 1) + rate_of(k + 1));
    if (std::isfinite(step_m - expected_m)) steps.push_back({rows[k], step_m - expected_m, expected_m});
  }
  return steps;
}

}  // namespace

std::optional<WrappedTravel> wrapped_travel(std::span<const double> t_s, std::span<const double> travel,
                                            std::span<const double> speed) {
  const std::vector<TravelStep> steps =
      steps_of(t_s, travel, runs::any_measured(speed) ? speed : std::span<const double>{});
  if (steps.empty()) return std::nullopt;
  std::vector<double> sizes;
  for (const TravelStep& step : steps) sizes.push_back(std::abs(step.excess_m));
  const double usual_m = upper_median(sizes);

  WrappedTravel wrapped{0, {}, {}};
  std::vector<double> jumps;
  for (const TravelStep& step : steps) {
    const double least_m = std::max({kLeastModulus_m, kTimesStep * std::abs(step.expected_m), kTimesUsual * usual_m});
    if (std::abs(step.excess_m) < least_m) continue;
    wrapped.rows.push_back(step.row);
    wrapped.sign.push_back(step.excess_m > 0 ? 1 : -1);
    jumps.push_back(std::abs(step.excess_m));
  }
  if (jumps.empty()) return std::nullopt;
  wrapped.modulus_m = upper_median(jumps);
  for (const double jump : jumps)
    if (std::abs(jump / wrapped.modulus_m - 1) > kSameModulus) return std::nullopt;
  return wrapped;
}

std::vector<std::string> unwrap_travel(runs::Run& run) {
  std::vector<std::string> done;
  for (const std::string side : kSides) {
    const std::string name = "track_" + side + "_m";
    const auto wrapped = wrapped_travel(run.column("t_s"), run.column(name), run.column("track_" + side + "_mps"));
    if (!wrapped) continue;
    std::vector<double>& travel =
        run.values[static_cast<std::size_t>(std::ranges::find(run.columns, name) - run.columns.begin())];
    double added_m = 0;
    std::size_t next = 0;
    for (std::size_t row = 0; row < travel.size(); ++row) {
      if (next < wrapped->rows.size() && wrapped->rows[next] == row)
        added_m -= wrapped->sign[next++] * wrapped->modulus_m;
      travel[row] += added_m;
    }
    done.push_back(fmt::format("{}: unwrapped {} times by {:.4g} m", name, wrapped->rows.size(), wrapped->modulus_m));
  }
  return done;
}

void RunChecks::check_wraps() {
  for (const std::string side : kSides) {
    const std::string name = "track_" + side + "_m";
    const auto travel = column(name);
    const auto wrapped = wrapped_travel(column("t_s"), travel, column("track_" + side + "_mps"));
    if (!wrapped) continue;
    travel_wraps_ = true;
    const std::size_t row = wrapped->rows.front();
    add(Severity::refuse, name,
        fmt::format(
            "jumps by {:.4g} m{} while the track goes on, here to {:.4g} m: its counter wraps, or was set back; "
            "kenaf-gap merge and kenaf-gap dataset unwrap it with --unwrap",
            wrapped->modulus_m, wrapped->rows.size() > 1 ? fmt::format(", {} times,", wrapped->rows.size()) : "",
            travel[row]),
        line(row));
  }
}

}  // namespace kenaf::gap::logs
