// Descriptions of URDF files: three after public robots, and small ones. The answers are derived by hand beside them.
#include "tools/describe/from_urdf.hpp"

#include <catch2/catch.hpp>

#include "physics/robot_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/tools/describe/small_urdf.hpp"

using namespace kenaf;
using namespace kenaf::describe;
using Eigen::Vector3d;
using physics::RobotDescription;
using physics::TrackDescription;
using test::kSmallUrdf;
using test::replaced;
using test::with;

namespace {

RobotDescription described(const std::string& urdf, const FromUrdfOptions& options = {}) {
  return physics::parse_robot(from_urdf(urdf, "robot.urdf", options).toml, "robot.toml");
}

std::string test_file(const std::string& name) {
  return test::read_file(KENAF_SOURCE_DIR "/tests/tools/describe/urdf/" + name);
}

void check_near(const Vector3d& found, const Vector3d& expected, double within) {
  CAPTURE(found.transpose(), expected.transpose());
  CHECK((found - expected).cwiseAbs().maxCoeff() <= within);
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// A link on a joint, as wheels and flippers have it.
std::string turning(const std::string& name, const std::string& type, const std::string& joint,
                    const std::string& shapes) {
  return "<link name='" + name +
         "'><inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' " +
         "izz='0.01'/></inertial>" + shapes + "</link><joint name='" + name + "_j' type='" + type + "'>" +
         "<parent link='base_link'/><child link='" + name + "'/>" + joint + "</joint>";
}

}  // namespace

TEST_CASE("Four wheels: the hull's two boxes, masses of all links, and wheels on joints either way round") {
  const RobotDescription robot = described(test_file("four_wheels.urdf"));
  CHECK(robot.usarsim_class == "USARBot.Husky");
  // 46.034 + 4 x 2.637 + 0.001 kg. The boxes reach from z = 0 to 0.175625 + 0.10375 / 2 = 0.2275 m.
  CHECK(robot.body.mass_kg == Approx(56.583));
  check_near(robot.body.size_m, {0.9874, 0.5709, 0.2275}, 1e-12);
  // x: (46.034 x -0.00065 + 0.001 x 0.19) / 56.583; y: 46.034 x -0.085 / 56.583;
  // z: (46.034 x 0.062 + 10.548 x 0.03282 + 0.001 x 0.149) / 56.583 - 0.2275 / 2
  check_near(robot.body.p_BBcm_m, {-0.00052546, -0.0691531, -0.0571881}, 1e-7);
  // zz: 2.0296 + 46.034 x (0.00012454^2 + 0.0158469^2) + 4 x 0.02467
  //     + 2.637 x (4 x (0.256^2 + 0.00052546^2) + 4 x (0.2854^2 + 0.0691531^2)) = 3.7408
  CHECK(robot.body.inertia_kgm2.z() == Approx(3.7408).margin(1e-4));

  REQUIRE(robot.track.size() == 2);
  check_near(robot.track[0].p_BT_m, {0.256, 0.2854, 0.03282 - 0.11375}, 1e-12);
  check_near(robot.track[1].p_BT_m, {-0.256, 0.2854, 0.03282 - 0.11375}, 1e-12);
  CHECK(robot.track[0].end_radius_m == 0.1651);
  CHECK(robot.track[0].width_m == 0.1143);
  CHECK(robot.track[0].friction_along == 1.0);  // fdir1 is x, which the turn about x leaves
  CHECK(robot.track[0].friction_across == 0.5);
  // two wheels of 0.04411 kg m2, as felt at 0.1651 m
  CHECK(robot.drive.moving_mass_kg == Approx(2 * 0.04411 / (0.1651 * 0.1651)));
  CHECK(robot.ride_height_m() == Approx(0.13228 + 0.11375));  // base_footprint is on the ground

  REQUIRE(robot.sensors.size() == 8);
  CHECK(robot.sensors[6].type == physics::SensorType::imu);
  CHECK(robot.sensors[6].period_s == Approx(0.02));
  const physics::SensorDescription& laser = robot.sensors[7];
  CHECK(laser.type == physics::SensorType::range_scanner);
  CHECK(laser.name == "front_laser");
  check_near(laser.X_BS.p, {0.337, 0, 0.308 - 0.11375}, 1e-12);
  CHECK(laser.resolution_rad == Approx(4.71238 / 540));
}

TEST_CASE("Two tracks: the frame is moved to the hull's middle, and products of inertia are told") {
  const MadeDescription made = from_urdf(test_file("tracks.urdf"), "tracks.urdf", {});
  const RobotDescription robot = physics::parse_robot(made.toml, "tracks.toml");
  CHECK(robot.body.mass_kg == 52);
  check_near(robot.body.size_m, {0.8, 0.4, 0.2}, 1e-12);
  // the rack of 11 kg is 0.1 m before and 0.3 m above the chassis of 41 kg
  check_near(robot.body.p_BBcm_m, {1.1 / 52, 0, 3.3 / 52}, 1e-12);
  // of the two, 41 x 11 / 52 kg are 0.1 and 0.3 m apart
  const double reduced_kg = 41.0 * 11 / 52;
  check_near(robot.body.inertia_kgm2,
             {41 * (0.16 + 0.04) / 12 + 0.1 + reduced_kg * 0.09, 41 * (0.64 + 0.04) / 12 + 0.1 + reduced_kg * 0.1,
              41 * (0.64 + 0.16) / 12 + 0.1 + reduced_kg * 0.01},
             1e-8);
  CHECK_THAT(all_of(made.warnings), Catch::Contains("xz -0.26"));  // 41 x 11 / 52 x 0.1 x 0.3

  REQUIRE(robot.track.size() == 1);
  const TrackDescription& track = robot.track.front();
  CHECK(track.length_m == Approx(0.72 + 2 * 0.129));
  CHECK(track.end_radius_m == 0.129);
  CHECK(track.width_m == Approx(0.1));
  check_near(track.p_BT_m, {0, 0.26, 0.054 - 0.1}, 1e-12);
}

TEST_CASE("Flippers: angles count from straight out, whichever way an axis points and where its joint stands at 0") {
  const MadeDescription made = from_urdf(test_file("flippers.urdf"), "flippers.urdf", {});
  const RobotDescription robot = physics::parse_robot(made.toml, "flippers.toml");
  CHECK(robot.body.mass_kg == Approx(6.746 + 3.18 + 2 * 6.06));
  CHECK(robot.total_mass_kg() == Approx(6.746 + 3.18 + 2 * 6.06 + 4 * 0.75));
  REQUIRE(robot.has_flippers());
  const physics::FlipperDescription& flipper = robot.flipper.front();
  CHECK(flipper.mass_kg == 0.75);
  CHECK(flipper.length_m == Approx(0.33));
  CHECK(flipper.pivot_radius_m == 0.089);
  CHECK(flipper.tip_radius_m == 0.029);
  CHECK(flipper.width_m == Approx(0.04981));
  check_near(flipper.p_BPivot_m, {0.25, 0.1985 + 0.0735, 0.0195 - 0.118}, 1e-12);
  // at 0 the tip hangs by 0.193732; from there 1.5 up and 1.2 down
  CHECK(flipper.max_angle_rad == Approx(1.5 - 0.193732));
  CHECK(flipper.min_angle_rad == Approx(-1.2 - 0.193732));
  CHECK(robot.servo.max_speed_radps == 0.75);
  CHECK(robot.servo.max_torque_nm == 50);
  CHECK(robot.track.front().length_m == Approx(0.5 + 2 * 0.089));
  // the hull's middle is 0.0935 m behind that of the flippers
  CHECK_THAT(all_of(made.warnings), Catch::Contains("93.5 mm forward") && Catch::Contains("left_track_j"));
}

TEST_CASE("A small robot: limits of the joints are the drive's, and a ball on the ground is a caster") {
  const RobotDescription robot = described(kSmallUrdf);
  CHECK(robot.body.mass_kg == 5);
  CHECK(robot.drive.max_speed_mps == Approx(5 * 0.1));  // rad/s at a radius of 0.1 m
  CHECK(robot.drive.max_force_n == Approx(2 / 0.1));    // one wheel a side
  CHECK(robot.drive.moving_mass_kg == Approx(0.0025 / 0.01));
  REQUIRE(robot.caster.size() == 1);
  check_near(robot.caster[0].p_BC_m, {-0.15, 0, -0.07}, 1e-12);
  CHECK(robot.caster[0].radius_m == 0.03);
}

TEST_CASE("What the URDF does not say is listed by key, marked in the file, and can be given") {
  const MadeDescription made = from_urdf(kSmallUrdf, "robot.urdf", {});
  for (const char* key : {"body.friction", "wheel.friction_along", "caster.width_m", "drive.time_constant_s",
                          "drive.encoder_counts_per_radian", "battery.open_circuit_v", "usarsim_class"})
    CHECK_THAT(all_of(made.chosen), Catch::Contains(std::string(key) + " = "));
  CHECK_THAT(all_of(made.chosen), !Catch::Contains("max_speed_mps"));
  CHECK_THAT(made.toml, Catch::Contains("time_constant_s = 0.1                     # chosen\n"));
  CHECK_THAT(made.toml, Catch::Contains("max_speed_mps = 0.5                       # URDF: velocity limit\n"));

  FromUrdfOptions options;
  options.set = {"drive.time_constant_s=0.25", "wheel.friction_along=0.7"};
  options.usarsim_class = "USARBot.Mine";
  const MadeDescription given = from_urdf(kSmallUrdf, "robot.urdf", options);
  const RobotDescription robot = physics::parse_robot(given.toml, "robot.toml");
  CHECK(robot.drive.time_constant_s == 0.25);
  CHECK(robot.track.front().friction_along == 0.7);
  CHECK(robot.usarsim_class == "USARBot.Mine");
  CHECK_THAT(all_of(given.chosen), !Catch::Contains("time_constant_s") && !Catch::Contains("usarsim_class"));
}

TEST_CASE("A value that cannot be does not become a file") {
  FromUrdfOptions options;
  options.set = {"drive.max_force_n=-1"};
  CHECK_THROWS_WITH(described(kSmallUrdf, options),
                    Catch::Contains("would not load") && Catch::Contains("max_force_n"));
}

TEST_CASE("The middle of wheels that are not about base_link's y = 0 is the middle of the robot") {
  std::string urdf = replaced(kSmallUrdf, "0.1 0.2 0", "0.1 0.25 0");
  urdf = replaced(urdf, "0.1 -0.2 0", "0.1 -0.15 0");
  const MadeDescription made = from_urdf(urdf, "robot.urdf", {});
  const RobotDescription robot = physics::parse_robot(made.toml, "robot.toml");
  CHECK(robot.track.front().p_BT_m.y() == Approx(0.2));
  // 4 kg at base_link are 0.05 m right of the middle, 1 kg of wheels is in it
  CHECK(robot.body.p_BBcm_m.y() == Approx(-0.05 * 4 / 5));
  CHECK_THAT(all_of(made.warnings), Catch::Contains("50.0 mm to the left"));
}

TEST_CASE("Rollers of a side become a track where an option says so") {
  // five wheels a side of radius 0.1 m from x = -0.2 to 0.2 m
  std::string urdf = R"(<robot name="rollers"><link name="base_link"><inertial><mass value="4"/>
    <inertia ixx="0.04" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.08"/></inertial>
    <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>)";
  for (const int side : {1, -1})
    for (int i = -2; i <= 2; ++i)
      urdf += turning(
          "roller_" + std::to_string(side) + "_" + std::to_string(i), "continuous",
          "<origin xyz='" + std::to_string(0.1 * i) + " " + std::to_string(0.2 * side) + " -0.05'/><axis xyz='0 1 0'/>",
          "<collision><origin rpy='1.5707963267948966 0 0'/><geometry><cylinder radius='0.1' length='0.06'/>"
          "</geometry></collision>");
  urdf += "</robot>";
  CHECK(described(urdf).track.size() == 5);
  FromUrdfOptions options;
  options.choice.tracks = "^roller";
  const RobotDescription robot = described(urdf, options);
  REQUIRE(robot.track.size() == 1);
  CHECK(robot.track.front().length_m == Approx(0.4 + 0.2));
  CHECK(robot.track.front().end_radius_m == 0.1);
  check_near(robot.track.front().p_BT_m, {0, 0.2, -0.05}, 1e-12);
  CHECK(robot.body.mass_kg == Approx(14));
}

TEST_CASE("A track of one box has half of its height for a radius, and says so") {
  std::string urdf = R"(<robot name="boxes"><link name="base_link"><inertial><mass value="4"/>
    <inertia ixx="0.04" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.08"/></inertial>
    <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>)";
  for (const std::string side : {"left", "right"})
    urdf += "<link name='" + side +
            "_crawler'><collision><geometry><box size='0.6 0.1 0.16'/></geometry></collision></link>" +
            "<joint name='" + side + "' type='fixed'><parent link='base_link'/><child link='" + side +
            "_crawler'/><origin xyz='0 " + (side == "left" ? "0.25" : "-0.25") + " 0'/></joint>";
  const MadeDescription made = from_urdf(urdf + "</robot>", "robot.urdf", {});
  CHECK_THAT(made.toml, Catch::Contains("end_radius_m = 0.08                       # URDF: half of the height"));
  CHECK(physics::parse_robot(made.toml, "x").track.front().length_m == Approx(0.6));
}

TEST_CASE("Four arms without a name at the corners of a robot on tracks are flippers") {
  std::string urdf = test_file("flippers.urdf");
  for (std::size_t at = urdf.find("_flipper"); at != std::string::npos; at = urdf.find("_flipper"))
    urdf.replace(at, 8, "_arm");
  CHECK(described(urdf).flipper == described(test_file("flippers.urdf")).flipper);
}

TEST_CASE("A mesh counts by its corners if its file is found, and is named if it is not") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "meshes");
  // a tetrahedron from (0, 0, 0) to (2, 1, 1), of which the scale makes (0.2, 0.3, 0.1)
  test::write_file(folder / "meshes/hull.obj",
                   "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string shape =
      "<origin xyz=\"0 -0.15 0\"/><geometry><mesh filename=\"meshes/hull.obj\" scale=\"0.1 0.3 0.1\"/></geometry>";
  const std::string urdf = replaced(kSmallUrdf, "<geometry><box size=\"0.4 0.3 0.1\"/></geometry>", shape);
  FromUrdfOptions options;
  options.folders.beside = folder.path();
  check_near(described(urdf, options).body.size_m, {0.2, 0.3, 0.1}, 1e-9);

  const std::string packaged = replaced(urdf, "meshes/hull.obj", "package://small/meshes/hull.obj");
  CHECK_THROWS_WITH(described(packaged, options),
                    Catch::Contains("base_link") && Catch::Contains("--package small=FOLDER"));
  options.folders.packages["small"] = folder.path();
  check_near(described(packaged, options).body.size_m, {0.2, 0.3, 0.1}, 1e-9);
  CHECK_THROWS_WITH(described(replaced(urdf, "hull.obj", "none.obj"), options), Catch::Contains("meshes/none.obj"));
}

TEST_CASE("Small differences of mirror images are evened out with a warning, and more where an option allows it") {
  const std::string urdf = replaced(kSmallUrdf, "0.1 -0.2 0", "0.1002 -0.2 0");
  const MadeDescription made = from_urdf(urdf, "robot.urdf", {});
  CHECK(physics::parse_robot(made.toml, "x").track.front().p_BT_m.x() == Approx(0.1001));
  CHECK_THAT(all_of(made.warnings), Catch::Contains("left_wheel") && Catch::Contains("x by 0.2 mm"));
  FromUrdfOptions options;
  options.tolerance_m = 0.02;
  CHECK(described(replaced(kSmallUrdf, "0.1 -0.2 0", "0.11 -0.2 0"), options).track.front().p_BT_m.x() ==
        Approx(0.105));
}

TEST_CASE("Other joints count as fixed at 0, and swivelling wheels as casters") {
  const MadeDescription made =
      from_urdf(with(turning("lidar", "continuous", "<origin xyz='0 0 0.2'/><axis xyz='0 0 1'/>", "") +
                     turning("caster_fork", "continuous", "<origin xyz='-0.15 0 0'/><axis xyz='0 0 1'/>",
                             "<collision><origin xyz='-0.02 0 -0.06' rpy='1.5707963267948966 0 0'/><geometry>"
                             "<cylinder radius='0.04' length='0.02'/></geometry></collision>")),
                "robot.urdf", {});
  CHECK_THAT(all_of(made.warnings), Catch::Contains("\"lidar_j\"") && Catch::Contains("counts as fixed"));
  const RobotDescription robot = physics::parse_robot(made.toml, "x");
  CHECK(robot.body.mass_kg == 7);
  REQUIRE(robot.caster.size() == 2);
  check_near(robot.caster[1].p_BC_m, {-0.17, 0, -0.06}, 1e-12);
  CHECK(robot.caster[1].width_m == 0.02);
}

TEST_CASE("Wheels that are balls have a width that was chosen") {
  std::string urdf = replaced(kSmallUrdf, "<cylinder radius=\"0.1\" length=\"0.04\"/>", "<sphere radius=\"0.1\"/>");
  urdf = replaced(urdf, "<cylinder radius=\"0.1\" length=\"0.04\"/>", "<sphere radius=\"0.1\"/>");
  const MadeDescription made = from_urdf(urdf, "robot.urdf", {});
  CHECK_THAT(all_of(made.chosen), Catch::Contains("wheel.width_m = 0.05"));
}

TEST_CASE("A caster of a box is as high as the box, so that the robot stands as it did") {
  const std::string urdf = replaced(kSmallUrdf, "<sphere radius=\"0.03\"/>", "<box size=\"0.05 0.02 0.03\"/>");
  const RobotDescription robot =
      described(replaced(replaced(urdf, "\"ball\"", "\"caster\""), "link=\"ball\"", "link=\"caster\""));
  REQUIRE(robot.caster.size() == 1);
  CHECK(robot.caster[0].radius_m == Approx(0.015));
  CHECK(robot.caster[0].width_m == Approx(0.02));
}

TEST_CASE("Links chosen for the hull alone make its box") {
  const std::string mast =
      "<link name='mast'><collision><geometry><box size='0.02 0.02 1'/></geometry></collision></link>"
      "<joint name='m' type='fixed'><parent link='base_link'/><child link='mast'/></joint>";
  CHECK(described(with(mast)).body.size_m.z() == Approx(1));
  FromUrdfOptions options;
  options.choice.hull = "^base_link$";
  CHECK(described(with(mast), options).body.size_m.z() == Approx(0.1));
}
