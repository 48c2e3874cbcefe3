#include "camera/screen_faces.hpp"

#include <cmath>

namespace kenaf::camera {

RayBasis::RayBasis(const View& view) {
  at_0 = ray(view, {0, 0});
  per_u = ray(view, {1, 0}) - at_0;
  per_v = ray(view, {0, 1}) - at_0;
}

void ScreenFaces::begin(const Scene& scene, const View& view) {
  scene_ = &scene;
  p_WC_ = view.X_WC.p;
  const RayBasis basis(view);
  basis_ = {basis.at_0, basis.per_u, basis.per_v};
  if (slot_of_face_.size() == scene.face_count()) {
    for (const FaceId id : seen_) slot_of_face_[id] = 0;
  } else {
    slot_of_face_.assign(scene.face_count(), 0);
  }
  seen_.clear();
  faces_.clear();
}

const ScreenFace& ScreenFaces::add(FaceId id) {
  const PlacedFace face = scene_->face(id);
  // From within a face's plane nothing of it is seen: the number only has to stay finite.
  constexpr double kLeast_m = 1e-6;
  double height = face.distance - face.normal_W.dot(p_WC_);
  if (std::abs(height) < kLeast_m) height = kLeast_m;

  // A ray p_WC + depth r meets the plane n . p = d where 1 / depth = n . r / height, height = d - n . p_WC: linear in
  // (u, v), since r is. For f(p) = g . p + c, f / depth = f(p_WC) / depth + g . r is linear too.
  const Eigen::Vector3d q =
      Eigen::Vector3d(face.normal_W.dot(basis_[0]), face.normal_W.dot(basis_[1]), face.normal_W.dot(basis_[2])) /
      height;
  const auto linear = [&](const Affine& f, bool whole_periods_off) {
    double here = f(p_WC_);
    if (whole_periods_off) here -= std::floor(here);
    const Eigen::Vector3d sum =
        here * q + Eigen::Vector3d(f.gradient.dot(basis_[0]), f.gradient.dot(basis_[1]), f.gradient.dot(basis_[2]));
    return Linear{static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  };
  const bool has_edges = face.half.x() > 0;
  const double own_facing = face.of_mesh ? face.normal_W.dot(scene_->toward_sun_W()) : face.facing.offset;
  faces_.push_back({.nearness = linear({{0, 0, 0}, 1}, false),
                    .s = linear(face.s, !has_edges),
                    .t = linear(face.t, !has_edges),
                    .facing = linear(face.facing, false),
                    .normal_W = face.normal_W.cast<float>(),
                    .facing_sun = static_cast<float>(own_facing),
                    .material = face.material,
                    .half_s = static_cast<float>(face.half.x()),
                    .half_t = static_cast<float>(face.half.y()),
                    .of_mesh = face.of_mesh});
  seen_.push_back(id);
  slot_of_face_[id] = static_cast<std::uint32_t>(faces_.size());
  return faces_.back();
}

}  // namespace kenaf::camera
