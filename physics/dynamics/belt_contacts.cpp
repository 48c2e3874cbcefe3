#include "physics/dynamics/belt_contacts.hpp"

#include <algorithm>
#include <array>

#include "physics/dynamics/touching.hpp"

namespace kenaf::physics {
namespace {

// Deeper inside, a face is not the one that is touched: for small and large discs, in m and in radii. The wheels of a
// heavy robot sink deeper into soft ground, and have more room for it.
constexpr btScalar kDeepest_m = 0.03, kDeepestInRadii = 0.3;
// A normal whose part in the slice's plane is shorter belongs to a wall beside the slice. Above the kSideFace of
// contact.cpp, below which a normal gives no direction along the belt: a point found in a slice always has one.
constexpr btScalar kSideways = 0.15;
constexpr btScalar kFacing = 0.9;  // least cosine between a face's normal and that of the run that faces it, reversed
// An edge or corner is touched along a combination of its faces' unit normals with coefficients of at least minus this.
constexpr btScalar kConeSlack = 0.05;
constexpr int kMeshSlices = 5, kBoxSlices = 3;

btScalar deepest_m(const BeltShape& belt) {
  return std::max(kDeepest_m, kDeepestInRadii * std::min(belt.radius[0], belt.radius[1]));
}

// A feature's number: slice and place in the low bits, the part of the ground in the high ones.
constexpr std::uint64_t feature(std::uint64_t ground, std::uint32_t slice, std::uint32_t place) {
  return ground << 12 | slice << 8 | place;
}

// Where the slices are, and the weight of the points in each.
struct Slices {
  std::array<btScalar, kMeshSlices> y, weight;
  int count;
};

Slices slices(const BeltShape& belt, int count) {
  // Evenly spaced from edge to edge, weighted by the trapezoidal rule; the weights add up to 2, as those of a plane's
  // two slices do.
  Slices s{{}, {}, count};
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    s.y[k] = belt.half_width * (2.0 * i / (count - 1) - 1);
    s.weight[k] = (i == 0 || i == count - 1 ? 1.0 : 2.0) / (count - 1);
  }
  return s;
}

// The points of the outline that can touch a face of unit normal `normal`: the lowest of each disc, and those of the
// run that faces it, at the ends of equal pieces, weighted by the trapezoidal rule; of a wheel its lowest point, with
// the weight of one piece. `use(place, run_place, point, weight)`; run_place as in BeltTouch; points have y = 0.
template <typename Use>
void outline_points(const BeltShape& belt, const btVector3& normal, const Use& use) {
  if (belt.discs() == 1) {
    use(0, -1, furthest_on_disc(belt, 0, -normal), 1.0);
    return;
  }
  const btVector3 run_normal(belt.lean, 0, normal.z() > 0 ? -belt.rise : belt.rise);
  const bool faces = -run_normal.dot(normal) >= kFacing;
  for (int disc = 0; disc < 2; ++disc)
    use(static_cast<std::uint32_t>(disc), faces ? disc * belt.pieces : -1, furthest_on_disc(belt, disc, -normal), 0.5);
  if (!faces) return;
  const btVector3 from = furthest_on_disc(belt, 0, run_normal), to = furthest_on_disc(belt, 1, run_normal);
  for (int i = 1; i < belt.pieces; ++i)
    use(static_cast<std::uint32_t>(i + 1), i, from + (to - from) * (static_cast<btScalar>(i) / belt.pieces), 1.0);
}

// Over the belt's two discs: the least and the greatest height above a plane through T's origin that the lowest point
// of a disc has, half way across. `in_plane`: length of the part of `normal` in the slices' plane.
struct LowestPoints {
  btScalar least, greatest;
};
LowestPoints lowest_points(const BeltShape& belt, const btVector3& normal, btScalar in_plane) {
  const auto [least, greatest] =
      std::minmax({-in_plane * belt.radius[0], normal.x() * belt.length - in_plane * belt.radius[1]});
  return {least, greatest};
}

// The points of the outline that stand for the belt's side face where it meets a wall: the ends of both runs, and both
// tips.
template <typename Use>
void side_face_points(const BeltShape& belt, const Use& use) {
  std::uint32_t place = 0;
  for (const btScalar up : {-1, 1})
    for (int disc = 0; disc < belt.discs(); ++disc)
      use(place++, furthest_on_disc(belt, disc, {belt.lean, 0, up * belt.rise}));
  use(place++, furthest_on_disc(belt, 0, {-1, 0, 0}));
  use(place++, furthest_on_disc(belt, 1, {1, 0, 0}));
}

// Whether `outward` lies between the normals n1 and n2 of an edge's two faces.
bool within_cone(const btVector3& outward, const btVector3& n1, const btVector3& n2) {
  // outward = a n1 + b n2, as far as it lies in their plane, with a, b >= 0. From d1 = a + b c and d2 = a c + b:
  //   a = (d1 - c d2) / (1 - c^2)      b = (d2 - c d1) / (1 - c^2)
  const btScalar c = n1.dot(n2), d1 = outward.dot(n1), d2 = outward.dot(n2), sine2 = 1 - c * c;
  if (sine2 < 1e-6) return false;
  return d1 - c * d2 >= -kConeSlack * sine2 && d2 - c * d1 >= -kConeSlack * sine2;
}

// Lugs lie across the belt: they catch nothing behind an edge that runs along it, or nearly.
bool lies_across(const btVector3& edge) {
  constexpr btScalar kNearly = 0.5;  // the cosine of 60 degrees (chosen)
  return btFabs(edge.y()) > kNearly * edge.length();
}

// Corner k of a box is on the positive side of axis j if bit j of k is set. Edge e runs along axis e / 4.
struct BoxEdge {
  int axis;
  std::size_t from, to;  // corners
  btScalar sign(int j) const { return from >> j & 1 ? 1 : -1; }
};

BoxEdge box_edge(std::uint32_t e) {
  const int axis = static_cast<int>(e / 4);
  std::size_t from = 0;
  if (e & 1) from |= std::size_t{1} << (axis + 1) % 3;
  if (e & 2) from |= std::size_t{1} << (axis + 2) % 3;
  return {axis, from, from | std::size_t{1} << axis};
}
constexpr std::uint32_t kBoxEdges = 12;

// Whether a point, relative to the box's centre, is within the box along all axes but `except` (-1: along all).
bool in_slabs(const BoxInT& box, const btVector3& from_center, int except) {
  for (int j = 0; j < 3; ++j)
    if (j != except && btFabs(box.axes.getColumn(j).dot(from_center)) > box.half[j]) return false;
  return true;
}

class BoxTouches {
 public:
  BoxTouches(const BeltShape& belt, const BoxInT& box, std::vector<BeltTouch>& out)
      : belt_(belt), box_(box), out_(out), first_(out.size()), deepest_m_(deepest_m(belt)) {}

  void find() {
    // Most boxes are far away: compare the box's half extents along T's axes, |R| half, with the belt's.
    btScalar reach[3];
    for (int k = 0; k < 3; ++k) {
      reach[k] = 0;
      for (int j = 0; j < 3; ++j) reach[k] += btFabs(box_.axes[k][j]) * box_.half[j];
    }
    const btVector3& c = box_.center;
    const auto [low, high] = bounding_box(belt_);
    if (c.x() - reach[0] > high.x() || c.x() + reach[0] < low.x() || btFabs(c.z()) > reach[2] + high.z()) return;

    // How deep the two overlap across the belt, and beside which of its side faces the box lies.
    overlap_ = std::min(belt_.half_width + c.y() + reach[1], belt_.half_width - c.y() + reach[1]);
    box_side_ = c.y() > 0 ? 1 : -1;
    if (overlap_ <= 0) return;

    // Faces, edges and corners within the belt's width.
    const Slices s = slices(belt_, kBoxSlices);
    faces(s);
    if (may_meet_edges()) {
      set_corners();
      for (std::uint32_t e = 0; e < kBoxEdges; ++e) {
        const BoxEdge edge = box_edge(e);
        if (beyond_[edge.from] & beyond_[edge.to]) continue;  // both beyond one side
        edge_in_slices(edge, e, s);
        inner_edge(edge, e, s);
      }
      corners();
    }

    // Where the shortest way out is sideways, the box is a wall beside the belt.
    if (overlap_ < deepest_m_ && overlap_ < depth_in_plane()) touch_side_face();
  }

 private:
  void add(const btVector3& p, const btVector3& normal, btScalar gap, btScalar weight, bool holds_lugs,
           std::uint64_t id, int run_place = -1) {
    // A point deeper in the slice than the overlap across it belongs to a wall that the belt's side face meets.
    if (-gap <= overlap_) out_.push_back({p, normal, gap, weight, holds_lugs, run_place, id});
  }

  // How far below a face the outline's lowest point lies, and the shallowest of those that could touch it.
  struct Depth {
    btScalar lowest, shallowest;
  };

  // Calls use(axis, sign, normal, flat, depth) for each face that is not beside the slices; `flat` is the normal's part
  // in the slices' plane, of unit length.
  template <typename Use>
  void for_each_face(Use&& use) const {
    for (int j = 0; j < 3; ++j) {
      const btVector3 axis = box_.axes.getColumn(j);
      const btScalar in_plane = btSqrt(axis.x() * axis.x() + axis.z() * axis.z());
      if (in_plane < kSideways) continue;
      const btVector3 flat(axis.x() / in_plane, 0, axis.z() / in_plane);
      const btScalar center = axis.dot(box_.center), across = btFabs(axis.y()) * belt_.half_width;
      for (const int sign : {-1, 1}) {
        const btVector3 normal = axis * sign;
        const LowestPoints points = lowest_points(belt_, normal, in_plane);
        const btScalar surface = box_.half[j] + sign * center;
        use(j, sign, normal, flat * sign,
            Depth{surface - (points.least - across), surface - (points.greatest + across)});
      }
    }
  }

  // Whether faces of two of the box's axes cut the belt's bounding box: only there an edge may pass through it.
  bool may_meet_edges() const {
    const BoundingBox belt = bounding_box(belt_);
    const btVector3 half = (belt.high - belt.low) / 2, from_center = (belt.low + belt.high) / 2 - box_.center;
    int cut = 0;
    for (int j = 0; j < 3; ++j) {
      const btVector3 axis = box_.axes.getColumn(j);
      cut += btFabs(btFabs(axis.dot(from_center)) - box_.half[j]) <= axis.absolute().dot(half);
    }
    return cut >= 2;
  }

  // Corners, and beyond which of the sides of the belt's bounding box each lies, a bit for a side.
  void set_corners() {
    const btVector3 along[3] = {box_.axes.getColumn(0) * box_.half[0], box_.axes.getColumn(1) * box_.half[1],
                                box_.axes.getColumn(2) * box_.half[2]};
    const auto [low, high] = bounding_box(belt_);
    for (std::size_t k = 0; k < corner_.size(); ++k) {
      btVector3& p = corner_[k];
      p = box_.center;
      for (std::size_t j = 0; j < 3; ++j) p = k >> j & 1 ? p + along[j] : p - along[j];
      beyond_[k] = 0;
      for (int axis = 0; axis < 3; ++axis)
        beyond_[k] |= (p[axis] < low[axis] ? 1u << 2 * axis : 0) | (p[axis] > high[axis] ? 2u << 2 * axis : 0);
    }
  }

  // The least displacement within the slices' plane that frees the belt from the box; negative: it is free.
  btScalar depth_in_plane() const {
    btScalar least = BT_LARGE_FLOAT;
    for_each_face([&](int, int, const btVector3&, const btVector3&, const Depth& depth) {
      least = std::min(least, depth.lowest);
    });
    return least;
  }

  void faces(const Slices& s) {
    for_each_face([&](int j, int sign, const btVector3& normal, const btVector3& flat, const Depth& depth) {
      if (depth.lowest < -kTouching_m || depth.shallowest > deepest_m_) return;
      const std::uint32_t face = static_cast<std::uint32_t>(2 * j + (sign > 0));
      outline_points(belt_, flat, [&](std::uint32_t place, int run_place, const btVector3& p, btScalar weight) {
        face_points(j, normal, face, s, place, run_place, p, weight);
      });
    });
  }

  // A point of the outline, in each slice. Where the face extends under the whole width, the belt's two edges carry all
  // the load, as on a plane.
  void face_points(int j, const btVector3& normal, std::uint32_t face, const Slices& s, std::uint32_t place,
                   int run_place, btVector3 p, btScalar weight) {
    const auto move_to = [&](std::size_t k) { p.setY(s.y[k]); };
    const auto gap_here = [&] { return normal.dot(p - box_.center) - box_.half[j]; };
    const auto counts = [this](btScalar gap) { return gap <= kTouching_m && gap >= -deepest_m_; };
    const auto over = [&](std::size_t k) {
      move_to(k);
      return in_slabs(box_, p - box_.center, j);
    };
    // Most points are far from most faces; the gap is cheaper to test than the position over the face.
    bool any = false;
    for (std::size_t k = 0; k < kBoxSlices; ++k) {
      move_to(k);
      any = any || counts(gap_here());
    }
    if (!any) return;
    const bool whole = over(0) && over(2);
    for (std::size_t k = 0; k < kBoxSlices; ++k) {
      if (whole ? k == 1 : !over(k)) continue;
      move_to(k);
      const btScalar gap = gap_here();
      if (!counts(gap)) continue;
      add(p - normal * (gap / 2), normal, gap, weight * (whole ? 1 : s.weight[k]), false,
          feature(face, static_cast<std::uint32_t>(k), place), run_place);
    }
  }

  // A point of an edge against the belt's outline: it touches if the outline's normal there, reversed, lies between the
  // normals of the edge's two faces.
  void edge_point(const BoxEdge& edge, const btVector3& p, btScalar weight, std::uint64_t id) {
    const OutlineDistance at = distance_to_outline(belt_, p.x(), p.z());
    if (at.distance > kTouching_m || at.distance < -deepest_m_) return;
    const int j1 = (edge.axis + 1) % 3, j2 = (edge.axis + 2) % 3;
    const btVector3 normal = -at.outward;
    if (!within_cone(normal, box_.axes.getColumn(j1) * edge.sign(j1), box_.axes.getColumn(j2) * edge.sign(j2))) return;
    add(p + at.outward * (at.distance / -2), normal, at.distance, weight,
        lies_across(corner_[edge.to] - corner_[edge.from]), id);
  }

  // The points where an edge crosses the slices.
  void edge_in_slices(const BoxEdge& edge, std::uint32_t e, const Slices& s) {
    const btVector3 &p0 = corner_[edge.from], &p1 = corner_[edge.to];
    const btScalar rise = p1.y() - p0.y();
    if (btFabs(rise) < 1e-9) return;
    for (std::size_t k = 0; k < kBoxSlices; ++k) {
      const btScalar t = (s.y[k] - p0.y()) / rise;
      if (t < 0 || t > 1) continue;
      edge_point(edge, p0 + (p1 - p0) * t, s.weight[k], feature(6 + e, static_cast<std::uint32_t>(k), 0));
    }
  }

  // Corners within the belt's width, pressed into the outline from outside of the box.
  void corners() {
    for (std::uint32_t k = 0; k < 8; ++k) {
      if (beyond_[k]) continue;
      const btVector3& p = corner_[k];
      const OutlineDistance at = distance_to_outline(belt_, p.x(), p.z());
      if (at.distance > kTouching_m || at.distance < -deepest_m_) continue;
      const btVector3 normal = -at.outward;
      bool outside = false;
      for (int j = 0; j < 3; ++j)
        outside = outside || box_.axes.getColumn(j).dot(normal) * (k >> j & 1 ? 1 : -1) < -kConeSlack;
      if (!outside) add(p + normal * (at.distance / 2), normal, at.distance, 1, true, feature(18, 0, k));
    }
  }

  // An edge that lies between two slices touches where it is deepest.
  void inner_edge(const BoxEdge& edge, std::uint32_t e, const Slices& s) {
    const btVector3 &p0 = corner_[edge.from], &p1 = corner_[edge.to];
    const btScalar low = std::min(p0.y(), p1.y()), high = std::max(p0.y(), p1.y());
    for (std::size_t k = 0; k < kBoxSlices; ++k)
      if (low <= s.y[k] && s.y[k] <= high && high - low > 1e-9) return;
    // Golden section search: along a line, the distance to a convex outline has one minimum. 24 iterations narrow
    // it down to 0.618^24 = 1e-5 of the edge's length.
    const auto distance = [&](btScalar t) {
      const btVector3 p = p0 + (p1 - p0) * t;
      return distance_to_outline(belt_, p.x(), p.z()).distance;
    };
    btScalar from = 0, to = 1;
    constexpr btScalar kGolden = 0.6180339887498949;
    btScalar a = to - kGolden * (to - from), b = from + kGolden * (to - from);
    btScalar at_a = distance(a), at_b = distance(b);
    for (int i = 0; i < 24; ++i) {
      if (at_a < at_b) {
        to = b, b = a, at_b = at_a;
        a = to - kGolden * (to - from), at_a = distance(a);
      } else {
        from = a, a = b, at_a = at_b;
        b = from + kGolden * (to - from), at_b = distance(b);
      }
    }
    edge_point(edge, p0 + (p1 - p0) * ((from + to) / 2), 1, feature(19, 0, e));
  }

  // The belt's side face against the box; replaces all contacts that were found in the slices.
  void touch_side_face() {
    out_.resize(first_);
    set_corners();

    // The normal: that of the box's face that faces the belt's side face, if it is within 32 degrees of the belt's
    // axis; else that axis.
    constexpr btScalar kFacesIt = 1 - kSideways;  // cosine
    btVector3 normal(0, -box_side_, 0);
    for (int j = 0; j < 3; ++j) {
      const btVector3 axis = box_.axes.getColumn(j);
      if (btFabs(axis.y()) > kFacesIt) normal = axis.y() * box_side_ > 0 ? -axis : axis;
    }

    // All points lie half way into the overlap and have its depth.
    const btScalar y = box_side_ * belt_.half_width;
    const auto touch = [&](const btVector3& p, std::uint32_t place) {
      out_.push_back({p, normal, -overlap_, 1, false, -1, feature(20, 0, place)});
    };

    // Points of the belt's side face within the box.
    side_face_points(belt_, [&](std::uint32_t place, btVector3 p) {
      p.setY(y - box_side_ * overlap_ / 2);
      if (in_slabs(box_, p - box_.center, -1)) touch(p, place);
    });

    // Edges of the box where they pass through the side face, within the outline.
    for (std::uint32_t e = 0; e < kBoxEdges; ++e) {
      const BoxEdge edge = box_edge(e);
      const btVector3 &p0 = corner_[edge.from], &p1 = corner_[edge.to];
      const btScalar rise = p1.y() - p0.y();
      if (btFabs(rise) < 1e-9) continue;
      const btScalar t = (y - box_side_ * overlap_ / 2 - p0.y()) / rise;
      if (t < 0 || t > 1) continue;
      const btVector3 p = p0 + (p1 - p0) * t;
      if (distance_to_outline(belt_, p.x(), p.z()).distance <= 0) touch(p, 8 + e);
    }

    // Corners of the box within the belt.
    for (std::uint32_t k = 0; k < 8; ++k) {
      const btVector3& p = corner_[k];
      if (btFabs(p.y()) <= belt_.half_width && distance_to_outline(belt_, p.x(), p.z()).distance <= 0) touch(p, 20 + k);
    }
  }

  const BeltShape& belt_;
  const BoxInT& box_;
  std::vector<BeltTouch>& out_;
  std::size_t first_;
  btScalar deepest_m_;
  std::array<btVector3, 8> corner_;
  std::array<unsigned, 8> beyond_;
  btScalar overlap_ = 0, box_side_ = 1;
};

}  // namespace

void touch_plane(const BeltShape& belt, const btVector3& normal, btScalar offset, std::vector<BeltTouch>& out) {
  const btScalar in_plane = btSqrt(normal.x() * normal.x() + normal.z() * normal.z());
  const auto touch = [&](btVector3 p, btScalar y, btScalar weight, std::uint64_t id, int run_place) {
    p.setY(y);
    const btScalar gap = normal.dot(p) - offset;
    if (gap <= kTouching_m) out.push_back({p - normal * (gap / 2), normal, gap, weight, false, run_place, id});
  };

  // A wall beside the belt meets its side face.
  if (in_plane < kSideways) {
    const btScalar y = normal.y() > 0 ? -belt.half_width : belt.half_width;
    side_face_points(belt, [&](std::uint32_t place, const btVector3& p) { touch(p, y, 1, feature(0, 2, place), -1); });
    return;
  }

  // Ground: the outline's points at both edges of the belt, if one of them can be near.
  const btScalar lowest = lowest_points(belt, normal, in_plane).least - btFabs(normal.y()) * belt.half_width;
  if (lowest - offset > kTouching_m) return;
  const btVector3 flat(normal.x() / in_plane, 0, normal.z() / in_plane);
  for (const std::uint32_t slice : {0u, 1u})
    outline_points(belt, flat, [&](std::uint32_t place, int run_place, const btVector3& p, btScalar weight) {
      touch(p, slice ? belt.half_width : -belt.half_width, weight, feature(0, slice, place), run_place);
    });
}

void touch_box(const BeltShape& belt, const BoxInT& box, std::vector<BeltTouch>& out) {
  BoxTouches(belt, box, out).find();
}

void touch_triangle(const BeltShape& belt, const TriangleInT& t, std::vector<BeltTouch>& out) {
  const btScalar deepest = deepest_m(belt);
  const btScalar in_plane = btSqrt(t.normal.x() * t.normal.x() + t.normal.z() * t.normal.z());
  const btVector3 edge[3] = {t.corner[1] - t.corner[0], t.corner[2] - t.corner[1], t.corner[0] - t.corner[2]};

  // A point of the belt touches the face if it projects into the triangle: on the inner side of all three edges,
  // (edge x (p - corner)) . n >= 0.
  const auto inside = [&](const btVector3& p) {
    for (int i = 0; i < 3; ++i)
      if (edge[i].cross(p - t.corner[i]).dot(t.normal) < 0) return false;
    return true;
  };
  const auto face = [&](const btVector3& p, btScalar weight, std::uint64_t id, int run_place) {
    const btScalar gap = t.normal.dot(p - t.corner[0]);
    if (gap <= kTouching_m && gap >= -deepest && inside(p))
      out.push_back({p - t.normal * (gap / 2), t.normal, gap, weight, false, run_place, id});
  };

  // A triangle beside the belt meets its side face.
  if (in_plane < kSideways) {
    const btScalar y = t.normal.y() > 0 ? -belt.half_width : belt.half_width;
    side_face_points(belt, [&](std::uint32_t place, btVector3 p) {
      p.setY(y);
      face(p, 1, feature(t.index, kMeshSlices, place), -1);
    });
    return;
  }

  // In a slice: the face against the outline's points, ...
  const btVector3 flat(t.normal.x() / in_plane, 0, t.normal.z() / in_plane);
  const auto in_slice = [&](btScalar y, btScalar slice_weight, std::uint32_t slice) {
    outline_points(belt, flat, [&](std::uint32_t place, int run_place, btVector3 p, btScalar weight) {
      p.setY(y);
      face(p, weight * slice_weight, feature(t.index, slice, place), run_place);
    });

    // ... and the triangle's own edges where they cross the slice, p = corner + edge (y - corner_y) / edge_y: an edge
    // touches if the outline's normal there lies between the normals of its two faces.
    for (int i = 0; i < 3; ++i) {
      if (!t.owns_edge[i] || btFabs(edge[i].y()) < 1e-9) continue;
      const btScalar along = (y - t.corner[i].y()) / edge[i].y();
      if (along < 0 || along > 1) continue;
      const btVector3 p = t.corner[i] + edge[i] * along;
      const OutlineDistance at = distance_to_outline(belt, p.x(), p.z());
      if (at.distance > kTouching_m || at.distance < -deepest ||
          !within_cone(-at.outward, t.normal, t.neighbour_normal[i]))
        continue;
      out.push_back({p - at.outward * (at.distance / 2), -at.outward, at.distance, slice_weight, lies_across(edge[i]),
                     -1, feature(t.index, slice, static_cast<std::uint32_t>(33 + i))});
    }
  };
  const Slices s = slices(belt, kMeshSlices);
  for (int k = 0; k < s.count; ++k)
    in_slice(s.y[static_cast<std::size_t>(k)], s.weight[static_cast<std::size_t>(k)], static_cast<std::uint32_t>(k));

  // A ridge that lies between two slices has a slice of its own, through each triangle's middle.
  if (!t.at_ridge) return;
  const auto [low, high] = std::minmax({t.corner[0].y(), t.corner[1].y(), t.corner[2].y()});
  for (int k = 0; k < s.count; ++k)
    if (low <= s.y[static_cast<std::size_t>(k)] && s.y[static_cast<std::size_t>(k)] <= high) return;
  const btScalar middle = (low + high) / 2;
  if (btFabs(middle) < belt.half_width) in_slice(middle, s.weight[1], kMeshSlices + 1);
}

}  // namespace kenaf::physics
