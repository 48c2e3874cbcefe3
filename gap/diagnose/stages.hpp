// The gap split along the way from command to sensor, each part without the ones before it: what the drives make of a
// command; what the body makes of what the drives did, with belts and flippers that turn as they were measured; what
// sensors say of what the body did, without a simulator.
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/observation.hpp"

namespace kenaf::gap {

enum class Passage { command_to_drive, drive_to_body, body_to_sensor };

std::string_view passage_name(Passage passage);  // "command to drive"

struct StageGap {
  Passage passage;
  double rms;         // of its channels' residual, whitened
  double chance;      // energy of its cells over their number; near 1 or below without a gap
  std::size_t bins;   // 0: these runs do not measure it
};
// Beyond this the passage has a gap of its own.
inline constexpr double kStageChance = 2;

// In the order of Passage. `residuals`: measured minus nominal; `with_measured_drives` as Predictor has it.
std::vector<StageGap> stage_gaps(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                                 const Coherence& coherence, const std::vector<Eigen::VectorXd>& residuals,
                                 const std::vector<Eigen::VectorXd>& with_measured_drives,
                                 const Observations& observations);

}  // namespace kenaf::gap
