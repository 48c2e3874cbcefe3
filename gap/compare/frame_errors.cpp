#include "gap/compare/frame_errors.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap::compare {

namespace {

// Calls `action` with each quantity of an error and its summary.
template <typename Error, typename Action>
void for_each_quantity(const Error& error, ErrorSummary& summary, const Action& action) {
  action(summary.position_m, error.position_m);
  action(summary.y_m, error.y_m);
  action(summary.roll_rad, error.roll_rad);
  action(summary.pitch_rad, error.pitch_rad);
  action(summary.yaw_rad, error.yaw_rad);
  action(summary.time_s, error.time_s);
}

}  // namespace

FrameError frame_error(Plane plane, const PoseFrame& real, const PoseFrame& sim) {
  const double second_m = plane == Plane::vertical ? sim.z_m - real.z_m : sim.y_m - real.y_m;
  return {std::hypot(sim.x_m - real.x_m, second_m), sim.y_m - real.y_m,
          wrapped(sim.roll_rad - real.roll_rad),    wrapped(sim.pitch_rad - real.pitch_rad),
          wrapped(sim.yaw_rad - real.yaw_rad),      sim.t_s - real.t_s};
}

void Summary::add(double error, double weight) {
  if (std::isnan(error)) return;
  const double size = std::abs(error);
  weight_ += weight;
  sum_ += weight * size;
  sum_of_squares_ += weight * size * size;
  max_ = std::max(max_, size);
}

void Summary::add(const Summary& other) {
  weight_ += other.weight_;
  sum_ += other.sum_;
  sum_of_squares_ += other.sum_of_squares_;
  max_ = std::max(max_, other.max_);
}

double Summary::mean() const {
  return weight_ > 0 ? sum_ / weight_ : kUnknown;
}
double Summary::rms() const {
  return weight_ > 0 ? std::sqrt(sum_of_squares_ / weight_) : kUnknown;
}
double Summary::max() const {
  return weight_ > 0 ? max_ : kUnknown;
}

void ErrorSummary::add(const FrameError& error, double weight) {
  for_each_quantity(error, *this, [weight](Summary& summary, double value) { summary.add(value, weight); });
}

void ErrorSummary::add(const ErrorSummary& other) {
  for_each_quantity(other, *this, [](Summary& summary, const Summary& value) { summary.add(value); });
}

std::vector<double> pair_weights(const std::vector<FramePair>& pairs) {
  std::vector<double> weights;
  weights.reserve(pairs.size());
  for (auto first = pairs.begin(); first != pairs.end();) {
    const auto next = std::find_if(first, pairs.end(), [&](const FramePair& pair) { return pair.real != first->real; });
    weights.insert(weights.end(), static_cast<std::size_t>(next - first), 1 / static_cast<double>(next - first));
    first = next;
  }
  return weights;
}

RunErrors run_errors(Plane plane, const std::vector<PoseFrame>& real, const std::vector<PoseFrame>& sim,
                     const std::vector<FramePair>& pairs) {
  // Matched: a pair counts with its weight, in the summary and in the mean of its real frame.
  RunErrors errors{{}, {}, {}, {}, frame_error(plane, real.back(), sim.back())};
  const std::vector<double> weights = pair_weights(pairs);
  errors.matched.assign(real.size(), FrameError{});
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const FrameError error = frame_error(plane, real[pairs[k].real], sim[pairs[k].sim]);
    errors.matched_summary.add(error, weights[k]);
    FrameError& mean = errors.matched[pairs[k].real];
    mean.position_m += weights[k] * error.position_m;
    mean.y_m += weights[k] * std::abs(error.y_m);
    mean.roll_rad += weights[k] * std::abs(error.roll_rad);
    mean.pitch_rad += weights[k] * std::abs(error.pitch_rad);
    mean.yaw_rad += weights[k] * std::abs(error.yaw_rad);
    mean.time_s += weights[k] * error.time_s;
  }

  // Same time: against the interpolated simulated pose.
  for (const PoseFrame& frame : real) {
    errors.same_time.push_back(frame_error(plane, frame, pose_at(sim, frame.t_s)));
    errors.same_time.back().time_s = kUnknown;
    errors.same_time_summary.add(errors.same_time.back());
  }
  return errors;
}

}  // namespace kenaf::gap::compare
