// Detects a pose whose y is mirrored, as from a frame with z down, or whose heading is not that of the robot's front:
// simulated tracks would carry the robot another way.
//
// Thread safety: a value.
#pragma once

#include <vector>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

// Sums over the windows of one piece of a run, of products of rates: the mean of both belts, the turn of the heading,
// and the pose's travel along its heading, to the left of it, and along it with y mirrored.
struct HeadingPiece {
  double belts = 0, turn = 0, forward = 0, left = 0, mirrored = 0;  // of the squares
  double belts_turn = 0, belts_forward = 0, belts_left = 0, belts_mirrored = 0, turn_forward = 0, turn_left = 0;
  double way_m = 0;  // of the belts, to and fro
};

// Looks at the runs of one log, one after another. A single short run tells little: the angle between heading and way
// scatters by 25 degrees over runs of 6 s with turns.
class BodyHeading {
 public:
  // Of a run that nothing else refuses.
  void look_at(const runs::Run& run);
  // At most one finding for the whole dataset, from how the mean speed of both belts goes together with the pose's
  // speed along its heading (mean rates over 0.2 s or more, on level ground where roll and pitch tell), over at least
  // three pieces of up to 6 s and 2 m of belts (all numbers chosen). Refuses y_m if their correlation is at most 0.5 as
  // read and at least 0.8 with y mirrored. Otherwise judges the angle from the heading to the way that the belts carry
  // the robot, where the way goes with the belts at all: beyond 15 degrees and twice its standard error, by the scatter
  // of the pieces, it is warned of, beyond 45 refused. Least squares of both speeds on the belts and the turn rate give
  // it, so that a pose of another point than the one about which the robot turns has none; nothing is said if belts and
  // turns go in proportion. None without a pose, yaw or tracks.
  std::vector<Finding> findings() const;

 private:
  std::vector<HeadingPiece> pieces_;
};

}  // namespace kenaf::gap::logs
