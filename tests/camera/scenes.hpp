// Snapshots and pictures that the tests of this room share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "camera/renderer.hpp"
#include "camera/robot_cameras.hpp"

namespace kenaf::camera {

inline physics::Pose pose(double x, double y, double z, double roll = 0, double pitch = 0, double yaw = 0) {
  return {{x, y, z}, physics::rotation_from({roll, pitch, yaw})};
}

inline physics::WorldDescription world_of(const std::string& name) {
  std::vector<std::string> unsupported;
  return physics::load_world(name, unsupported);
}

inline physics::WorldDescription level_ground() {
  physics::WorldDescription world;
  world.planes.push_back({});
  return world;
}

// Kenaf, as a snapshot has it; arms at `flippers_rad`.
inline RobotSnapshot kenaf_at(const physics::Pose& X_WB, double flippers_rad = 1) {
  static const auto description = std::make_shared<const physics::RobotDescription>(physics::load_robot("kenaf"));
  RobotSnapshot robot{physics::RobotId{1}, description, "R1", X_WB, {}, {}, {{0, 0}}};
  robot.flipper_rad.fill(flippers_rad);
  return robot;
}

inline BoxSnapshot box_at(std::uint32_t id, const Eigen::Vector3d& size_m, const physics::Pose& X_WBox, bool fixed) {
  return {physics::BoxId{id}, size_m, X_WBox, fixed};
}

// What a world shows before anything is moved.
inline WorldSnapshot snapshot_of(const physics::WorldDescription& world) {
  WorldSnapshot snapshot;
  std::uint32_t id = 100;
  for (const physics::Box& box : world.boxes)
    snapshot.boxes.push_back(box_at(id++, box.size_m, box.X_WBox, box.mass_kg == 0));
  return snapshot;
}

inline Picture picture_of(const Scene& scene, const View& view, bool every_pixel = false) {
  Picture picture;
  Renderer({.every_pixel = every_pixel}).render(scene, view, picture);
  return picture;
}

inline Picture picture_of(const physics::WorldDescription& world, const WorldSnapshot& snapshot, const View& view) {
  Scene scene(world);
  scene.update(snapshot);
  return picture_of(scene, view);
}

inline double brightness(const Picture& picture, int column, int row) {
  const std::uint8_t* rgb = picture.at(column, row);
  return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

// Of the pixel that shows a point, which must be in the picture.
inline double brightness_at(const Picture& picture, const View& view, const Eigen::Vector3d& p_W) {
  const Pixel pixel = project(view, p_W).value();
  return brightness(picture, static_cast<int>(std::floor(pixel.u)), static_cast<int>(std::floor(pixel.v)));
}

// The share of pixels in which a colour differs by more than `levels`.
inline double differing_share(const Picture& a, const Picture& b, int levels) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool differs = false;
    for (std::size_t k = 0; k < 3; ++k) differs = differs || std::abs(a.rgb[i + k] - b.rgb[i + k]) > levels;
    count += differs;
  }
  return 3 * static_cast<double>(count) / static_cast<double>(a.rgb.size());
}

inline View eye(const physics::Pose& X_WC, double field_of_view_rad = 1.05) {
  return {{640, 480, field_of_view_rad}, X_WC};
}

}  // namespace kenaf::camera
