#include "camera/snapshot.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::camera {

namespace {

void take_robot(const physics::World& world, physics::RobotId id, RobotSnapshot& out) {
  const physics::RobotTruth truth = world.truth(id);
  out.id = id;
  out.name = world.robot_name(id);
  out.X_WB = truth.X_WB;
  out.flipper_rad = truth.flipper_rad;
  out.track_m = truth.track_m;
  const auto& packages = out.description->mission_packages;
  out.mission_link_rad.resize(packages.size());
  for (std::size_t p = 0; p < packages.size(); ++p) {
    out.mission_link_rad[p].resize(packages[p].links.size());
    for (std::size_t l = 0; l < packages[p].links.size(); ++l)
      out.mission_link_rad[p][l] = world.mission_link_rad(id, p, l);
  }
}

constexpr double kStill = 1e-5;  // m or rad

bool is_near(double a, double b) {
  return std::abs(a - b) <= kStill;
}
bool near_pose(const physics::Pose& a, const physics::Pose& b) {
  return (a.p - b.p).norm() <= kStill && a.q.angularDistance(b.q) <= kStill;
}
bool near_robot(const RobotSnapshot& a, const RobotSnapshot& b) {
  const auto near_links = [](const auto& links_a, const auto& links_b) {
    return std::ranges::equal(links_a, links_b, is_near);
  };
  return a.id == b.id && near_pose(a.X_WB, b.X_WB) && std::ranges::equal(a.flipper_rad, b.flipper_rad, is_near) &&
         std::ranges::equal(a.track_m, b.track_m, is_near) &&
         std::ranges::equal(a.mission_link_rad, b.mission_link_rad, near_links);
}
bool near_box(const BoxSnapshot& a, const BoxSnapshot& b) {
  return a.id == b.id && a.size_m == b.size_m && near_pose(a.X_WBox, b.X_WBox);
}

}  // namespace

bool look_alike(const WorldSnapshot& a, const WorldSnapshot& b) {
  return std::ranges::equal(a.robots, b.robots, near_robot) && std::ranges::equal(a.boxes, b.boxes, near_box);
}

void SnapshotTaker::take(const physics::World& world, WorldSnapshot& out) {
  out.time_s = world.time_s();
  const std::vector<physics::RobotId> robots = world.robots();
  if (descriptions_.size() > robots.size())
    std::erase_if(descriptions_, [&](const auto& entry) { return std::ranges::count(robots, entry.first) == 0; });
  out.robots.resize(robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    auto& description = descriptions_[robots[i]];
    if (!description)
      description = std::make_shared<const physics::RobotDescription>(world.robot_description(robots[i]));
    out.robots[i].description = description;
    take_robot(world, robots[i], out.robots[i]);
  }
  const std::vector<physics::BoxId> boxes = world.boxes();
  out.boxes.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const physics::Box& box = world.box(boxes[i]);
    out.boxes[i] = {boxes[i], box.size_m, world.box_pose(boxes[i]), box.mass_kg == 0};
  }
}

}  // namespace kenaf::camera
