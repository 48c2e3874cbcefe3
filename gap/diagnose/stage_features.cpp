#include "gap/diagnose/stage_features.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::pair<std::string_view, std::string_view> kGyroOfAngle[] = {
    {"gyro_x_radps", "roll_rad"}, {"gyro_y_radps", "pitch_rad"}, {"gyro_z_radps", "yaw_rad"}};
// Within it the rates of roll, pitch and yaw equal those about the gyro's axes to 2 %.
constexpr double kLevel_rad = 0.2;

std::string_view column_of(const Bin& bin) {
  return diagnosis_channels()[bin.channel].column;
}

bool is_drive(const Bin& bin) {
  return diagnosis_channels()[bin.channel].seen == robot::Seen::drive;
}

// The gyro's rates integrated since the start, in the columns of the angles.
runs::Run integrated(const runs::Run& run) {
  const auto time = run.column("t_s");
  runs::Run result{{"t_s"}, {{time.begin(), time.end()}}};
  for (const auto& [gyro, angle] : kGyroOfAngle) {
    const auto rate = run.column(gyro);
    if (rate.empty()) continue;
    // trapezoidal rule between rows with a rate
    std::vector<double> turned(rate.size(), std::numeric_limits<double>::quiet_NaN());
    std::ptrdiff_t last = -1;
    for (std::ptrdiff_t i = 0; i < std::ssize(turned); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (std::isnan(rate[k])) continue;
      const auto l = static_cast<std::size_t>(last);
      turned[k] = last < 0 ? 0 : turned[l] + (rate[l] + rate[k]) / 2 * (time[k] - time[l]);
      last = i;
    }
    result.columns.emplace_back(angle);
    result.values.push_back(std::move(turned));
  }
  return result;
}

// A bin of a gyro channel, and the bins of its angle one span before and after it.
struct RateBin {
  Index gyro, before, after;
};

// The gyro bins whose rate follows from the adjacent angles: where the robot is nearly level.
std::vector<RateBin> rate_bins(const FeatureMap& map) {
  std::map<std::pair<std::string_view, std::size_t>, Index> place;
  for (std::size_t b = 0; b < map.bins().size(); ++b)
    place[{column_of(map.bins()[b]), map.bins()[b].span}] = static_cast<Index>(b);
  const auto is_level = [&](std::string_view angle, std::size_t span) {
    const auto found = place.find({angle, span});
    return found == place.end() || std::abs(map.measured()[found->second]) < kLevel_rad;
  };
  std::vector<RateBin> result;
  for (std::size_t b = 0; b < map.bins().size(); ++b)
    for (const auto& [gyro, angle] : kGyroOfAngle) {
      const std::size_t span = map.bins()[b].span;
      if (column_of(map.bins()[b]) != gyro || span == 0) continue;
      const auto before = place.find({angle, span - 1}), after = place.find({angle, span + 1});
      if (before != place.end() && after != place.end() && is_level("roll_rad", span) && is_level("pitch_rad", span))
        result.push_back({static_cast<Index>(b), before->second, after->second});
    }
  return result;
}

// Gyro rate minus rate of the angle, over the two spans around each bin.
VectorXd gyro_against_angles(const FeatureMap& map, std::span<const RateBin> bins, const VectorXd& features,
                             const runs::Run& run) {
  const VectorXd turned = map.of(integrated(run));
  VectorXd result(static_cast<Index>(bins.size()));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const auto& [gyro, before, after] = bins[i];
    const double by_gyro = turned[after] - turned[before], by_angle = features[after] - features[before];
    result[static_cast<Index>(i)] = (by_gyro - by_angle) / (2 * map.span_s());
  }
  return result;
}

}  // namespace

std::string_view passage_name(Passage passage) {
  constexpr std::string_view kNames[] = {"command to drive", "drive to body", "body to sensor"};
  return kNames[static_cast<std::size_t>(passage)];
}

VectorXd noise_of_difference(const StageFeatures& run) {
  if (run.baseline_runs.size() == 0) return VectorXd::Ones(std::ssize(run.bins));
  return (1 + run.baseline_runs.array().inverse()).sqrt();
}

StageFeatures stage_features(Passage passage, const FeatureMap& map, const runs::Run& measured) {
  StageFeatures stage{{}, map.span_s(), {}, {}};
  if (passage == Passage::body_to_sensor) {
    const std::vector<RateBin> bins = rate_bins(map);
    for (const RateBin& bin : bins) stage.rows.push_back(bin.gyro);
    stage.measured = gyro_against_angles(map, bins, map.measured(), measured);
  } else {
    for (std::size_t b = 0; b < map.bins().size(); ++b)
      if (is_drive(map.bins()[b]) == (passage == Passage::command_to_drive))
        stage.rows.push_back(static_cast<Index>(b));
    stage.measured = map.measured()(stage.rows);
  }
  for (const Index row : stage.rows) stage.bins.push_back(map.bins()[static_cast<std::size_t>(row)]);
  return stage;
}

VectorXd stage_values(Passage passage, const StageFeatures& stage, const FeatureMap& map, const VectorXd& features,
                      const runs::Run& simulated) {
  if (stage.rows.empty()) return {};
  if (passage != Passage::body_to_sensor) return features(stage.rows);
  std::vector<RateBin> bins = rate_bins(map);
  std::erase_if(bins, [&](const RateBin& bin) { return !std::ranges::binary_search(stage.rows, bin.gyro); });
  return gyro_against_angles(map, bins, features, simulated);
}

}  // namespace kenaf::gap::diagnose
