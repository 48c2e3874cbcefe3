#include "camera/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::camera {

namespace {

constexpr std::size_t kBatch = 1024;  // rays; fits the fast caches
constexpr PixelKey kUnknown = 0xffffffff, kRequested = 0xfffffffe;
constexpr double kSmall_px = 32;
// Two triangles are one surface if their planes have the same depth at a pixel, to within this share, and the same
// brightness, to within this part of full light.
constexpr float kSameDepth = 0.01f, kSameLight = 0.03f;  // in cells of more than 4 pixels a fifth of the first

struct Corner {
  PixelKey key;
  float u, v;
};

// `nearness` is 1 / depth, affine over the picture for a plane, and facing / nearness is brightness.
bool one_surface(const ScreenFace& a, const ScreenFace& b, const Corner& at, float same_depth) {
  const float qa = a.nearness(at.u, at.v), qb = b.nearness(at.u, at.v);
  if (!(std::abs(qa - qb) <= same_depth * qb)) return false;
  return std::abs(a.facing(at.u, at.v) / qa - b.facing(at.u, at.v) / qb) <= kSameLight;
}

bool one_smooth_mesh(const std::array<Corner, 4>& corners, float same_depth, ScreenFaces& faces) {
  for (const Corner& corner : corners) {
    if (corner.key == kNothing || ((corner.key ^ corners[0].key) & kShade) != 0) return false;
    if (!faces.at(corner.key & ~kShade).of_mesh) return false;
  }
  // The planes of two opposite corners, compared with the others' at their corners.
  for (const Corner& a : {corners[0], corners[3]}) {
    for (const Corner& b : corners)
      if (a.key != b.key && !one_surface(faces.at(a.key & ~kShade), faces.at(b.key & ~kShade), b, same_depth))
        return false;
  }
  return true;
}

// Whether all corners of a cell show meshes in the light.
bool is_lit_mesh(const KeyPicture& out, int x, int y, int size, ScreenFaces& faces) {
  const PixelKey* top = out.row(y);
  const PixelKey* bottom = out.row(y + size);
  for (const PixelKey key : {top[x], top[x + size], bottom[x], bottom[x + size]})
    if (key >= kNothing || !faces.at(key).of_mesh) return false;  // keys in the shade are above kNothing
  return true;
}

// Fills the cell if its corners determine it: by their key, or on one smooth mesh each quarter by its corner's key.
bool fill(KeyPicture& out, int x, int y, int size, ScreenFaces& faces) {
  const PixelKey* top = out.row(y);
  const PixelKey* bottom = out.row(y + size);
  const std::array<PixelKey, 4> keys{top[x], top[x + size], bottom[x], bottom[x + size]};
  if (keys[0] == keys[1] && keys[0] == keys[2] && keys[0] == keys[3]) {
    for (int j = 0; j < size; ++j) std::fill_n(out.row(y + j) + x, size, keys[0]);
    return true;
  }
  const auto left = static_cast<float>(x) + 0.5f, upper = static_cast<float>(y) + 0.5f, far = static_cast<float>(size);
  if (!one_smooth_mesh({Corner{keys[0], left, upper},
                        {keys[1], left + far, upper},
                        {keys[2], left, upper + far},
                        {keys[3], left + far, upper + far}},
                       size > 4 ? kSameDepth / 5 : kSameDepth, faces))
    return false;
  for (int j = 0; j < size; ++j) {
    const std::size_t lower = 2 * j >= size ? 2 : 0;
    std::fill_n(out.row(y + j) + x, size / 2, keys[lower]);
    std::fill_n(out.row(y + j) + x + size / 2, size / 2, keys[lower + 1]);
  }
  return true;
}

}  // namespace

void Visibility::mark_small(const Scene& scene, const View& view, int cell) {
  // Cells that touch the picture of a small bounding sphere, f radius / depth in pixels, are cast pixel by pixel.
  const int rows = (view.lens.height + cell - 1) / cell;
  marked_columns_ = (view.lens.width + cell - 1) / cell;
  marked_.assign(static_cast<std::size_t>(marked_columns_) * static_cast<std::size_t>(rows), 0);
  const double f = focal_length_px(view.lens);
  const Eigen::Vector3d axis_W = view.X_WC.q * Eigen::Vector3d::UnitX();
  for (const Sphere& sphere : scene.bounds()) {
    const double depth_m = axis_W.dot(sphere.centre_W - view.X_WC.p);
    if (!(depth_m > sphere.radius_m)) continue;  // also skips a box without a finite pose
    const double radius_px = f * sphere.radius_m / depth_m;
    if (2 * radius_px > kSmall_px) continue;
    const Pixel middle = *project(view, sphere.centre_W);
    // Clamped before the cast: close to the camera's plane, positions exceed the range of an int.
    const auto first = [&](double at, int count) {
      return static_cast<int>(std::clamp((at - radius_px) / cell, 0.0, static_cast<double>(count)));
    };
    const auto last = [&](double at, int count) {
      return static_cast<int>(std::clamp((at + radius_px) / cell, -1.0, count - 1.0));
    };
    if (middle.u + radius_px < 0 || middle.v + radius_px < 0) continue;
    for (int j = first(middle.v, rows); j <= last(middle.v, rows); ++j)
      for (int i = first(middle.u, marked_columns_); i <= last(middle.u, marked_columns_); ++i)
        marked_[static_cast<std::size_t>(j * marked_columns_ + i)] = 1;
  }
}

bool Visibility::is_marked(const Cell& cell, int coarsest) const {
  return marked_[static_cast<std::size_t>(cell.y / coarsest * marked_columns_ + cell.x / coarsest)] != 0;
}

void Visibility::request(int x, int y, bool mesh_is_lit, KeyPicture& out) {
  PixelKey& key = out.row(y)[x];
  if (key != kUnknown) return;
  key = kRequested;
  requested_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), mesh_is_lit});
}

void Visibility::cast_requested(const Scene& scene, const View& view, ScreenFaces& faces, KeyPicture& out) {
  // Rays through pixel centres, (u + 0.5, v + 0.5): affine in u and v.
  const RayBasis basis(view);
  const Eigen::Vector3f from = view.X_WC.p.cast<float>();
  const Eigen::Vector3f at_0 = (basis.at_0 + 0.5 * basis.per_u + 0.5 * basis.per_v).cast<float>();
  const Eigen::Vector3f per_u = basis.per_u.cast<float>(), per_v = basis.per_v.cast<float>();

  // Batch by batch: cast, then find out about the light and enter the keys.
  for (std::size_t start = 0; start < requested_.size(); start += kBatch) {
    const std::size_t count = std::min(kBatch, requested_.size() - start);
    const Request* requests = &requested_[start];
    rays_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto u = static_cast<float>(requests[i].x), v = static_cast<float>(requests[i].y);
      rays_.from_x[i] = from.x();
      rays_.from_y[i] = from.y();
      rays_.from_z[i] = from.z();
      rays_.along_x[i] = at_0.x() + u * per_u.x() + v * per_v.x();
      rays_.along_y[i] = at_0.y() + u * per_u.y() + v * per_v.y();
      rays_.along_z[i] = at_0.z() + u * per_u.z() + v * per_v.z();
      rays_.near[i] = 0;
      rays_.far[i] = std::numeric_limits<float>::infinity();
    }
    scene.cast(rays_);
    light(scene, faces, requests, out);
    ray_count_ += count + sun_rays_.size();
  }
  requested_.clear();
}

// Enters the keys of the rays that were cast: the face, and whether it is in the shade.
void Visibility::light(const Scene& scene, ScreenFaces& faces, const Request* requests, KeyPicture& out) {
  const Eigen::Vector3f toward_sun = scene.toward_sun_W().cast<float>();
  const std::size_t count = rays_.size();
  toward_sun_of_.clear();
  sun_rays_.resize(count);

  // Faces that look away from the sun are in the shade; the others need a ray toward the sun, except on lit meshes.
  std::size_t lit = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const FaceId id = rays_.face[i];
    PixelKey& key = out.row(requests[i].y)[requests[i].x];
    key = id;
    if (id == kNothing) continue;
    const ScreenFace& face = faces.at(id);
    if (face.facing_sun <= 0) {
      key |= kShade;
      continue;
    }
    if (face.of_mesh && requests[i].mesh_is_lit) continue;
    // Start off the surface by more than the error of single precision.
    const float t = rays_.far[i], off = 0.0005f + 1e-4f * t;
    sun_rays_.from_x[lit] = rays_.from_x[i] + t * rays_.along_x[i] + off * face.normal_W.x();
    sun_rays_.from_y[lit] = rays_.from_y[i] + t * rays_.along_y[i] + off * face.normal_W.y();
    sun_rays_.from_z[lit] = rays_.from_z[i] + t * rays_.along_z[i] + off * face.normal_W.z();
    sun_rays_.along_x[lit] = toward_sun.x();
    sun_rays_.along_y[lit] = toward_sun.y();
    sun_rays_.along_z[lit] = toward_sun.z();
    sun_rays_.near[lit] = 0;
    sun_rays_.far[lit] = std::numeric_limits<float>::infinity();
    toward_sun_of_.push_back(static_cast<std::uint32_t>(i));
    ++lit;
  }

  // A hit casts a shadow.
  sun_rays_.resize(lit);
  if (lit == 0) return;
  scene.cast_any(sun_rays_);
  for (std::size_t k = 0; k < lit; ++k) {
    const Request& at = requests[toward_sun_of_[k]];
    if (sun_rays_.face[k] != kNothing) out.row(at.y)[at.x] |= kShade;
  }
}

void Visibility::find(const Scene& scene, const View& view, int coarsest, ScreenFaces& faces, KeyPicture& out) {
  const int columns = (view.lens.width + coarsest - 1) / coarsest, rows = (view.lens.height + coarsest - 1) / coarsest;
  out.stride = columns * coarsest + 1;
  out.rows = rows * coarsest + 1;
  out.keys.assign(static_cast<std::size_t>(out.stride) * static_cast<std::size_t>(out.rows), kUnknown);

  // The corners of the coarsest cells.
  ray_count_ = 0;
  if (coarsest > 1) mark_small(scene, view, coarsest);
  cells_.clear();
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      request(i * coarsest, j * coarsest, false, out);
      if (i < columns && j < rows)
        cells_.push_back({static_cast<std::int16_t>(i * coarsest), static_cast<std::int16_t>(j * coarsest)});
    }
  }
  cast_requested(scene, view, faces, out);

  // Cells that their corners do not determine are quartered; their new corners are cast together.
  for (int size = coarsest; size > 1; size /= 2) {
    const int half = size / 2;
    next_cells_.clear();
    for (const Cell& cell : cells_) {
      const int x = cell.x, y = cell.y;
      if (!is_marked(cell, coarsest) && fill(out, x, y, size, faces)) continue;
      const bool lit = is_lit_mesh(out, x, y, size, faces);
      request(x + half, y, lit, out);
      request(x, y + half, lit, out);
      request(x + half, y + half, lit, out);
      if (half == 1) continue;  // pixels have no corners
      request(x + size, y + half, lit, out);
      request(x + half, y + size, lit, out);
      for (const int dy : {0, half})
        for (const int dx : {0, half})
          next_cells_.push_back({static_cast<std::int16_t>(x + dx), static_cast<std::int16_t>(y + dy)});
    }
    cast_requested(scene, view, faces, out);
    std::swap(cells_, next_cells_);
  }
}

}  // namespace kenaf::camera
