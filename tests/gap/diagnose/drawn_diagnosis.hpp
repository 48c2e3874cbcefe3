// The diagnosis that was made by hand (made_diagnosis.hpp), with poses, so that its robots can be drawn.
#pragma once

#include "tests/gap/diagnose/made_diagnosis.hpp"

namespace kenaf::test {

// Adds the angles of a level robot; the features were compared before.
inline void add_angles(runs::Run& run, double yaw_rad = 0) {
  for (const auto& [column, value] : {std::pair{"roll_rad", 0.0}, {"pitch_rad", 0.0}, {"yaw_rad", yaw_rad}}) {
    run.columns.emplace_back(column);
    run.values.emplace_back(run.values.front().size(), value);
  }
}

inline gap::diagnose::Diagnosis drawn_diagnosis() {
  gap::diagnose::Diagnosis d = made_diagnosis();
  d.folder = "real runs";
  for (gap::diagnose::Observation& run : d.observations.runs) add_angles(run.run);
  return d;
}

// The nominal robot is 0.1 m ahead and turned left by 0.1 rad, the corrected one 0.01 m ahead. In the climb the drives
// differ most from 1.25 to 1.5 s.
inline std::vector<gap::diagnose::Overlay> drawn_overlays(const gap::diagnose::Diagnosis& d) {
  std::vector<gap::diagnose::Overlay> overlays;
  for (const std::size_t group : gap::diagnose::shown_groups(d)) {
    overlays.push_back({group, d.repeats[group].front(), {}, {}, run_ahead_by(0.1, 0.05), run_ahead_by(0.01)});
    add_angles(overlays.back().nominal, 0.1);
    if (group == 1)
      for (std::size_t i = 13; i < 15; ++i) overlays.back().nominal.values[4][i] += 0.2;  // track_left_mps
    add_angles(*overlays.back().corrected);
  }
  gap::diagnose::choose_channels(d, overlays);
  return overlays;
}

}  // namespace kenaf::test
