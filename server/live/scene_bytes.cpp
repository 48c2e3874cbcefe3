#include "server/live/scene_bytes.hpp"

#include <bit>
#include <cstring>

namespace kenaf::live {

namespace {

static_assert(std::endian::native == std::endian::little, "scene_bytes() writes numbers as they are in memory");

template <typename Number>
void append(std::string& out, Number value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

void append_vector(std::string& out, const Eigen::Vector3d& v) {
  for (const double value : v) append(out, static_cast<float>(value));
}

void append_pose(std::string& out, const physics::Pose& X) {
  append_vector(out, X.p);
  for (const double value : {X.q.w(), X.q.x(), X.q.y(), X.q.z()}) append(out, static_cast<float>(value));
}

}  // namespace

std::string scene_bytes(const physics::WorldDescription& world) {
  // Static boxes only: a box with mass is part of the state.
  std::string out, boxes;
  std::uint32_t box_count = 0;
  for (const physics::Box& box : world.boxes) {
    if (box.mass_kg > 0) continue;
    ++box_count;
    append_vector(boxes, box.size_m);
    append_pose(boxes, box.X_WBox);
  }

  // Header: magic, then how many planes, boxes and meshes follow.
  append(out, kSceneMagic);
  append(out, static_cast<std::uint32_t>(world.planes.size()));
  append(out, box_count);
  append(out, static_cast<std::uint32_t>(world.meshes.size()));

  // The planes' poses, then the boxes with size and pose, then each mesh: counts, vertices, triangles as indices.
  for (const physics::GroundPlane& plane : world.planes) append_pose(out, plane.X_WP);
  out += boxes;
  for (const physics::TriangleMesh& mesh : world.meshes) {
    append(out, static_cast<std::uint32_t>(mesh.vertices_W.size()));
    append(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Eigen::Vector3d& vertex : mesh.vertices_W) append_vector(out, vertex);
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) append(out, index);
    }
  }
  return out;
}

}  // namespace kenaf::live
