// The world for ray casting: the physics' own geometry in Embree, with a face for every plane piece of it.
//
// Ground planes are infinite, and cast analytically. Fixed boxes and meshes are one Embree scene that is built once;
// loose boxes and the parts of robots (hull with tracks, each arm) are instances in a second one, whose poses follow
// the snapshots. A picture is made in the calling thread, with no other thread, window or GPU.
//
// Thread safety: cast(), cast_any() and face() may be called by several threads between two updates; update() excludes
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "camera/snapshot.hpp"
#include "camera/surface.hpp"

namespace kenaf::camera {

// A face of the scene as of the last update(); valid until the next one. Numbers are dense, from 0.
using FaceId = std::uint32_t;
inline constexpr FaceId kNothing = 0x7fffffff;  // the sky

// A face at its present place in the world.
struct PlacedFace {
  Eigen::Vector3d normal_W;
  double distance;  // normal . p_W
  Affine s, t;      // of p_W
  Affine facing;    // cosine of the angle to the sun, at least 0; smooth on a mesh
  Material material;
  Eigen::Vector2d half{0, 0};  // as Face
  bool of_mesh = false;        // one triangle of a smooth surface
};

// Bounding sphere of a box or a part of a robot.
struct Sphere {
  Eigen::Vector3d centre_W;
  double radius_m;
};

// Rays and their hits as structure of arrays. resize() keeps allocated memory.
struct RayBatch {
  std::vector<float> from_x, from_y, from_z, along_x, along_y, along_z, near, far;  // far: after cast() the hit
  std::vector<FaceId> face;
  void resize(std::size_t count);
  std::size_t size() const { return face.size(); }
};

class Scene {
 public:
  // `toward_sun_W`: any length, z above 0. By default above, behind and to the left of a viewer who looks along x, as
  // robots in shipped worlds do at the start.
  explicit Scene(const physics::WorldDescription& world,
                 const Eigen::Vector3d& toward_sun_W = Eigen::Vector3d(-0.45, 0.38, 0.8));
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Moves the scene to the snapshot. If robots and boxes are those of the last one, their poses are set and Embree's
  // top level is rebuilt (tens of us); if something came or went, or a fixed box was moved, more is rebuilt (ms).
  void update(const WorldSnapshot& snapshot);

  // Finds the first face along each ray, from `near` to `far` times its direction. Sets `far` and
  // `face`.
  void cast(RayBatch& rays) const;
  // Sets `face` to 0 if anything lies between `near` and `far`, else to kNothing. Planes stop only rays from above.
  void cast_any(RayBatch& rays) const;
  PlacedFace face(FaceId id) const;
  std::size_t face_count() const;
  // The half-open range of a robot's faces; empty if it is not in the scene.
  std::pair<FaceId, FaceId> faces_of(physics::RobotId robot) const;

  // Bounding spheres of every box and every part of a robot.
  const std::vector<Sphere>& bounds() const;

  const Eigen::Vector3d& toward_sun_W() const { return toward_sun_W_; }  // unit

 private:
  struct Implementation;
  Eigen::Vector3d toward_sun_W_;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::camera
