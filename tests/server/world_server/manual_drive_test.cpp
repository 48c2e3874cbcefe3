// Rules of manual driving, numbered as in physics/server/manual_drive.hpp. Each operator's word carries the time at
// which it was said; robot time passes when the test says.
#include "server/world_server/manual_drive.hpp"

#include <cmath>

#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

constexpr OperatorId kAnna{1}, kBen{2};

robot::Command tracks(double left_mps, double right_mps) {
  robot::Command command = standing_command();
  command.track_speed_mps = {left_mps, right_mps};
  return command;
}

struct Desk : Conversation {
  std::uint32_t robot = 0;

  Desk() {
    send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
    robot = session->id;
  }
  std::string_view say(OperatorId who, const robot::Command& command) {
    simulation.wall_s = wall_s;
    return drive_by_hand(simulation, robot, who, command);
  }
  std::string_view take(OperatorId who) {
    simulation.wall_s = wall_s;
    return take_robot(simulation, robot, who);
  }
  // Lets both times pass together, the operator repeating his word ten times a second.
  void drive(OperatorId who, const robot::Command& command, double time_s) {
    for (double t = 0; t < time_s; t += 0.1) {
      REQUIRE(say(who, command).empty());
      REQUIRE(run(0.1));
      wall_s += 0.1;
    }
  }
  double x() { return truth().X_WB.p.x(); }
  double fastest_mps() { return truth().v_WB_mps.norm(); }
};

}  // namespace

TEST_CASE("Rule 1: while an operator holds a robot, his commands count and its client's do not") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  desk.send("DRIVE {Left -5} {Right -5}\r\n");
  desk.drive(kAnna, tracks(0.3, 0.3), 1);
  // 0.3 m/s for 1 s, less what the motors need to get there: some 0.1 s
  CHECK(desk.x() == Approx(0.3).margin(0.05));
  const double flipper = desk.truth().flipper_rad[robot::kFrontRight];
  for (int i = 0; i < 5; ++i) {  // all verbs that command, after each word of the operator
    REQUIRE(desk.say(kAnna, tracks(0.3, 0.3)).empty());
    desk.send(
        "DRIVE {Left -5} {Right -5} {Flip True}\r\nMULTIDRIVE {FRFlipper 1}\r\n"
        "SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params 0}\r\n");
    REQUIRE(desk.run(0.1));
    desk.wall_s += 0.1;
  }
  CHECK(desk.x() == Approx(0.45).margin(0.05));
  CHECK(desk.truth().flipper_rad[robot::kFrontRight] == Approx(flipper).margin(0.01));
}

TEST_CASE("Rule 1: who drives too fast in the moment of taking over stands, and drives by his own word alone") {
  Desk desk;
  desk.send("DRIVE {Left 5} {Right 5}\r\n");
  REQUIRE(desk.run(1));
  REQUIRE(desk.fastest_mps() > 0.2);
  REQUIRE(desk.take(kAnna).empty());
  REQUIRE(desk.run(0.4));
  CHECK(desk.fastest_mps() < 0.01);
}

TEST_CASE("Rule 1: a robot has one holder, and the second is told so, and his commands are refused") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  CHECK(desk.take(kAnna).empty());
  CHECK_FALSE(desk.take(kBen).empty());
  CHECK_FALSE(desk.say(kBen, tracks(0.5, 0.5)).empty());
  CHECK_FALSE(let_go(desk.simulation, desk.robot, kBen).empty());
  REQUIRE(let_go(desk.simulation, desk.robot, kAnna).empty());
  CHECK(desk.take(kBen).empty());
}

TEST_CASE("Rule 1: the client is answered and sent its sensors while another drives") {
  Desk desk;
  desk.send("CONTROL {Type Session} {Period 0.01}\r\n");
  REQUIRE(desk.take(kAnna).empty());
  desk.lines();
  REQUIRE(desk.run(0.1));
  CHECK(desk.lines("STA").size() == 11);  // at 0, 0.01, ... 0.1 s
  CHECK(desk.answer_to("PING {Id 7}\r\n").starts_with("PONG {Id 7}"));
}

TEST_CASE("Rule 1: the same holds of its cameras, which turn no further than they can") {
  Desk desk;
  const auto look = [&](OperatorId who, const CameraOrder& order, std::string_view camera = "Camera") {
    return look_by_hand(desk.simulation, desk.robot, who, camera, order);
  };
  const auto link = [&](std::size_t i) {
    return desk.simulation.world.mission_link_rad(desk.session->robot->id, 0, i);
  };
  CHECK_FALSE(look(kAnna, {.pan_rad = 1, .tilt_rad = {}, .field_of_view_rad = {}}).empty());  // holds nothing yet
  REQUIRE(desk.take(kAnna).empty());
  CHECK(look(kAnna, {.pan_rad = 0.5, .tilt_rad = 9, .field_of_view_rad = 0.001}).empty());
  desk.send("MISPKG {Name CameraPanTilt} {Link 1} {Value 3}\r\nSET {Type Camera} {Opcode Zoom} {Params 1}\r\n");
  desk.drive(kAnna, tracks(0, 0), 2);
  CHECK(link(0) == Approx(0.5));
  CHECK(link(1) == Approx(1.5707963));  // straight down
  CHECK(desk.session->robot->camera_field_of_view_rad[0] == 0.1);
  CHECK(look(kAnna, {.pan_rad = {}, .tilt_rad = {}, .field_of_view_rad = 1.2}).empty());
  CHECK(desk.session->robot->camera_field_of_view_rad[0] == 1.2);
  CHECK_FALSE(look(kBen, {.pan_rad = 1, .tilt_rad = {}, .field_of_view_rad = {}}).empty());
  CHECK_FALSE(look(kAnna, {.pan_rad = 1, .tilt_rad = {}, .field_of_view_rad = {}}, "Third").empty());
  CHECK_FALSE(look(kAnna, {.pan_rad = 1, .tilt_rad = {}, .field_of_view_rad = {}}, "BirdsEye").empty());  // is fixed
}

TEST_CASE("Rule 2: an operator who says nothing for half a second of wall-clock time stands, until he speaks again") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  desk.drive(kAnna, tracks(0.3, 0.3), 0.5);
  desk.wall_s += 0.3;  // 0.4 s after his last word
  REQUIRE(desk.run(0.1));
  CHECK(desk.fastest_mps() > 0.25);
  desk.wall_s += 0.11;
  REQUIRE(desk.run(0.4));
  CHECK(desk.fastest_mps() < 0.01);
  CHECK(desk.session->hold->silent);
  desk.drive(kAnna, tracks(0.3, 0.3), 0.4);
  CHECK(desk.fastest_mps() > 0.25);
}

TEST_CASE("Rule 2: a flipper that was turning stays where it is when its operator falls silent") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  robot::Command turn = standing_command();
  turn.flipper[robot::kFrontLeft] = {robot::JointMode::speed, 1.0};
  REQUIRE(desk.say(kAnna, turn).empty());
  REQUIRE(desk.run(0.3));
  const double before = desk.truth().flipper_rad[robot::kFrontLeft];
  CHECK(before == Approx(1.0 + 0.3).margin(0.05));  // from its start angle, at 1 rad/s
  desk.wall_s += 1;
  REQUIRE(desk.run(1));
  CHECK(desk.truth().flipper_rad[robot::kFrontLeft] == Approx(before).margin(0.02));
}

TEST_CASE("Rule 3: let go of, the robot stands until its client says something new") {
  Desk desk;
  desk.send("DRIVE {Left 5} {Right 5}\r\n");
  REQUIRE(desk.take(kAnna).empty());
  desk.send("DRIVE {Left 5} {Right 5}\r\n");  // kept out, and not kept for later
  desk.drive(kAnna, tracks(-0.3, -0.3), 0.5);
  REQUIRE(let_go(desk.simulation, desk.robot, kAnna).empty());
  REQUIRE(desk.run(0.5));
  CHECK(desk.fastest_mps() < 0.01);
  const double before = desk.x();
  desk.send("DRIVE {Left 5}\r\n");  // the other side was commanded to stop
  REQUIRE(desk.run(0.5));
  CHECK(desk.truth().track_mps[robot::kLeft] > 0.3);
  CHECK(std::abs(desk.truth().track_mps[robot::kRight]) < 0.05);
  desk.send("DRIVE {Right 5}\r\n");
  REQUIRE(desk.run(0.5));
  CHECK(desk.x() > before);
}

TEST_CASE("Rule 3: a curve's parts from before are not completed by a part after it") {
  Desk desk;
  desk.send("DRIVE {Speed 5} {FrontSteer 0}\r\nDRIVE {LinearVelocity 0.4} {RotationalVelocity 0}\r\n");
  REQUIRE(desk.take(kAnna).empty());
  desk.send("DRIVE {Speed 5}\r\nDRIVE {LinearVelocity 0.4}\r\n");  // kept out, and not kept for later
  REQUIRE(let_go(desk.simulation, desk.robot, kAnna).empty());
  desk.send("DRIVE {FrontSteer 0.1}\r\n");
  CHECK(desk.command().track_speed_mps == tracks(0, 0).track_speed_mps);
  // 0.1 rad/s clockwise on the spot
  desk.send("DRIVE {RotationalVelocity 0.1}\r\n");
  CHECK(desk.command().track_speed_mps[robot::kLeft] == -desk.command().track_speed_mps[robot::kRight]);
}

TEST_CASE("Rule 3: an operator whose connection ends lets go of all that he held") {
  Desk desk;
  std::uint32_t own = 0;
  REQUIRE(place_robot_by_hand(desk.simulation, kAnna, own).empty());
  REQUIRE(desk.take(kAnna).empty());
  let_go_of_all(desk.simulation, kAnna);
  CHECK(desk.take(kBen).empty());
  CHECK(take_robot(desk.simulation, own, kBen).empty());
}

TEST_CASE("Rule 4: in an empty world an operator places a robot and drives it, and it stays when he goes") {
  Conversation talk;
  CHECK_FALSE(talk.run(0.1));  // nobody is there, time stands still
  talk.simulation.wall_s = talk.wall_s;
  std::uint32_t robot = 0;
  REQUIRE(place_robot_by_hand(talk.simulation, kAnna, robot).empty());
  Session& session = *talk.simulation.find_session(robot);
  for (int i = 0; i < 5; ++i) {
    REQUIRE(drive_by_hand(talk.simulation, robot, kAnna, tracks(0.3, 0.3)).empty());
    REQUIRE(talk.run(0.1));
    talk.wall_s += 0.1;
  }
  CHECK(talk.simulation.world.truth(session.robot->id).X_WB.p.x() > 0.1);
  CHECK(session.out.empty());  // nobody reads what a client would receive
  let_go_of_all(talk.simulation, kAnna);
  REQUIRE(talk.run(0.5));
  CHECK(talk.simulation.robot_count() == 1);
  CHECK(take_robot(talk.simulation, robot, kBen).empty());
  CHECK_FALSE(remove_placed_robot(talk.simulation, robot, kAnna).empty());
  CHECK(remove_placed_robot(talk.simulation, robot, kBen).empty());
  CHECK(talk.simulation.robot_count() == 0);
}

TEST_CASE("A robot is placed where an operator says, turned, and on top of what stands there") {
  Conversation talk;
  talk.simulation.wall_s = talk.wall_s;
  talk.simulation.world.add_box({"box", {1, 1, 0.3}, {{2, 0, 0.15}, Eigen::Quaterniond::Identity()}, 1, 0});
  std::uint32_t on_ground = 0, on_box = 0;
  const double quarter_rad = std::acos(-1) / 2;
  REQUIRE(place_robot_by_hand(talk.simulation, kAnna, on_ground, GroundPlace{{-1, 2, 0}, quarter_rad}).empty());
  REQUIRE(place_robot_by_hand(talk.simulation, kBen, on_box, GroundPlace{{2, 0, 0}, 0}).empty());
  for (int i = 0; i < 1000; ++i) talk.simulation.world.step();
  const auto pose = [&](std::uint32_t id) {
    return talk.simulation.world.truth(talk.simulation.find_session(id)->robot->id).X_WB;
  };
  // share/robots/kenaf.toml: its belly is 90 mm below its centre
  CHECK((pose(on_ground).p - Eigen::Vector3d(-1, 2, 0.09)).norm() < 2e-3);
  CHECK(physics::roll_pitch_yaw(pose(on_ground).q).z() == Approx(quarter_rad).margin(1e-3));
  CHECK((pose(on_box).p - Eigen::Vector3d(2, 0, 0.39)).norm() < 2e-3);
}

TEST_CASE("A robot is placed beside another one, and not upon it") {
  // share/robots/kenaf.toml: 0.58 m from end to end of the tracks, 0.29 m from side to side
  Conversation talk;
  talk.simulation.wall_s = talk.wall_s;
  std::uint32_t robot = 0;
  const auto placed = [&](double x_m, double y_m, double yaw_rad = 0) {
    return place_robot_by_hand(talk.simulation, kAnna, robot, GroundPlace{{x_m, y_m, 0}, yaw_rad});
  };
  REQUIRE(placed(0, 0).empty());
  CHECK(placed(0, 0) == "another robot stands there");
  CHECK(placed(0.3, 0.1) == "another robot stands there");
  CHECK(talk.simulation.robot_count() == 1);
  CHECK(placed(0, 0.6).empty());
  CHECK(placed(0.7, 0).empty());
  // 0.35 m beside it there is room, but not for one that stands across: 0.145 + 0.29 m
  CHECK(placed(0, -0.35, std::acos(-1) / 2) == "another robot stands there");
  CHECK(placed(0, -0.35).empty());
}

TEST_CASE("A client's robot cannot be removed, and one that left cannot be driven") {
  Desk desk;
  CHECK_FALSE(remove_placed_robot(desk.simulation, desk.robot, kAnna).empty());
  REQUIRE(desk.take(kAnna).empty());
  desk.simulation.disconnect(*desk.session);
  CHECK_FALSE(desk.say(kAnna, tracks(0.1, 0.1)).empty());
  CHECK_FALSE(desk.take(kAnna).empty());
  let_go_of_all(desk.simulation, kAnna);
}

TEST_CASE("Commands are limited to what the robot can do") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  robot::Command wild = tracks(1e9, -1e9);
  wild.flipper[robot::kRearLeft] = {robot::JointMode::angle, 1e9};
  wild.flipper[robot::kRearRight] = {robot::JointMode::speed, -1e9};
  REQUIRE(desk.say(kAnna, wild).empty());
  const robot::Command& held = desk.session->hold->command;
  CHECK(held.track_speed_mps[robot::kLeft] == 0.5);  // share/robots/kenaf.toml
  CHECK(held.track_speed_mps[robot::kRight] == -0.5);
  CHECK(held.flipper[robot::kRearLeft].value == Approx(3.14159265));
  CHECK(held.flipper[robot::kRearRight].value == -1.5);
}

TEST_CASE("Eight robots can be placed by hand, not more") {
  Conversation talk;
  std::uint32_t robot = 0;
  for (int i = 0; i < 8; ++i) CHECK(place_robot_by_hand(talk.simulation, kAnna, robot).empty());
  CHECK_FALSE(place_robot_by_hand(talk.simulation, kAnna, robot).empty());
}

TEST_CASE("After a reset a held robot stands at its start, and its holder drives on") {
  Desk desk;
  REQUIRE(desk.take(kAnna).empty());
  desk.drive(kAnna, tracks(0.3, 0.3), 0.5);
  desk.simulation.reset();
  REQUIRE(desk.run(0.1));
  CHECK(desk.x() == Approx(0).margin(0.005));
  desk.drive(kAnna, tracks(0.3, 0.3), 0.5);
  CHECK(desk.x() > 0.1);
}

}  // namespace kenaf::world_server
