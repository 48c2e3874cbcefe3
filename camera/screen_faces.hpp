// Faces in the picture: every quantity on a plane is a ratio of two functions that are linear in the picture.
//
// With depth measured along the optical axis, 1 / depth of a plane's points is linear in u and v, and so is any affine
// function of the point divided by the depth. So depth, texture coordinates and light of a pixel are exact from three
// numbers each. Thread safety: none; one for each renderer.
#pragma once

#include <array>
#include <vector>

#include "camera/lens.hpp"
#include "camera/scene.hpp"

namespace kenaf::camera {

// A linear function of the picture's coordinates.
struct Linear {
  float at_0, per_u, per_v;
  float operator()(float u, float v) const { return at_0 + per_u * u + per_v * v; }
};

// Rays of a view: ray(u, v) = at_0 + u per_u + v per_v.
struct RayBasis {
  explicit RayBasis(const View& view);
  Eigen::Vector3d at_0, per_u, per_v;
};

struct ScreenFace {
  Linear nearness;      // 1 / depth, 1/m
  Linear s, t, facing;  // each times nearness
  Eigen::Vector3f normal_W;
  float facing_sun;  // cosine; of a mesh's triangle its own, not the smoothed one
  Material material;
  float half_s, half_t;  // as Face
  bool of_mesh;
};

class ScreenFaces {
 public:
  // Begins a new picture. `scene` must not change until the next begin().
  void begin(const Scene& scene, const View& view);
  const ScreenFace& at(FaceId id) {
    const std::uint32_t slot = slot_of_face_[id];
    return slot ? faces_[slot - 1] : add(id);
  }

 private:
  const ScreenFace& add(FaceId id);

  const Scene* scene_ = nullptr;
  Eigen::Vector3d p_WC_{0, 0, 0};
  std::array<Eigen::Vector3d, 3> basis_{};
  std::vector<std::uint32_t> slot_of_face_;  // from 1; 0: not seen yet
  std::vector<FaceId> seen_;
  std::vector<ScreenFace> faces_;
};

}  // namespace kenaf::camera
