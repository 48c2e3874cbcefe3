#include "gap/diagnose/page/moment_view.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gap/plot/chart.hpp"
#include "physics/pose.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kFromBehind_rad = 2.03, kFromAbove_rad = 0.44;  // of the eye, to the right of the robot's heading
constexpr double kMostHalfWidth_m = 3;
constexpr int kShades = 5;

struct Camera {
  Vector3d to_eye, right, up, centre;
  double scale_pxpm;
  explicit Camera(const MomentView& view)
      : to_eye(std::cos(view.elevation_rad) * std::cos(view.azimuth_rad),
               std::cos(view.elevation_rad) * std::sin(view.azimuth_rad), std::sin(view.elevation_rad)),
        right(Vector3d::UnitZ().cross(to_eye).normalized()),
        up(to_eye.cross(right)),
        centre(view.centre_W_m),
        scale_pxpm(kMomentWidth_px / 2 / view.half_width_m) {}
  double x_px(const Vector3d& p) const { return kMomentWidth_px / 2 + (p - centre).dot(right) * scale_pxpm; }
  double y_px(const Vector3d& p) const { return kMomentHeight_px / 2 - (p - centre).dot(up) * scale_pxpm; }
  double nearness_m(const Vector3d& p) const { return (p - centre).dot(to_eye); }
};

Vector3d normal_of(const Face& face) {
  // by the first corners that span an area; a belt's outline may have equal neighbours
  for (std::size_t i = 2; i < face.corners_m.size(); ++i) {
    const Vector3d n = (face.corners_m[1] - face.corners_m[0]).cross(face.corners_m[i] - face.corners_m[0]);
    if (n.norm() > 1e-12) return n.normalized();
  }
  return Vector3d::Zero();
}

Vector3d middle_of(const Face& face) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& corner : face.corners_m) sum += corner;
  return sum / static_cast<double>(face.corners_m.size());
}

std::string_view material_class(Material material) {
  constexpr std::string_view kClasses[] = {"hull", "belt", "flipper", "eye", "solid"};
  return kClasses[static_cast<std::size_t>(material)];
}

// 0 in the dark to kShades - 1 in full light, which comes from above, beside the eye.
int shade_of(const Vector3d& normal, const Camera& camera) {
  const Vector3d to_light = (0.35 * camera.right + 0.8 * camera.up + 0.5 * camera.to_eye).normalized();
  return std::clamp(static_cast<int>((0.5 + 0.5 * normal.dot(to_light)) * kShades), 0, kShades - 1);
}

std::string outline_px(const Face& face, const Camera& camera) {
  std::string path;
  for (const Vector3d& corner : face.corners_m)
    fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? "M" : "L", camera.x_px(corner),
                   camera.y_px(corner));
  return path + "z";
}

// The faces that look at the eye, far ones first.
std::string faces_svg(std::vector<Face> faces, const Camera& camera) {
  std::erase_if(faces, [&](const Face& face) { return normal_of(face).dot(camera.to_eye) <= 0; });
  std::ranges::stable_sort(faces, {}, [&](const Face& face) { return camera.nearness_m(middle_of(face)); });
  std::string svg;
  for (const Face& face : faces)
    fmt::format_to(std::back_inserter(svg), "<path class=\"{} s{}\" d=\"{}\"/>\n", material_class(face.material),
                   shade_of(normal_of(face), camera), outline_px(face, camera));
  return svg;
}

std::vector<Face> faces_at(const RobotFaces& robot, const RobotPose& pose) {
  return faces_in_pose(robot, pose.p_WB_m, pose.angles_rad, pose.flippers_rad);
}

// Millimetres, from `origin_m`.
json corners_json(const Face& face, const Vector3d& origin_m) {
  json numbers = json::array();
  for (const Vector3d& corner : face.corners_m)
    for (const double value : Vector3d(corner - origin_m)) numbers.push_back(std::lround(1000 * value));
  return numbers;
}

json faces_json(const std::vector<Face>& faces, const Vector3d& origin_m) {
  json list = json::array();
  for (const Face& face : faces) list.push_back(corners_json(face, origin_m));
  return list;
}

json robot_faces_json(const std::vector<Face>& faces) {
  json list = json::array();
  for (const Face& face : faces) {
    json corners = corners_json(face, Vector3d::Zero());
    corners.insert(corners.begin(), material_class(face.material));
    list.push_back(std::move(corners));
  }
  return list;
}

json pose_json(const RobotPose& pose, const Vector3d& origin_m) {
  json numbers = json::array();
  for (const double value : Vector3d(pose.p_WB_m - origin_m)) numbers.push_back(std::lround(1e4 * value));
  for (const double value : pose.angles_rad) numbers.push_back(std::lround(1e4 * value));
  for (const double value : pose.flippers_rad) numbers.push_back(std::lround(1e4 * value));
  return numbers;
}

}  // namespace

MomentView view_of_moment(const Moment& moment, const RobotFaces& robot) {
  // the middle between the robots, with room for all of them
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  double reach_m = 0;
  for (const MomentBody& body : moment.bodies) {
    const std::optional<RobotPose>& pose = body.poses[moment.now];
    if (!pose) continue;
    low = low.cwiseMin(pose->p_WB_m), high = high.cwiseMax(pose->p_WB_m);
    for (const Face& face : faces_at(robot, *pose))
      for (const Vector3d& corner : face.corners_m) reach_m = std::max(reach_m, (corner - pose->p_WB_m).norm());
  }
  const RobotPose& real = *moment.bodies.front().poses[moment.now];
  const double half_m = std::min(kMostHalfWidth_m, (high - low).norm() / 2 + 1.5 * reach_m);
  const bool fits = (high - low).norm() / 2 + reach_m < kMostHalfWidth_m;
  return {fits ? Vector3d((low + high) / 2) : real.p_WB_m, real.angles_rad.z() - kFromBehind_rad, kFromAbove_rad,
          half_m};
}

std::string moment_still(const Moment& moment, const RobotFaces& robot, const WorldFaces& world,
                         std::string_view title) {
  const Camera camera(view_of_moment(moment, robot));
  std::string svg = fmt::format(
      "<svg class=\"still\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{}\" width=\"{:.0f}\" "
      "height=\"{:.0f}\" viewBox=\"0 0 {:.0f} {:.0f}\">\n",
      plot::escaped(title), kMomentWidth_px, kMomentHeight_px, kMomentWidth_px, kMomentHeight_px);
  std::string ground;
  for (const Face& face : world.ground) ground += outline_px(face, camera);
  if (!ground.empty()) svg += fmt::format("<path class=\"floor\" d=\"{}\"/>\n", ground);
  svg += faces_svg(world.solids, camera);
  // the real robot last: without depth, one at the same place would colour it
  for (auto body = moment.bodies.rbegin(); body != moment.bodies.rend(); ++body)
    if (const std::optional<RobotPose>& pose = body->poses[moment.now])
      svg += fmt::format("<g class=\"{}\">\n{}</g>\n", body->kind, faces_svg(faces_at(robot, *pose), camera));
  return svg + "</svg>\n";
}

std::string robot_data(const RobotFaces& robot) {
  const Vector3d& pivot = robot.p_BPivot_m;
  return json{{"fixed", robot_faces_json(robot.fixed)},
              {"flipper", robot_faces_json(robot.flipper)},
              {"has", robot.has_flipper},
              {"pivot", {std::lround(1000 * pivot.x()), std::lround(1000 * pivot.y()), std::lround(1000 * pivot.z())}}}
      .dump();
}

std::string moment_data(const Moment& moment, const RobotFaces& robot, const WorldFaces& world) {
  const MomentView view = view_of_moment(moment, robot);
  const Vector3d origin_m = moment.bodies.front().poses[moment.now]->p_WB_m;
  const Vector3d centre_m = view.centre_W_m - origin_m;
  json data{{"from", std::round(moment.times_s.front() * 1e4) / 1e4},
            {"step", kPicture_s},
            {"now", moment.now},
            {"view",
             {{"centre", {centre_m.x(), centre_m.y(), centre_m.z()}},
              {"azimuth", view.azimuth_rad},
              {"elevation", view.elevation_rad},
              {"half", view.half_width_m}}},
            {"bodies", json::array()},
            {"solids", faces_json(world.solids, origin_m)},
            {"ground", faces_json(world.ground, origin_m)}};
  for (const MomentBody& body : moment.bodies) {
    json poses = json::array();
    for (const std::optional<RobotPose>& pose : body.poses) poses.push_back(pose ? pose_json(*pose, origin_m) : json());
    data["bodies"].push_back({{"kind", body.kind}, {"poses", std::move(poses)}});
  }
  return data.dump();
}

}  // namespace kenaf::gap::diagnose
