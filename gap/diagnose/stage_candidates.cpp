#include "gap/diagnose/stage_candidates.hpp"

#include <algorithm>

namespace kenaf::gap::diagnose {
namespace {

// Whether it changes the drives' sensors; the other sensors measure the body.
bool is_of_drives_sensors(const candidates::Candidate& candidate) {
  return std::ranges::any_of(candidate.keys, [](const std::string& key) {
    return key.starts_with("effects.encoder") || key.starts_with("sensor[");
  });
}

// Whether it belongs to a drive, but behind its encoder.
bool is_behind_encoders(const candidates::Candidate& candidate) {
  return std::ranges::any_of(candidate.keys, [](const std::string& key) {
    return key.starts_with("effects.flipper_backlash") || key.starts_with("effects.flipper_compliance");
  });
}

bool acts_in(Passage passage, const candidates::Candidate& candidate, bool drives_measured) {
  const bool is_of_drive = candidate.stage == physics::Stage::command || candidate.stage == physics::Stage::drive;
  const bool is_of_sensor = candidate.stage == physics::Stage::sensor;
  switch (passage) {
    case Passage::command_to_drive:
      return !is_of_sensor || is_of_drives_sensors(candidate);
    case Passage::drive_to_body:
      return !is_of_drive || !drives_measured || is_behind_encoders(candidate);
    case Passage::body_to_sensor:
      return is_of_sensor;
  }
  return false;
}

}  // namespace

std::vector<std::size_t> candidates_of(Passage passage, std::span<const candidates::Candidate> candidates,
                                       bool drives_measured) {
  std::vector<std::size_t> result;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    if (acts_in(passage, candidates[c], drives_measured)) result.push_back(c);
  return result;
}

physics::RobotDescription with_settings(physics::RobotDescription robot,
                                        std::span<const candidates::Candidate> candidates, const Settings& settings) {
  for (const bool relative : {false, true})
    for (const Setting& setting : settings)
      if (candidates[setting.candidate].is_relative == relative)
        candidates[setting.candidate].set(robot, setting.value);
  return robot;
}

}  // namespace kenaf::gap::diagnose
