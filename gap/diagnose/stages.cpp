#include "gap/diagnose/stages.hpp"

#include <cmath>
#include <limits>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

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
      stage.rms += std::pow(kept[i] / floor.sigma_of_bin[r][i], 2);
      ++stage.bins;
    }
    whitened.push_back(floor.whiteners[r](kept));
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

// The gyro's bins minus the mean rate of the angle that was measured, where the robot is about level; NaN elsewhere.
VectorXd gyro_against_angles(const FeatureMap& features, const VectorXd& measured) {
  const auto bins = features.bins();
  const auto bin_of = [&](std::string_view column, std::size_t span) -> std::ptrdiff_t {
    for (std::size_t b = 0; b < bins.size(); ++b)
      if (bins[b].span == span && diagnosis_channels()[bins[b].channel].column == column)
        return static_cast<std::ptrdiff_t>(b);
    return -1;
  };
  VectorXd result = VectorXd::Constant(static_cast<Eigen::Index>(bins.size()), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (!is_gyro(bins[b].channel) || bins[b].span == 0) continue;
    const std::string_view gyro = diagnosis_channels()[bins[b].channel].column;
    const std::string_view angle = gyro[5] == 'x' ? "roll_rad" : gyro[5] == 'y' ? "pitch_rad" : "yaw_rad";
    const auto before = bin_of(angle, bins[b].span - 1), after = bin_of(angle, bins[b].span + 1);
    const auto roll = bin_of("roll_rad", bins[b].span), pitch = bin_of("pitch_rad", bins[b].span);
    if (before < 0 || after < 0) continue;
    if ((roll >= 0 && std::abs(measured[roll]) > kLevel_rad) || (pitch >= 0 && std::abs(measured[pitch]) > kLevel_rad))
      continue;
    // means over neighbouring spans differ by the rate's mean over both, with triangular weights: as the gyro's own,
    // weighted likewise
    const auto gyro_before = bin_of(gyro, bins[b].span - 1), gyro_after = bin_of(gyro, bins[b].span + 1);
    if (gyro_before < 0 || gyro_after < 0) continue;
    const auto i = static_cast<Eigen::Index>(b);
    const double weighted = (measured[gyro_before] + 2 * measured[i] + measured[gyro_after]) / 4;
    result[i] = weighted - (measured[after] - measured[before]) / (2 * features.span_s());
  }
  return result;
}

}  // namespace

std::vector<StageGap> stage_gaps(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                                 const Coherence& coherence, const std::vector<VectorXd>& residuals,
                                 const std::vector<VectorXd>& with_measured_drives) {
  std::vector<VectorXd> of_body(features.size()), of_sensor(features.size());
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (with_measured_drives[r].size() > 0) of_body[r] = features[r].measured() - with_measured_drives[r];
    of_sensor[r] = gyro_against_angles(features[r], features[r].measured());
  }
  return {measure(Passage::command_to_drive, features, floor, coherence, residuals, is_drive),
          measure(Passage::drive_to_body, features, floor, coherence, of_body,
                  [](std::size_t channel) { return !is_drive(channel); }),
          measure(Passage::body_to_sensor, features, floor, coherence, of_sensor, is_gyro)};
}

}  // namespace kenaf::gap
