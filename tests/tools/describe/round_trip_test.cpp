// A description, its URDF, and the description of that: what a URDF holds comes back to 1e-9.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "tests/formats/runs/temporary_folder.hpp"
#include "tools/describe/from_urdf.hpp"
#include "tools/describe/mass_properties.hpp"
#include "tools/describe/to_urdf.hpp"
#include "tools/describe/urdf_model.hpp"

using namespace kenaf;
using namespace kenaf::describe;
using physics::RobotDescription;
using physics::SensorDescription;
using physics::SensorType;

namespace {

const std::vector<std::string> kShipped{"husky", "jackal", "kenaf", "marmotte", "p2at", "p2dx", "p3at", "warthog"};

void check_same(const char* what, double found, double expected) {
  CAPTURE(what);
  CHECK(std::abs(found - expected) <= 1e-9 * std::max(1.0, std::abs(expected)));
}

void check_same(const char* what, const Eigen::Vector3d& found, const Eigen::Vector3d& expected) {
  for (int i = 0; i < 3; ++i) check_same(what, found[i], expected[i]);
}

void check_same_rolling(const RobotDescription& found, const RobotDescription& expected) {
  REQUIRE(found.track.size() == expected.track.size());
  for (std::size_t i = 0; i < found.track.size(); ++i) {
    check_same("length", found.track[i].length_m, expected.track[i].length_m);
    check_same("radius", found.track[i].end_radius_m, expected.track[i].end_radius_m);
    check_same("width", found.track[i].width_m, expected.track[i].width_m);
    check_same("place", found.track[i].p_BT_m, expected.track[i].p_BT_m);
    check_same("along", found.track[i].friction_along, expected.track[i].friction_along);
    check_same("across", found.track[i].friction_across, expected.track[i].friction_across);
  }
  REQUIRE(found.caster.size() == expected.caster.size());
  for (std::size_t i = 0; i < found.caster.size(); ++i) {
    check_same("caster", found.caster[i].p_BC_m, expected.caster[i].p_BC_m);
    check_same("caster's radius", found.caster[i].radius_m, expected.caster[i].radius_m);
    check_same("caster's width", found.caster[i].width_m, expected.caster[i].width_m);
    check_same("caster's friction", found.caster[i].friction, expected.caster[i].friction);
  }
}

void check_same_flippers(const RobotDescription& found, const RobotDescription& expected) {
  REQUIRE(found.flipper.size() == expected.flipper.size());
  if (!found.has_flippers()) return;
  const physics::FlipperDescription &a = found.flipper.front(), &b = expected.flipper.front();
  check_same("flipper's mass", a.mass_kg, b.mass_kg);
  check_same("flipper's length", a.length_m, b.length_m);
  check_same("pivot's radius", a.pivot_radius_m, b.pivot_radius_m);
  check_same("tip's radius", a.tip_radius_m, b.tip_radius_m);
  check_same("flipper's width", a.width_m, b.width_m);
  check_same("pivot", a.p_BPivot_m, b.p_BPivot_m);
  check_same("flipper along", a.friction_along, b.friction_along);
  check_same("flipper across", a.friction_across, b.friction_across);
  check_same("min angle", a.min_angle_rad, b.min_angle_rad);
  check_same("max angle", a.max_angle_rad, b.max_angle_rad);
  check_same("servo's speed", found.servo.max_speed_radps, expected.servo.max_speed_radps);
  check_same("servo's torque", found.servo.max_torque_nm, expected.servo.max_torque_nm);
}

// Those that Gazebo has too.
void check_same_sensors(const RobotDescription& found, const RobotDescription& expected) {
  for (const SensorDescription& sensor : expected.sensors) {
    if (sensor.type != SensorType::imu && sensor.type != SensorType::gps && sensor.type != SensorType::touch &&
        sensor.type != SensorType::sonar && sensor.type != SensorType::range_scanner)
      continue;
    CAPTURE(sensor.name);
    const auto other = std::ranges::find(found.sensors, sensor.name, &SensorDescription::name);
    REQUIRE(other != found.sensors.end());
    CHECK(other->type == sensor.type);
    check_same("mount", other->X_BS.p, sensor.X_BS.p);
    CHECK(other->X_BS.q.angularDistance(sensor.X_BS.q) < 1e-7);  // acos near 1 has no more
    check_same("period", other->period_s, sensor.period_s);
    check_same("min", other->min_range_m, sensor.min_range_m);
    check_same("max", other->max_range_m, sensor.max_range_m);
    check_same("field of view", other->field_of_view_rad, sensor.field_of_view_rad);
    if (sensor.type == SensorType::range_scanner)  // a scan has a whole number of rays
      CHECK(std::lround(other->field_of_view_rad / other->resolution_rad) ==
            std::lround(sensor.field_of_view_rad / sensor.resolution_rad));
  }
  REQUIRE(found.cameras.size() == expected.cameras.size());
  for (std::size_t i = 0; i < found.cameras.size(); ++i) {
    CHECK(found.cameras[i].name == expected.cameras[i].name);
    CHECK(found.cameras[i].width == expected.cameras[i].width);
    CHECK(found.cameras[i].height == expected.cameras[i].height);
    check_same("camera's field of view", found.cameras[i].field_of_view_rad, expected.cameras[i].field_of_view_rad);
    check_same("camera's rate", found.cameras[i].rate_hz, expected.cameras[i].rate_hz);
    if (!expected.cameras[i].mission_package) check_same("camera", found.cameras[i].X_BC.p, expected.cameras[i].X_BC.p);
  }
}

}  // namespace

TEST_CASE("Every shipped robot comes back from its URDF") {
  for (const std::string& name : kShipped) {
    CAPTURE(name);
    const RobotDescription robot = physics::load_robot(name);
    const MadeUrdf urdf = to_urdf(robot);
    const MadeDescription made = from_urdf(urdf.xml, name + ".urdf", {});
    const RobotDescription again = physics::parse_robot(made.toml, name + ".toml");
    CHECK(made.warnings.empty());
    check_same("mass", again.body.mass_kg, robot.body.mass_kg);
    check_same("size", again.body.size_m, robot.body.size_m);
    check_same("centre of mass", again.body.p_BBcm_m, robot.body.p_BBcm_m);
    check_same("inertia", again.body.inertia_kgm2, robot.body.inertia_kgm2);
    check_same("friction", again.body.friction, robot.body.friction);
    check_same_rolling(again, robot);
    check_same_flippers(again, robot);
    check_same_sensors(again, robot);
    if (robot.has_wheels()) {
      check_same("sprocket", again.drive.sprocket_radius_m, robot.drive.sprocket_radius_m);
      check_same("speed", again.drive.max_speed_mps, robot.drive.max_speed_mps);
      check_same("force", again.drive.max_force_n, robot.drive.max_force_n);
      const bool whole = urdf.left_out.size() == 1 || urdf.left_out.back().find("moving mass") == std::string::npos;
      if (whole) check_same("moving mass", again.drive.moving_mass_kg, robot.drive.moving_mass_kg);
      CHECK(again.drive.moving_mass_kg <= robot.drive.moving_mass_kg * (1 + 1e-9));
    }
  }
}

TEST_CASE("All links of a URDF are rigid bodies, and their masses those of the robot") {
  for (const std::string& name : kShipped) {
    CAPTURE(name);
    const RobotDescription robot = physics::load_robot(name);
    std::vector<std::string> warnings;
    const UrdfModel model = read_urdf(to_urdf(robot).xml, name + ".urdf", warnings);
    double mass_kg = 0;
    for (const Link& link : model.links) {
      CAPTURE(link.name);
      mass_kg += link.mass.mass_kg;
      if (link.mass.mass_kg > 0) CHECK(inertia_fault(link.mass.inertia_kgm2).empty());
    }
    CHECK(mass_kg == Approx(robot.total_mass_kg()));
  }
}

TEST_CASE("Wheels too heavy for the body have a part of their mass, and that is said") {
  RobotDescription robot = physics::load_robot("p2dx");
  robot.drive.moving_mass_kg = 2.5;  // two solid wheels of 5 kg, of a body of 9 kg
  const MadeUrdf urdf = to_urdf(robot);
  CHECK_THAT(urdf.left_out.back(), Catch::Contains("of the wheels' moving mass"));
  const RobotDescription again = physics::parse_robot(from_urdf(urdf.xml, "p2dx.urdf", {}).toml, "p2dx.toml");
  check_same("mass", again.body.mass_kg, 9);
  check_same("inertia", again.body.inertia_kgm2, robot.body.inertia_kgm2);
  CHECK(again.drive.moving_mass_kg < 2.5);
  robot.drive.moving_mass_kg = 1e300;  // ends all the same
  CHECK_FALSE(to_urdf(robot).xml.empty());
}

TEST_CASE("Frames: base_link is B, base_footprint is on the ground, an optical frame looks along z") {
  const RobotDescription robot = physics::load_robot("husky");
  std::vector<std::string> warnings;
  const UrdfModel model = read_urdf(to_urdf(robot).xml, "husky.urdf", warnings);
  const auto at = [&](const std::string& name) {
    const auto found = std::ranges::find(model.links, name, &Link::name);
    REQUIRE(found != model.links.end());
    return found->X_FL;
  };
  CHECK(model.base == "base_link");
  CHECK(model.links.front().name == "base_footprint");
  // wheels of 0.165 m whose centres are 0.078 m below B
  CHECK((at("base_footprint").p - Eigen::Vector3d(0, 0, -0.243)).norm() < 1e-12);
  CHECK((at("rear_right_wheel").p - Eigen::Vector3d(-0.256, -0.2775, -0.078)).norm() < 1e-12);
  CHECK((at("Scanner1").p - Eigen::Vector3d(0.337, 0, 0.197)).norm() < 1e-12);
  const Eigen::Vector3d ahead = at("Camera_optical").q * Eigen::Vector3d::UnitZ();
  CHECK((ahead - at("Camera").q * Eigen::Vector3d::UnitX()).norm() < 1e-12);
}

TEST_CASE("A flipper's positive position is tip up, in front and behind") {
  std::vector<std::string> warnings;
  const UrdfModel model = read_urdf(to_urdf(physics::load_robot("kenaf")).xml, "kenaf.urdf", warnings);
  for (const auto& [name, out] : {std::pair{"front_left_flipper", 1.0},
                                  {"front_right_flipper", 1.0},
                                  {"rear_left_flipper", -1.0},
                                  {"rear_right_flipper", -1.0}}) {
    const auto link = std::ranges::find(model.links, name, &Link::name);
    REQUIRE(link != model.links.end());
    const Eigen::Vector3d tip = Eigen::AngleAxisd(0.5, link->joint.axis_F) * Eigen::Vector3d(out, 0, 0);
    CHECK(tip.z() == Approx(std::sin(0.5)));
  }
}

TEST_CASE("Names that XML would take for its own are escaped") {
  RobotDescription robot = physics::load_robot("p2dx");
  robot.name = "a--<b>&\"-";
  robot.sensors.front().name = "<&\">";
  robot.sensors.back().name = "base_link";
  std::vector<std::string> warnings;
  const UrdfModel model = read_urdf(to_urdf(robot).xml, "odd.urdf", warnings);
  CHECK(std::ranges::find(model.links, "<&\">", &Link::name) != model.links.end());
  CHECK(std::ranges::find(model.links, "base_link_sensor", &Link::name) != model.links.end());
}

TEST_CASE("check_urdf accepts the URDF of every shipped robot") {
  if (std::string_view(KENAF_CHECK_URDF).empty()) return;  // not installed
  const test::TemporaryFolder folder;
  for (const std::string& name : kShipped) {
    CAPTURE(name);
    test::write_file(folder / "robot.urdf", to_urdf(physics::load_robot(name)).xml);
    CHECK(std::system(("'" KENAF_CHECK_URDF "' '" + (folder / "robot.urdf").string() + "' >'" +
                       (folder / "out.txt").string() + "' 2>&1")
                          .c_str()) == 0);
    CHECK_THAT(test::read_file(folder / "out.txt"), Catch::Contains("Successfully Parsed"));
  }
}
