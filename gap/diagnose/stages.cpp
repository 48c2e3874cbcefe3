#include "gap/diagnose/stages.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

constexpr std::pair<std::string_view, std::string_view> kGyroOfAngle[] = {
    {"gyro_x_radps", "roll_rad"}, {"gyro_y_radps", "pitch_rad"}, {"gyro_z_radps", "yaw_rad"}};
constexpr double kLevel_rad = 0.2;  // within it rates of roll, pitch and yaw are those of the gyro's axes, to 2 %

bool is_drive(std::size_t channel) {
  return diagnosis_channels()[channel].measured == physics::Stage::drive;
}
bool is_gyro(std::size_t channel) {
  return diagnosis_channels()[channel].column.starts_with("gyro_");
}

// Energy and rms of the chosen bins of whitened and of scaled residuals. `residual` may be empty for a run.
template <class Choose>
StageGap measure(Passage passage, const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                 const Coherence& coherence, const std::vector<VectorXd>& residual, Choose&& chosen) {
  StageGap stage{passage, 0, 0, 0};
  std::vector<VectorXd> whitened;
  for (std::size_t r = 0; r < features.size(); ++r) {
    VectorXd kept = VectorXd::Zero(static_cast<Eigen::Index>(features[r].bins().size()));
    for (std::size_t b = 0; b < features[r].bins().size(); ++b) {
      const auto i = static_cast<Eigen::Index>(b);
      if (residual[r].size() == 0 || std::isnan(residual[r][i]) || !chosen(features[r].bins()[b].channel)) continue;
      kept[i] = residual[r][i];
      ++stage.bins;
    }
    whitened.push_back(floor.whiteners[r](kept));
    stage.rms += whitened.back().squaredNorm();
  }
  std::size_t cells = 0;
  for (const Cell& cell : coherence.cells(whitened)) {
    if (!chosen(cell.channel)) continue;
    stage.chance += cell.z * cell.z;
    ++cells;
  }
  if (stage.bins > 0) stage.rms = std::sqrt(stage.rms / static_cast<double>(stage.bins));
  if (cells > 0) stage.chance /= static_cast<double>(cells);
  return stage;
}

// What the gyro turned in all since the start, in the columns of the angles.
runs::Run integrated(const runs::Run& run) {
  const auto time = run.column("t_s");
  runs::Run result{{"t_s"}, {{time.begin(), time.end()}}};
  for (const auto& [gyro, angle] : kGyroOfAngle) {
    const auto rate = run.column(gyro);
    if (rate.empty()) continue;
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

// By how much faster the gyro says that the robot turned than its angles do, from the span before each one to the span
// after it, where it is about level; in the gyros' bins, NaN elsewhere. Less by as much as the angles' noise makes this
// comparison worse than the gyro's own `sigma`, against which it will be held.
VectorXd gyro_against_angles(const FeatureMap& features, const runs::Run& run, const VectorXd& sigma) {
  const runs::Run turned_by_gyro = integrated(run);
  const VectorXd turned = features.of(turned_by_gyro);
  const VectorXd& measured = features.measured();
  const auto bins = features.bins();
  std::map<std::pair<std::string_view, std::size_t>, Eigen::Index> place;
  for (std::size_t b = 0; b < bins.size(); ++b)
    place[{diagnosis_channels()[bins[b].channel].column, bins[b].span}] = static_cast<Eigen::Index>(b);
  const auto level = [&](std::string_view angle, std::size_t span) {
    const auto found = place.find({angle, span});
    return found == place.end() || std::abs(measured[found->second]) < kLevel_rad;
  };
  VectorXd result = VectorXd::Constant(turned.size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [gyro, angle] : kGyroOfAngle) {
    if (turned_by_gyro.column(angle).empty()) continue;
    for (std::size_t b = 0; b < bins.size(); ++b) {
      const std::size_t span = bins[b].span;
      if (diagnosis_channels()[bins[b].channel].column != gyro || span == 0) continue;
      const auto before = place.find({angle, span - 1}), after = place.find({angle, span + 1});
      if (before == place.end() || after == place.end() || !level("roll_rad", span) || !level("pitch_rad", span))
        continue;
      const double by_gyro = turned[after->second] - turned[before->second];
      const double by_angle = measured[after->second] - measured[before->second];
      const double of_angles = std::hypot(sigma[before->second], sigma[after->second]) / (2 * features.span_s());
      const auto i = static_cast<Eigen::Index>(b);
      result[i] = (by_gyro - by_angle) / (2 * features.span_s()) / std::hypot(1.0, of_angles / sigma[i]);
    }
  }
  return result;
}

}  // namespace

std::string_view passage_name(Passage passage) {
  constexpr std::string_view kNames[] = {"command to drive", "drive to body", "body to sensor"};
  return kNames[static_cast<std::size_t>(passage)];
}

std::vector<StageGap> stage_gaps(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                                 const Coherence& coherence, const std::vector<VectorXd>& residuals,
                                 const std::vector<VectorXd>& with_measured_drives, const Observations& observations) {
  std::vector<VectorXd> of_body(features.size()), of_sensor(features.size());
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (with_measured_drives[r].size() > 0) of_body[r] = features[r].measured() - with_measured_drives[r];
    of_sensor[r] = gyro_against_angles(features[r], observations.runs[r].run, floor.sigma_of_bin[r]);
  }
  return {measure(Passage::command_to_drive, features, floor, coherence, residuals, is_drive),
          measure(Passage::drive_to_body, features, floor, coherence, of_body,
                  [](std::size_t channel) { return !is_drive(channel); }),
          measure(Passage::body_to_sensor, features, floor, coherence, of_sensor, is_gyro)};
}

}  // namespace kenaf::gap
