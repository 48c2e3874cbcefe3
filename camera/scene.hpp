// The world as rays meet it: the physics' own geometry in Embree, with a face for every plane piece of it.
//
// Ground planes are infinite, and cast analytically. Fixed boxes and meshes are one Embree scene that is built once;
// loose boxes and the parts of robots (hull with tracks, each arm) are instances in a second one, whose poses follow
// the snapshots. A picture is made in the thread that calls, with no other thread, window or GPU.
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

// A face of what the last update() showed; valid until the next. Numbers are dense, from 0.
using FaceId = std::uint32_t;
inline constexpr FaceId kNothing = 0x7fffffff;  // the sky

// A face where it is in the world now.
struct PlacedFace {
  Eigen::Vector3d normal_W;
  double distance;  // normal . p_W
  Affine s, t;      // of p_W
  Affine facing;    // how much the surface faces the sun: cosine of the angle; not below 0; a mesh's is smooth
  Material material;
  Eigen::Vector2d half{0, 0};  // as Face
  bool of_mesh = false;        // one triangle of a smooth surface
};

// Around a box or a part of a robot.
struct Sphere {
  Eigen::Vector3d centre_W;
  double radius_m;
};

// Rays and what they met, an array for each number, as Embree takes them. resize() keeps what has been allocated.
struct RayBatch {
  std::vector<float> from_x, from_y, from_z, along_x, along_y, along_z, near, far;  // far: after cast() where it met
  std::vector<FaceId> face;
  void resize(std::size_t count);
  std::size_t size() const { return face.size(); }
  // what Embree says beside, and wants room for
  std::vector<std::uint32_t> primitive, geometry, instance;
  std::vector<float> along_triangle_u, along_triangle_v;
};

class Scene {
 public:
  // `toward_sun_W`: any length, z above 0. Behind to the left and above one who looks along x, as shipped worlds begin.
  explicit Scene(const physics::WorldDescription& world,
                 const Eigen::Vector3d& toward_sun_W = Eigen::Vector3d(-0.45, 0.38, 0.8));
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Shows the snapshot's moment. Where robots and boxes are those of the last one, their poses are set and Embree's top
  // level is built anew (tens of us); where something came, went, or a fixed box was moved, more is (ms).
  void update(const WorldSnapshot& snapshot);

  // The first face along each ray, from `near` to `far` times its direction; `far` becomes where, `face` what.
  void cast(RayBatch& rays) const;
  // `face` becomes 0 where something lies between `near` and `far`, else kNothing. Planes stop only what comes from
  // above.
  void cast_any(RayBatch& rays) const;
  PlacedFace face(FaceId id) const;
  std::size_t face_count() const;
  // The faces of a robot, from first to before last; empty: it is not there.
  std::pair<FaceId, FaceId> faces_of(physics::RobotId robot) const;

  // Of every box and every part of a robot.
  const std::vector<Sphere>& bounds() const;

  const Eigen::Vector3d& toward_sun_W() const { return toward_sun_W_; }  // unit

 private:
  struct Implementation;
  Eigen::Vector3d toward_sun_W_;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::camera
