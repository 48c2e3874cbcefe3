// What of a world can be seen at one moment: a plain value, so that pictures are made while the world steps on.
//
// Taken by the thread that owns the World; afterwards any thread may read it. Planes and meshes never move and are not
// in it: they are in physics::WorldDescription. Boxes are, the fixed ones too, because World can move and remove any.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "physics/world.hpp"

namespace kenaf::camera {

struct RobotSnapshot {
  physics::RobotId id;
  std::shared_ptr<const physics::RobotDescription> description;  // shared by all snapshots of this robot
  std::string name;
  physics::Pose X_WB;  // after a fault where it last was whole
  std::array<double, robot::kFlipperCount> flipper_rad;
  std::array<double, robot::kTrackCount> track_m;     // travel of the belts, so that they are seen to run
  std::vector<std::vector<double>> mission_link_rad;  // of each mission package, link 1 first
};

struct BoxSnapshot {
  physics::BoxId id;
  Eigen::Vector3d size_m;
  physics::Pose X_WBox;
  bool fixed;  // no mass: moves only when it is told to
};

struct WorldSnapshot {
  double time_s = 0;
  std::vector<RobotSnapshot> robots;
  std::vector<BoxSnapshot> boxes;
};

// Takes snapshots of one world. Costs some 1 us a robot and 0.2 us a box; what a snapshot holds is used again, and a
// robot's description is copied once.
class SnapshotTaker {
 public:
  void take(const physics::World& world, WorldSnapshot& out);

 private:
  std::map<physics::RobotId, std::shared_ptr<const physics::RobotDescription>> descriptions_;
};

}  // namespace kenaf::camera
