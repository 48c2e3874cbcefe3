// Commands as clients of 2004 to 2016 send them, byte by byte. The rules are those of UDK's ParsedMessage.uc and
// SkidSteeredVehicle.uc, and of UT2004's KRobot.uc.
#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

struct Driven : Conversation {
  explicit Driven(const char* class_name, bool udk = false) : Conversation(fast(udk)) {
    send("INIT {ClassName USARBot." + std::string(class_name) + "} {Name r1} {Location 0,0,0}\r\n");
    REQUIRE(session->robot);
  }
  // rad/s of the driven wheels, as commanded
  double left_radps() { return command().track_speed_mps[robot::kLeft] / radius_m(); }
  double right_radps() { return command().track_speed_mps[robot::kRight] / radius_m(); }
  double radius_m() const { return session->robot->description->drive.sprocket_radius_m; }
};

}  // namespace

TEST_CASE("A name that is no joint's does not keep the wheels from acting") {
  for (const char* class_name : {"P3AT", "Kenaf"}) {
    INFO(class_name);
    Driven robot(class_name);
    const WholeLog log;
    robot.send("DRIVE {Name r1} {Left 1} {Right 1}\r\n");  // a driver of ROS: the robot's own name
    CHECK(robot.left_radps() == Approx(1));
    CHECK(robot.right_radps() == Approx(1));
    robot.send("DRIVE {Left 1.5} {Right -1.5} {Name somebody}\r\n");
    CHECK(robot.left_radps() == Approx(1.5));
    CHECK(robot.right_radps() == Approx(-1.5));
    robot.send("DRIVE {Name r1} {Speed 1} {FrontSteer 0}\r\n");
    CHECK(robot.right_radps() == Approx(1));
    CHECK(log.lines() == 0);
  }
}

TEST_CASE("Joints and wheels act in one line, and a name that is no joint's ends a joint's set") {
  Driven kenaf("Kenaf");
  kenaf.send("DRIVE {Name FRFlipper} {Order 0} {Value -0.25} {Left 1} {Right 2} {Name r1} {Value -1}\r\n");
  CHECK(kenaf.command().flipper[robot::kFrontRight].value == 0.25);
  CHECK(kenaf.left_radps() == Approx(1));
  CHECK(kenaf.right_radps() == Approx(2));
}

TEST_CASE("A set for a joint that the robot lacks is said in the log") {
  Driven robot("P3AT");
  const WholeLog log;
  robot.send("DRIVE {Name FRFlipper} {Order 0} {Value 1}\r\n");
  CHECK(log.lines() == 1);
  CHECK(log.has("no such joint or order: \"FRFlipper\""));
}

TEST_CASE("A number that is none, and a mission package that the robot lacks, are said in the log") {
  for (const auto& [line, words] :
       {std::pair{"DRIVE {Left fast} {Right 1}", "DRIVE: Left is not a number: \"fast\""},
        {"DRIVE {Speed nan}", "DRIVE: Speed is not a number: \"nan\""},
        {"DRIVE {LinearVelocity}", "DRIVE: LinearVelocity is not a number: \"\""},
        {"MISPKG {Name Arm} {Link 1} {Value 1}", "no such mission package on this robot: \"Arm\""}}) {
    INFO(line);
    Driven robot("P3AT");
    const WholeLog log;
    robot.send(std::string(line) + "\r\n");
    CHECK(log.lines() == 1);
    CHECK(log.has(words));
  }
}

TEST_CASE("A P3AT's client drives straight on and turns") {
  Driven robot("P3AT", GENERATE(false, true));
  robot.send("DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(robot.run(2));
  // 3 rad/s on wheels of 0.111 m: 0.333 m/s, less 0.1 s to get there
  CHECK(robot.truth().X_WB.p.x() == Approx(0.333 * 1.9).epsilon(0.03));
  robot.send("DRIVE {Left 3} {Right -3}\r\n");
  REQUIRE(robot.run(1));
  CHECK(physics::roll_pitch_yaw(robot.truth().X_WB.q).z() < -0.8);  // to the right is negative in z-up
}

TEST_CASE("A line with one odd group is obeyed in its others, and the log says once what was odd") {
  struct Case {
    const char* line;
    const char* oddity;
  };
  for (const Case& c : {Case{"DRIVE {Left 1} {Right 2", "a group without its closing brace"},
                        Case{"DRIVE {Left 1 {Right 2}", "a group without its closing brace"},
                        Case{"DRIVE {Left 1},{Right 2}", "text outside of the braces"},
                        Case{"DRIVE {Left 1}} {Right 2}", "text outside of the braces"},
                        Case{"DRIVE {Left 1} ; {Right 2", "text outside of the braces"}}) {
    INFO(c.line);
    Driven robot("P3AT");
    const WholeLog log;
    robot.send(std::string(c.line) + "\r\n");
    CHECK(robot.left_radps() == Approx(1));
    CHECK(robot.right_radps() == Approx(2));
    CHECK(log.lines() == 1);
    CHECK(log.has(c.oddity));
  }
}

TEST_CASE("A client whose every line lacks its last brace is never let go") {
  Driven robot("P3AT");
  const WholeLog log;
  for (int i = 0; i < 3000; ++i) robot.send("DRIVE {Left 1} {Right 1\r\n");
  CHECK_FALSE(robot.session->close);
  CHECK(robot.session->bad_lines == 0);
  CHECK(robot.right_radps() == Approx(1));
  CHECK(log.lines() == 1);
}

TEST_CASE("Groups beyond the 64th are obeyed") {
  Driven robot("P3AT");
  const WholeLog log;
  std::string line = "DRIVE ";
  for (int i = 0; i < 100; ++i) line += "{Note " + std::to_string(i) + "} ";
  robot.send(line + "{Left 1} {Right 2}\r\n");
  CHECK(robot.left_radps() == Approx(1));
  CHECK(robot.right_radps() == Approx(2));
  CHECK(log.lines() == 0);
}

TEST_CASE("An odd line that answers a frame takes effect when the next one begins") {
  Driven robot("P3AT");
  robot.send("CONTROL {Type Session} {Period 0.01}\r\n");
  REQUIRE(robot.run(0.001));
  robot.send("DRIVE {Left 1} {Right 2} {Frame 1\r\n");
  CHECK(robot.left_radps() == 0);
  REQUIRE(robot.run(0.01));
  CHECK(robot.left_radps() == Approx(1));
  CHECK(robot.right_radps() == Approx(2));
}

TEST_CASE("Numbers and truths are read as programs of several languages print them") {
  Driven robot("P3AT");
  const double fastest_radps = robot.session->robot->description->drive.max_speed_mps / robot.radius_m();
  robot.send("DRIVE {Left 1.0f} {Right -2.5F}\r\n");
  CHECK(robot.left_radps() == Approx(1));
  CHECK(robot.right_radps() == Approx(-2.5));
  for (const char* yes : {"t", "T", "true", "True", "\"true\"", "'1'", "y", "yes", "1", "on"}) {
    INFO(yes);
    robot.send("DRIVE {Left 50} {Right \"50\"} {Normalized " + std::string(yes) + "}\r\n");
    CHECK(robot.left_radps() == Approx(0.5 * fastest_radps));
    CHECK(robot.right_radps() == Approx(0.5 * fastest_radps));
    robot.send("DRIVE {Left 1} {Right 1} {Normalized f}\r\n");
    CHECK(robot.left_radps() == Approx(1));
  }
}

TEST_CASE("Quoted names and places are read without their quotes") {
  Conversation talk;
  talk.send("INIT {ClassName \"USARBot.P3AT\"} {Name \"my robot\"} {Location \"1.0f, 2.0f, 0f\"}\r\n");
  REQUIRE(talk.session->robot);
  CHECK(talk.session->robot->name == "my robot");
  CHECK(talk.truth().X_WB.p.x() == 1);
  CHECK(talk.truth().X_WB.p.y() == -2);
}

}  // namespace kenaf::world_server
