#include "gap/diagnose/page/shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/pose.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Vector3d;

constexpr int kArcSteps = 6;  // of half a circle
constexpr double kGroundSquare_m = 0.5;

std::vector<Face> box_faces(const Vector3d& centre_m, const Vector3d& size_m, Material material) {
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      // the other two axes, so that the corners turn counterclockwise seen from outside
      Vector3d u = Vector3d::Zero(), v = Vector3d::Zero(), n = Vector3d::Zero();
      n[axis] = side * size_m[axis] / 2;
      u[(axis + 1) % 3] = size_m[(axis + 1) % 3] / 2;
      v[(axis + 2) % 3] = side * size_m[(axis + 2) % 3] / 2;
      faces.push_back(
          {{centre_m + n - u - v, centre_m + n + u - v, centre_m + n + u + v, centre_m + n - u + v}, material});
    }
  return faces;
}

// A belt around a disc of radius r0 at the origin and one of r1 at x = length, as wide as `width_m` along y.
std::vector<Face> belt_faces(double length_m, double r0_m, double r1_m, double width_m, const Vector3d& at_m,
                             Material material) {
  // the outline in x and z, counterclockwise seen from -y
  std::vector<Eigen::Vector2d> outline;
  const double lean = length_m > 0 ? std::acos(std::clamp((r0_m - r1_m) / length_m, -1.0, 1.0)) : std::numbers::pi / 2;
  const auto arc = [&](double x_m, double r_m, double from, double to) {
    for (int i = 0; i <= kArcSteps; ++i) {
      const double angle = from + (to - from) * i / kArcSteps;
      outline.emplace_back(x_m + r_m * std::cos(angle), r_m * std::sin(angle));
    }
  };
  arc(length_m, r1_m, -lean, lean);
  arc(0, r0_m, lean, 2 * std::numbers::pi - lean);

  // its two sides, then the belt around them
  std::vector<Face> faces(2);
  const auto at = [&](const Eigen::Vector2d& p, double side) -> Vector3d {
    return at_m + Vector3d(p.x(), side * width_m / 2, p.y());
  };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    faces[0].corners_m.push_back(at(outline[i], -1));
    faces[1].corners_m.push_back(at(outline[outline.size() - 1 - i], 1));
    const Eigen::Vector2d &p = outline[i], &next = outline[(i + 1) % outline.size()];
    if ((p - next).norm() < 1e-6) continue;
    faces.push_back({{at(p, 1), at(next, 1), at(next, -1), at(p, -1)}, material});
  }
  for (Face& face : faces) face.material = material;
  return faces;
}

template <typename Transform>
void add_moved(std::vector<Face>& to, const std::vector<Face>& faces, const Transform& transform) {
  for (const Face& face : faces) {
    to.push_back(face);
    for (Vector3d& corner : to.back().corners_m) corner = transform(corner);
  }
}

double distance_to_m(const Face& face, const Vector3d& p_m) {
  Vector3d low = face.corners_m.front(), high = low;
  for (const Vector3d& corner : face.corners_m) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  return (p_m - p_m.cwiseMax(low).cwiseMin(high)).norm();
}

}  // namespace

RobotFaces faces_of(const physics::RobotDimensions& size) {
  RobotFaces robot;
  // hull with a deck that ends in front, and a light eye, so that one sees where it looks
  const Vector3d& body = size.body_size_m;
  robot.fixed = box_faces(Vector3d::Zero(), body, Material::hull);
  const auto add = [&](const std::vector<Face>& faces) {
    robot.fixed.insert(robot.fixed.end(), faces.begin(), faces.end());
  };
  add(box_faces({0.42 * body.x(), 0, body.z() / 2 + 0.02}, {0.05, 0.7 * body.y(), 0.04}, Material::eye));

  // tracks or wheels of both sides, casters
  const auto add_belt = [&](const physics::BeltDimensions& belt, double side) {
    const double runs_m = belt.length_m - 2 * belt.radius_m;
    const Vector3d at(belt.p_B_m.x() - runs_m / 2, side * belt.p_B_m.y(), belt.p_B_m.z());
    add(belt_faces(runs_m, belt.radius_m, belt.radius_m, belt.width_m, at, Material::belt));
  };
  for (const physics::BeltDimensions& track : size.tracks)
    for (const double side : {1.0, -1.0}) add_belt(track, side);
  for (const physics::BeltDimensions& caster : size.casters) add_belt(caster, 1);

  robot.has_flipper = size.has_flipper;
  if (size.has_flippers())
    robot.flipper = belt_faces(size.flipper_length_m, size.pivot_radius_m, size.tip_radius_m, size.flipper_width_m,
                               Vector3d::Zero(), Material::flipper);
  robot.p_BPivot_m = size.p_BPivot_m;
  return robot;
}

std::vector<Face> faces_in_pose(const RobotFaces& robot, const Vector3d& p_WB_m, const Vector3d& angles_rad,
                                const std::array<double, 4>& flippers_rad) {
  std::vector<Face> in_body = robot.fixed;
  for (std::size_t i = 0; i < flippers_rad.size(); ++i) {
    if (!robot.has_flipper[i]) continue;
    const double ahead = i < 2 ? 1 : -1, left = i % 2 == 0 ? 1 : -1;
    const Vector3d pivot(ahead * robot.p_BPivot_m.x(), left * robot.p_BPivot_m.y(), robot.p_BPivot_m.z());
    const Eigen::Quaterniond raised(Eigen::AngleAxisd(ahead < 0 ? std::numbers::pi : 0, Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-flippers_rad[i], Vector3d::UnitY()));
    add_moved(in_body, robot.flipper, [&](const Vector3d& p) -> Vector3d { return pivot + raised * p; });
  }
  std::vector<Face> in_world;
  const Eigen::Quaterniond q_WB = physics::rotation_from(angles_rad);
  add_moved(in_world, in_body, [&](const Vector3d& p) -> Vector3d { return p_WB_m + q_WB * p; });
  return in_world;
}

WorldFaces faces_near(const physics::WorldDescription& world, const Vector3d& p_W_m, double radius_m,
                      std::size_t most) {
  WorldFaces near;
  const auto add = [&](std::vector<Face>& to, Face face) {
    if (distance_to_m(face, p_W_m) <= radius_m) to.push_back(std::move(face));
  };

  // level ground as squares, so that one sees how far the robot drives
  for (const physics::GroundPlane& plane : world.planes) {
    const Vector3d centre = plane.X_WP.q.conjugate() * (p_W_m - plane.X_WP.p);
    const double from_x = std::floor((centre.x() - radius_m) / kGroundSquare_m) * kGroundSquare_m,
                 from_y = std::floor((centre.y() - radius_m) / kGroundSquare_m) * kGroundSquare_m;
    const int squares = static_cast<int>(std::ceil(2 * radius_m / kGroundSquare_m)) + 1;
    const auto at = [&](int i, int j) -> Vector3d {
      return plane.X_WP.p + plane.X_WP.q * Vector3d(from_x + i * kGroundSquare_m, from_y + j * kGroundSquare_m, 0);
    };
    for (int i = 0; i < squares; ++i)
      for (int j = 0; j < squares; ++j)
        add(near.ground, {{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, Material::solid});
  }

  for (const physics::Box& box : world.boxes) {
    if (box.mass_kg > 0) continue;  // pushed boxes are not recorded
    for (Face& face : box_faces(Vector3d::Zero(), box.size_m, Material::solid)) {
      for (Vector3d& corner : face.corners_m) corner = box.X_WBox.p + box.X_WBox.q * corner;
      add(near.solids, std::move(face));
    }
  }
  std::vector<Face> of_meshes;
  for (const physics::TriangleMesh& mesh : world.meshes)
    for (const auto& [a, b, c] : mesh.triangles)
      add(of_meshes, {{mesh.vertices_W[a], mesh.vertices_W[b], mesh.vertices_W[c]}, Material::solid});
  std::ranges::sort(of_meshes, {}, [&](const Face& face) { return distance_to_m(face, p_W_m); });
  if (of_meshes.size() > most) {
    of_meshes.resize(most);
    near.is_whole = false;
  }
  near.solids.insert(near.solids.end(), of_meshes.begin(), of_meshes.end());
  return near;
}

}  // namespace kenaf::gap::diagnose
