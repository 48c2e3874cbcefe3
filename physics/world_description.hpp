// Description of a world: ground, boxes and start poses, read from an SDF file (http://sdformat.org).
// World frame W: z up, x and y as in the file. SI units. Thread safety: a value.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "physics/pose.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::physics {

struct GroundPlane {
  Pose X_WP;            // the plane's own z axis is its normal
  double friction = 1;  // multiplies the robot's own friction coefficients
};

struct Box {
  std::string name;
  Eigen::Vector3d size_m;
  Pose X_WBox;  // centre
  double friction = 1;
  double mass_kg = 0;  // 0: fixed in the world
};

// A fixed surface of triangles: a mesh, a height map, or a shape that is neither box nor plane. Solid on the side
// against which a triangle's normal (right-hand rule) points.
struct TriangleMesh {
  std::string name;
  std::vector<Eigen::Vector3d> vertices_W;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double friction = 1;
};

struct StartPose {
  std::string name;  // "PlayerStart_0" if the file has none
  Pose X_WB;
};

struct WorldDescription {
  std::string name;
  Eigen::Vector3d gravity_W_mps2{0, 0, -9.80665};  // in any direction
  std::vector<GroundPlane> planes;
  std::vector<Box> boxes;
  std::vector<TriangleMesh> meshes;
  std::vector<StartPose> start_poses;  // SDF frames attached to the world whose name begins with "start"; at least one
};

// Loads a shipped world ("flat") or an SDF file by its path; docs/worlds.md says what of SDF is simulated, and the
// limits. What is not is listed in `unsupported`, one line each ("file:line: what"), rather than dropped in silence.
// Models, meshes and height maps are looked for in the SDF file's own folder and below it, then in those of
// world_search_path(), nowhere else. Throws DescriptionError ("file:line: what is wrong").
WorldDescription load_world(const std::string& name_or_path, std::vector<std::string>& unsupported);

// As load_world(), from text. `folder` is the world's own, `search` the search path; both empty: the text may not refer
// to files.
WorldDescription parse_world(std::string_view sdf_text, const std::string& name_for_errors,
                             const std::filesystem::path& folder, std::vector<std::string>& unsupported,
                             const std::vector<std::filesystem::path>& search = {});

// The folders that the environment variable KENAF_WORLD_PATH names, separated by ':'. Any thread, as long as none
// changes the environment.
std::vector<std::filesystem::path> world_search_path();

}  // namespace kenaf::physics
