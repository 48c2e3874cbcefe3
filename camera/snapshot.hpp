// The visible state of a world at one moment: a plain value, so that pictures are made while the world steps on.
//
// Taken by the thread that owns the World; afterwards any thread may read it. Planes and meshes never move and are not
// included: see physics::WorldDescription. All boxes are, since World can move and remove any of them.
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
  physics::Pose X_WB;  // after a fault the last valid one
  std::array<double, robot::kFlipperCount> flipper_rad;
  std::array<double, robot::kTrackCount> track_m;     // travel of the belts, which shows their motion
  std::vector<std::vector<double>> mission_link_rad;  // of each mission package, link 1 first
};

struct BoxSnapshot {
  physics::BoxId id;
  Eigen::Vector3d size_m;
  physics::Pose X_WBox;
  bool fixed;  // no mass: moves only by World::move_box()
};

struct WorldSnapshot {
  double time_s = 0;
  std::vector<RobotSnapshot> robots;
  std::vector<BoxSnapshot> boxes;
};

// Returns whether pictures of both look alike: nothing has come or gone, or has moved or turned by more than 1e-5 m or
// rad, a fiftieth of a pixel for a camera 0.3 m away. Times do not count.
bool look_alike(const WorldSnapshot& a, const WorldSnapshot& b);

// Takes snapshots of one world, at about 1 us a robot and 0.2 us a box. Reuses the snapshot's memory, and copies a
// robot's description once.
class SnapshotTaker {
 public:
  void take(const physics::World& world, WorldSnapshot& out);

 private:
  std::map<physics::RobotId, std::shared_ptr<const physics::RobotDescription>> descriptions_;
};

}  // namespace kenaf::camera
