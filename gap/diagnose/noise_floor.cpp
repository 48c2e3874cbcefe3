#include "gap/diagnose/noise_floor.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/held_forces.hpp"
#include "gap/logs/median.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMadToSigma = 1.4826;
// Share of the largest squares, which are events, not noise. The rest is not corrected for their absence, as for a
// Gaussian: repeats differ mostly by a slow drift, which is similar in all bins.
constexpr double kTrimmed = 0.05;

// A sample was taken at any time since the previous one: 1 sigma of a uniform distribution, as a fraction of its width.
const double kClockError = 1 / std::sqrt(12.0);

// Second differences of consecutive bins suppress slow changes, and with them most of a gap.
void add_second_differences(const StageFeatures& features, const VectorXd& values, const std::vector<bool>& known,
                            std::vector<std::vector<double>>& by_channel) {
  const std::vector<Bin>& bins = features.bins;
  for (std::size_t b = 2; b < bins.size(); ++b) {
    if (!known[b - 2] || !known[b - 1] || !known[b]) continue;
    if (bins[b].channel != bins[b - 2].channel || bins[b].span != bins[b - 2].span + 2) continue;
    const auto i = static_cast<Index>(b);
    by_channel[bins[b].channel].push_back(std::abs(values[i - 2] - 2 * values[i - 1] + values[i]) / std::sqrt(6.0));
  }
}

// The largest number of samples in a bin of each channel.
std::vector<std::size_t> full_bins(const std::vector<StageFeatures>& features) {
  std::vector<std::size_t> full(diagnosis_channels().size(), 0);
  for (const StageFeatures& map : features)
    for (const Bin& bin : map.bins) full[bin.channel] = std::max(full[bin.channel], bin.samples);
  return full;
}

// Channels that any run measured.
std::vector<std::size_t> measured_channels(const std::vector<StageFeatures>& features) {
  std::set<std::size_t> channels;
  for (const StageFeatures& run : features)
    for (const Bin& bin : run.bins) channels.insert(bin.channel);
  return {channels.begin(), channels.end()};
}

Eigen::MatrixXd all_shapes(const OpenShapes& open) {
  const Eigen::MatrixXd of_run = shapes_of_run(open);
  Eigen::MatrixXd shapes(open.roughness.size(), of_run.cols() + open.numerics.cols());
  shapes << of_run, open.numerics;
  return shapes;
}

VectorXd sigma_of_bins(const StageFeatures& features, const std::vector<double>& sigma,
                       const std::vector<std::size_t>& full) {
  VectorXd result(static_cast<Index>(features.bins.size()));
  for (std::size_t b = 0; b < features.bins.size(); ++b) {
    const Bin& bin = features.bins[b];
    result[static_cast<Index>(b)] =
        sigma[bin.channel] * std::sqrt(static_cast<double>(full[bin.channel]) / static_cast<double>(bin.samples));
  }
  return result;
}

// Spread of repeats beyond noise between bins: slow drift, and events at slightly different times. Whitened variance of
// each channel; 0 if unknown.
using Spreads = std::vector<double>;

std::vector<Spreads> spreads_of_groups(const std::vector<StageFeatures>& features,
                                       const std::vector<Whitener>& whiteners, const std::vector<VectorXd>& deviations,
                                       const std::vector<std::vector<bool>>& shared,
                                       const std::vector<std::vector<std::size_t>>& groups) {
  std::vector<Spreads> spreads;
  for (const std::vector<std::size_t>& group : groups) {
    // whitened squared deviations by channel, in bins that several repeats have; 1 on average for noise alone
    std::vector<std::vector<double>> squares(diagnosis_channels().size());
    for (const std::size_t r : group) {
      if (deviations[r].size() == 0) continue;
      const VectorXd white = whiteners[r](deviations[r]);
      for (std::size_t b = 0; b < features[r].bins.size(); ++b)
        if (shared[r][b])
          squares[features[r].bins[b].channel].push_back(white[static_cast<Index>(b)] * white[static_cast<Index>(b)]);
    }

    // per channel their mean without the largest 5 %, which are events
    spreads.emplace_back(squares.size(), 0.0);
    for (std::size_t c = 0; c < squares.size(); ++c) {
      if (squares[c].empty()) continue;
      std::ranges::sort(squares[c]);
      const auto kept = static_cast<std::size_t>(std::ceil(static_cast<double>(squares[c].size()) * (1 - kTrimmed)));
      double sum = 0;
      for (std::size_t i = 0; i < kept; ++i) sum += squares[c][i];
      spreads.back()[c] = sum / static_cast<double>(kept);
    }
  }
  return spreads;
}

// The median over all groups with a known spread.
Spreads usual_spread(const std::vector<Spreads>& spreads) {
  Spreads usual(diagnosis_channels().size(), 0);
  for (std::size_t c = 0; c < usual.size(); ++c) {
    std::vector<double> known;
    for (const Spreads& group : spreads)
      if (group[c] > 0) known.push_back(group[c]);
    if (!known.empty()) usual[c] = logs::upper_median(known);
  }
  return usual;
}

}  // namespace

Whitener::Whitener(const VectorXd& sigma, const Eigen::MatrixXd& shapes) : inverse_sigma_(sigma.cwiseInverse()) {
  directions_.resize(sigma.size(), 0);
  if (shapes.cols() == 0 || sigma.size() == 0) return;
  // covariance in units of sigma: 1 + S S^T; along its direction u_i the variance is 1 + s_i^2
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(inverse_sigma_.asDiagonal() * shapes, Eigen::ComputeThinU);
  directions_ = svd.matrixU();
  shrink_ = 1 - (1 + svd.singularValues().array().square()).rsqrt();
}

VectorXd Whitener::operator()(const VectorXd& difference) const {
  const VectorXd scaled = inverse_sigma_.cwiseProduct(difference);
  return scaled - directions_ * shrink_.cwiseProduct(directions_.transpose() * scaled);
}

double NoiseFloor::rms(const std::vector<VectorXd>& differences) const {
  double sum = 0, count = 0;
  for (std::size_t r = 0; r < differences.size(); ++r) {
    if (differences[r].size() == 0) continue;
    sum += whiteners[r](differences[r]).squaredNorm();
    count += static_cast<double>(differences[r].size());
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

NoiseFloor noise_floor(const std::vector<StageFeatures>& features, const std::vector<VectorXd>& residuals,
                       const std::vector<std::vector<std::size_t>>& repeats, const std::vector<OpenShapes>& open,
                       std::span<const double> stated) {
  // deviations between repeats, the bins that several of them have, and the samples of a full bin
  const std::size_t channels = diagnosis_channels().size();
  const auto [deviations, shared] = deviations_from_repeats(features, residuals, repeats);
  const std::vector<std::size_t> full = full_bins(features);
  NoiseFloor floor{std::vector<double>(channels, 0), std::vector<VectorXd>(features.size()),
                   std::vector<Whitener>(features.size()), false};
  floor.noise_of_bin = floor.sigma_of_bin;
  floor.open = open;

  // |x0 - 2 x1 + x2| / sqrt(6) has the noise's sigma, and slow changes cancel in it: of deviations from repeats, in
  // which a baseline cancels, else of the residuals themselves, which have the baseline's noise, too
  std::vector<std::vector<double>> jumps(channels);
  for (std::size_t r = 0; r < features.size(); ++r) {
    floor.from_repeats |= deviations[r].size() > 0;
    if (deviations[r].size() > 0)
      add_second_differences(features[r], deviations[r], shared[r], jumps);
    else
      add_second_differences(features[r], residuals[r].cwiseQuotient(noise_of_difference(features[r])),
                             std::vector<bool>(features[r].bins.size(), true), jumps);
  }

  // sigma of a full bin: as stated for n samples / sqrt(n), if no repeats tell; else 1.4826 median, at least a
  // resolution
  const auto noise_of = [&](std::size_t c) {
    const bool is_stated = !floor.from_repeats && !stated.empty() && stated[c] > 0;
    if (is_stated) return stated[c] / std::sqrt(static_cast<double>(full[c]));
    return jumps[c].empty() ? 0 : kMadToSigma * logs::upper_median(jumps[c]);
  };
  for (std::size_t c = 0; c < channels; ++c)
    if (full[c] > 0) floor.sigma[c] = std::max(diagnosis_channels()[c].resolution, noise_of(c));

  // sigma of each bin: noise, scaled by sqrt(full / samples), and roughness, added in squares
  std::vector<std::vector<double>> sigma_of_run(features.size(), floor.sigma);
  const auto whiten = [&] {
    for (std::size_t r = 0; r < features.size(); ++r) {
      floor.noise_of_bin[r] = sigma_of_bins(features[r], sigma_of_run[r], full);
      floor.sigma_of_bin[r] = root_of_squares(floor.noise_of_bin[r], open[r].roughness);
      floor.whiteners[r] = Whitener(floor.sigma_of_bin[r], all_shapes(open[r]));
    }
  };
  whiten();

  // repeats differ by more than noise between bins: scale sigma by the root of the group's spread, at least the usual
  // one, and never below 1
  if (!floor.from_repeats) return floor;
  const std::vector<Spreads> spreads = spreads_of_groups(features, floor.whiteners, deviations, shared, repeats);
  const Spreads usual = usual_spread(spreads);
  for (std::size_t g = 0; g < repeats.size(); ++g)
    for (const std::size_t r : repeats[g])
      for (std::size_t c = 0; c < channels; ++c)
        sigma_of_run[r][c] *= std::sqrt(std::max({1.0, usual[c], spreads[g][c]}));
  for (std::size_t c = 0; c < channels; ++c) floor.sigma[c] *= std::sqrt(std::max(1.0, usual[c]));
  whiten();
  return floor;
}

Eigen::MatrixXd shapes_of_run(const OpenShapes& open) {
  if (open.ways.cols() == 0) return open.local;
  Eigen::MatrixXd shapes(open.local.rows(), open.local.cols() + open.ways.cols());
  shapes << open.local, open.ways;
  return shapes;
}

VectorXd root_of_squares(const VectorXd& a, const VectorXd& b) {
  return (a.array().square() + b.array().square()).sqrt();
}

double rms_of_repeats(const NoiseFloor& floor, const Deviations& deviations) {
  double sum = 0, count = 0;
  for (std::size_t r = 0; r < deviations.of_runs.size(); ++r) {
    if (deviations.of_runs[r].size() == 0) continue;
    sum += floor.whiteners[r](deviations.of_runs[r]).squaredNorm();
    count += static_cast<double>(std::ranges::count(deviations.shared[r], true));
  }
  return count > 0 ? std::sqrt(sum / count) : 1;
}

NoiseFloor with_open_shapes(const NoiseFloor& floor, const std::vector<OpenShapes>& open) {
  NoiseFloor result = floor;
  for (std::size_t r = 0; r < open.size(); ++r) {
    result.open[r] = open[r];
    result.open[r].ways = floor.open[r].ways;
    result.open[r].roughness = floor.open[r].roughness.cwiseMax(open[r].roughness);
    result.sigma_of_bin[r] = root_of_squares(floor.noise_of_bin[r], result.open[r].roughness);
    result.whiteners[r] = Whitener(result.sigma_of_bin[r], all_shapes(result.open[r]));
  }
  return result;
}

std::vector<OpenShapes> open_shapes(const std::vector<StageFeatures>& features, Predictor& predictor, Passage passage,
                                    const Variation& model, double start_sigma_m, double start_sigma_rad) {
  constexpr std::size_t kOfStart = 3;  // unknowns of the start pose, which come first
  constexpr std::size_t kOpen = 7;     // these and the simulator's numbers
  // the model with each open number varied both ways, with late samples, and unchanged
  std::vector<Variation> variations(2 * kOpen + 2, model);
  variations[2 * kOpen].samples_late = kClockError;
  for (const bool minus : {false, true}) {
    Variation* v = variations.data() + (minus ? kOpen : 0);
    const double sign = minus ? -1 : 1, factor = minus ? 0.5 : 2;
    v[0].start_x_m += sign * start_sigma_m;
    v[1].start_y_m += sign * start_sigma_m;
    v[2].start_yaw_rad += sign * start_sigma_rad;
    v[3].physics.time_step_s *= factor;
    v[4].physics.contact_stiffness_npm *= factor;
    v[5].physics.contact_damping_nspm *= factor;
    v[6].physics.solver_iterations =
        minus ? std::max(1, model.physics.solver_iterations / 2) : 2 * model.physics.solver_iterations;
  }
  const std::vector<Shift> shifts = predictor.shifts(variations, passage, Fidelity::fine);
  const std::vector<std::size_t> measured = measured_channels(features), currents = motor_currents(measured);
  std::vector<OpenShapes> open;
  for (std::size_t r = 0; r < features.size(); ++r) {
    const auto size = static_cast<Index>(features[r].bins.size());
    const auto channels = std::ssize(measured);
    OpenShapes run{Eigen::MatrixXd::Zero(size, kShapesOfStart + 2 * channels + std::ssize(currents)),
                   Eigen::MatrixXd::Zero(size, 2 * static_cast<Index>(kOpen - kOfStart)), VectorXd::Zero(size)};
    // one count of a sensor persists while the robot rolls on, and its clock's error for the whole log
    const VectorXd late = shifts[2 * kOpen][r] - shifts.back()[r];
    for (Index b = 0; b < size; ++b) {
      const std::size_t channel = features[r].bins[static_cast<std::size_t>(b)].channel;
      const Index place = kShapesOfStart + (std::ranges::find(measured, channel) - measured.begin());
      run.local(b, place) = diagnosis_channels()[channel].resolution;
      run.local(b, place + channels) = late[b];
    }
    run.local.rightCols(std::ssize(currents)) = held_forces(features[r], currents);
    // odd and even part of the shifts: (plus - minus) / 2 and (plus + minus) / 2; even parts add to the roughness in
    // squares
    for (std::size_t i = 0; i < kOpen; ++i) {
      const VectorXd plus = shifts[i][r] - shifts.back()[r], minus = shifts[i + kOpen][r] - shifts.back()[r];
      const VectorXd even = (plus + minus) / 2;
      Eigen::MatrixXd& shapes = i < kOfStart ? run.local : run.numerics;
      const auto column = static_cast<Index>(2 * (i < kOfStart ? i : i - kOfStart));
      shapes.col(column) = (plus - minus) / 2;
      shapes.col(column + 1) = even;
      run.roughness.array() += even.array().square();
    }
    run.roughness = run.roughness.cwiseSqrt();
    open.push_back(std::move(run));
  }
  return open;
}

}  // namespace kenaf::gap::diagnose
