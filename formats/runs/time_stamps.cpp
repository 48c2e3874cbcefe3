#include "formats/runs/time_stamps.hpp"

#include <algorithm>
#include <vector>

namespace kenaf::runs {

namespace {

constexpr std::size_t kFewestTimes = 10;
constexpr double kIn1999_s = 9.3e8, kIn2099_s = 4.1e9;  // since 1970

struct Named {
  const char* name;
  double in_a_second;
};
constexpr Named kUnits[] = {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}};

double median_step_of(std::span<const double> times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  return *middle;
}

}  // namespace

std::optional<TimeUnit> time_unit(std::span<const double> times) {
  if (times.size() < kFewestTimes) return std::nullopt;
  const double step = median_step_of(times);

  for (const Named& unit : kUnits) {
    const double first_s = times.front() / unit.in_a_second, step_s = step / unit.in_a_second;
    if (first_s > kIn1999_s && first_s < kIn2099_s && step_s >= 1e-4 && step_s <= 10)
      return TimeUnit{std::string(unit.name) + " since 1970", unit.in_a_second};
  }

  if (!(step > 10)) return std::nullopt;
  for (const Named& unit : kUnits)
    if (const double step_s = step / unit.in_a_second; step_s >= 0.002 && step_s <= 0.5)
      return TimeUnit{unit.name, unit.in_a_second};
  return std::nullopt;
}

}  // namespace kenaf::runs
