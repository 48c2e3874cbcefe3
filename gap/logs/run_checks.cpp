#include "gap/logs/run_checks.hpp"

#include <limits>
#include <numbers>

namespace kenaf::gap::logs {
namespace {

constexpr double kFewestPoints = 15;  // chosen

}  // namespace

bool RunChecks::has(const std::string& name) const {
  return runs::any_measured(column(name));
}

bool RunChecks::found(const std::string& name) const {
  return std::ranges::find(findings_, name, &Finding::column) != findings_.end();
}

bool RunChecks::refused(const std::string& name) const {
  return std::ranges::any_of(findings_, [&](const Finding& finding) {
    return finding.column == name && finding.severity == Severity::refuse;
  });
}

Course RunChecks::adding(const std::string& name) const {
  const auto t_s = column("t_s"), values = column(name);
  return course_of(t_s, values, longest_gap_s(median_step(t_s, values)));
}

std::vector<bool> RunChecks::upright(double most_tilt_rad) const {
  const auto tilt = [this](const std::string& name) { return column(has(name) ? name : "posture_" + name); };
  const auto roll = tilt("roll_rad"), pitch = tilt("pitch_rad");
  std::vector<bool> upright(run_.row_count());
  double roll_rad = 0, pitch_rad = 0;
  for (std::size_t i = 0; i < upright.size(); ++i) {
    if (i < roll.size() && !std::isnan(roll[i])) roll_rad = roll[i];
    if (i < pitch.size() && !std::isnan(pitch[i])) pitch_rad = pitch[i];
    upright[i] = std::max(std::abs(roll_rad), std::abs(pitch_rad)) < most_tilt_rad;
  }
  return upright;
}

Course RunChecks::upright_angle(const std::string& name, double most_tilt_rad, double units_in_a_radian) const {
  const auto t_s = column("t_s"), values = column(name);
  const std::vector<bool> is_upright = upright(units_in_a_radian * most_tilt_rad);
  std::vector<double> kept(values.begin(), values.end());
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (!is_upright[i]) kept[i] = std::numeric_limits<double>::quiet_NaN();
  Course course = course_of(t_s, kept, longest_gap_s(median_step(t_s, values)));

  // Unwraps by the shorter way between samples.
  for (double& value : course.value) value /= units_in_a_radian;
  double before = course.value.empty() ? 0 : course.value.front();
  for (std::size_t i = 1; i < course.value.size(); ++i) {
    const double now = course.value[i];
    course.value[i] = course.value[i - 1] + std::remainder(now - before, 2 * std::numbers::pi);
    before = now;
  }
  return course;
}

Course RunChecks::rate(const std::string& name) const {
  const auto t_s = column("t_s"), values = column(name);
  return course_of_rate(t_s, values, longest_gap_s(median_step(t_s, values)));
}

Course RunChecks::forward(double most_tilt_rad) const {
  return along(0, 1, most_tilt_rad);
}

Course RunChecks::along(double left_of_heading_rad, double y_sign, double most_tilt_rad) const {
  const auto t_s = column("t_s"), x = column("x_m"), y = column("y_m"), yaw = column("yaw_rad");
  Course course;
  if (x.empty() || y.empty() || yaw.empty()) return course;
  const std::vector<bool> is_upright = upright(most_tilt_rad);
  std::size_t last = 0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (std::isnan(x[i] + y[i] + yaw[i]) || !is_upright[i]) continue;
    double sum = 0;
    if (!course.t_s.empty()) {
      // The displacement along the heading half way between both rows, or beside it.
      const double heading =
          yaw[last] + 0.5 * std::remainder(yaw[i] - yaw[last], 2 * std::numbers::pi) + left_of_heading_rad;
      sum = course.value.back() + (x[i] - x[last]) * std::cos(heading) + y_sign * (y[i] - y[last]) * std::sin(heading);
    }
    course.t_s.push_back(t_s[i]);
    course.value.push_back(sum);
    last = i;
  }
  course.longest_gap_s = longest_gap_s(median_step(course.t_s, course.t_s));
  return course;
}

Course RunChecks::belts(double left, double right) const {
  const auto t_s = column("t_s");
  for (const char* name : {"track_{}_m", "track_{}_mps", "cmd_track_{}_mps"}) {
    const std::string of_left = fmt::format(fmt::runtime(name), "left"),
                      of_right = fmt::format(fmt::runtime(name), "right");
    if (!has(of_left) || !has(of_right)) continue;
    if (travel_wraps_ && of_left.ends_with("_m")) continue;
    const auto a = column(of_left), b = column(of_right);
    std::vector<double> sum(t_s.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = left * a[i] + right * b[i];
    const double gap_s = longest_gap_s(median_step(t_s, sum));
    return of_left.ends_with("_m") ? course_of(t_s, sum, gap_s) : course_of_rate(t_s, sum, gap_s);
  }
  return {};
}

std::optional<Relation> RunChecks::relate(const Course& first, const Course& second) const {
  if (first.t_s.size() < 2 || second.t_s.size() < 2) return std::nullopt;
  // The window is long enough for the slower of the two.
  const double step_of_slower = std::max(median_step(first.t_s, first.t_s), median_step(second.t_s, second.t_s));
  const double window_s = comparing_window_s(step_of_slower), step_s = window_s / kStepsPerWindow;
  double aa = 0, bb = 0, ab = 0, sum_a = 0, sum_b = 0, count = 0;
  // Only at times that have a sample, so that a jump of the clock does not add any.
  double next_s = first.t_s.front();
  for (const double t_s : first.t_s) {
    if (t_s < next_s) continue;
    next_s = t_s + step_s;
    const double a = mean_rate(first, t_s, window_s), b = mean_rate(second, t_s, window_s);
    if (std::isnan(a + b)) continue;
    aa += a * a;
    bb += b * b;
    ab += a * b;
    sum_a += std::abs(a) * step_s;
    sum_b += std::abs(b) * step_s;
    ++count;
  }

  // ratio = sqrt(sum aa / sum bb), correlation = sum ab / sqrt(sum aa sum bb)
  if (count < kFewestPoints || !(aa > 0) || !(bb > 0)) return std::nullopt;
  return Relation{std::sqrt(aa / bb), ab / std::sqrt(aa * bb), sum_a, sum_b};
}

std::optional<Relation> RunChecks::relate_values(const std::string& name, const std::string& other) const {
  const auto x = column(name), y = column(other);
  double xx = 0, yy = 0, xy = 0, sum_x = 0, sum_y = 0, count = 0;
  double last_x = std::numeric_limits<double>::quiet_NaN(), last_y = last_x;
  double least_x = 0, most_x = 0, least_y = 0, most_y = 0, first_x = 0, first_y = 0;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isnan(x[i])) last_x = x[i];
    if (!std::isnan(y[i])) last_y = y[i];
    if (std::isnan(last_x + last_y)) continue;
    // Sums are taken about the first values, so that a large offset does not cost digits.
    if (count++ == 0) first_x = last_x, first_y = last_y;
    const double a = last_x - first_x, b = last_y - first_y;
    sum_x += a, sum_y += b, xx += a * a, yy += b * b, xy += a * b;
    least_x = std::min(least_x, a), most_x = std::max(most_x, a);
    least_y = std::min(least_y, b), most_y = std::max(most_y, b);
  }
  // About the means: sum (x - mean)^2 = sum xx - (sum x)^2 / n.
  xx -= sum_x * sum_x / count, yy -= sum_y * sum_y / count, xy -= sum_x * sum_y / count;
  if (!(count > 1) || !(xx > 0) || !(yy > 0)) return std::nullopt;
  return Relation{std::sqrt(xx / yy), xy / std::sqrt(xx * yy), most_x - least_x, most_y - least_y};
}

double RunChecks::distance_of_belts() const {
  double farthest = 0;
  for (const Course& belt : {belts(1, 0), belts(0, 1)}) {
    double sum = 0;
    for (std::size_t i = 1; i < belt.value.size(); ++i) sum += std::abs(belt.value[i] - belt.value[i - 1]);
    farthest = std::max(farthest, sum);
  }
  return farthest;
}

double RunChecks::farthest_from_start() const {
  const auto x = column("x_m"), y = column("y_m");
  double farthest = 0;
  std::optional<std::size_t> start;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (std::isnan(x[i] + y[i])) continue;
    if (!start) start = i;
    farthest = std::max(farthest, std::hypot(x[i] - x[*start], y[i] - y[*start]));
  }
  return farthest;
}

}  // namespace kenaf::gap::logs
