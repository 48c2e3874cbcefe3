#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

Conversation with_robot(bool udk_dialect = false) {
  Conversation talk(fast(udk_dialect));
  talk.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  return talk;
}

}  // namespace

TEST_CASE("SET of a joint takes the opcode by name or number, and UT2004 answers") {
  Conversation talk = with_robot();
  CHECK(talk.answer_to("SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params -0.4}\r\n") ==
        "RES {Time 0.0000} {Type Joint} {Name FRFlipper} {Status OK}");
  CHECK(talk.command().flipper[robot::kFrontRight].value == 0.4);
  talk.send("SET {Type Joint} {Name rrflipper} {Opcode 1} {Params 0.5,0}\r\n");  // the second number is a steer
  CHECK(talk.command().flipper[robot::kRearRight].mode == robot::JointMode::speed);
  CHECK(talk.command().flipper[robot::kRearRight].value == 0.5);
  talk.send("SET {Type Joint} {Name RRFlipper} {Opcode Torque} {Params 2}\r\n");
  CHECK(talk.command().flipper[robot::kRearRight].mode == robot::JointMode::torque);
  talk.send("SET {Type Joint} {Name RRFlipper} {Opcode RelAngle} {Params 0.1}\r\n");
  CHECK(talk.command().flipper[robot::kRearRight].value == Approx(talk.truth().flipper_rad[robot::kRearRight] + 0.1));
}

TEST_CASE("SET of all joints takes one angle for all, or one for each in the order of STA") {
  Conversation talk = with_robot();
  talk.send("SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params 0.1}\r\n");
  CHECK(talk.command().flipper[robot::kFrontLeft].value == -0.1);
  CHECK(talk.command().flipper[robot::kRearLeft].value == 0.1);
  talk.send("SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params -0.1,-0.2,0.3,0.4}\r\n");
  CHECK(talk.command().flipper[robot::kFrontRight].value == 0.1);
  CHECK(talk.command().flipper[robot::kFrontLeft].value == 0.2);
  CHECK(talk.command().flipper[robot::kRearRight].value == 0.3);
  CHECK(talk.command().flipper[robot::kRearLeft].value == 0.4);
}

TEST_CASE("SET of all joints by two numbers or three changes nothing and fails") {
  Conversation talk = with_robot();
  const auto before = talk.command().flipper;
  // -0,5 is a decimal comma, and so two numbers
  for (const char* params : {"-0,5", "1,2,3", "1,2,3,4,5", "1 2"}) {
    INFO(params);
    CHECK(talk.answer_to("SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params " + std::string(params) + "}\r\n") ==
          "RES {Time 0.0000} {Type Joint} {Name AllJoints} {Status Failed}");
    for (std::size_t i = 0; i < before.size(); ++i) CHECK(talk.command().flipper[i].value == before[i].value);
  }
  CHECK(talk.answer_to("SET {Type Joint} {Name AllJoints} {Opcode Brake}\r\n").ends_with("{Status OK}"));
  for (const auto& joint : talk.command().flipper) CHECK(joint.mode == robot::JointMode::brake);
}

TEST_CASE("What cannot be set fails, with a reason for a client with a Session") {
  Conversation talk = with_robot();
  talk.send("CONTROL {Type Session}\r\n");
  for (const char* line :
       {"SET {Type Joint} {Name Tail} {Opcode Angle} {Params 1}\r\n",
        "SET {Type Joint} {Name FRFlipper} {Opcode Stiffness} {Params 1}\r\n",
        "SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params x}\r\n", "SET {Type Odometry} {Opcode DANCE}\r\n",
        "SET {Type Odometry} {Name Other} {Opcode RESET}\r\n", "SET {Type Encoder} {Name Bogus} {Opcode RESET}\r\n",
        "SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params -0,5}\r\n",
        "SET {Type INS} {Opcode POSE} {Params 1,2,3}\r\n", "SET {Type Camera} {Opcode Zoom} {Params 99}\r\n",
        "SET {Type Viewports} {Opcode x}\r\n", "SET\r\n"}) {
    INFO(line);
    const std::string answer = talk.answer_to(line);
    CHECK(answer.starts_with("RES {Time 0.0000} {"));
    CHECK(answer.find("{Status Failed} {Reason ") != std::string::npos);
  }
}

TEST_CASE("UDK answers no SET") {
  Conversation talk = with_robot(true);
  CHECK(talk.answer_to("SET {Type Joint} {Name FRFlipper} {Opcode Target} {Params -0.4}\r\n").empty());
  CHECK(talk.command().flipper[robot::kFrontRight].value == 0.4);
  CHECK(talk.answer_to("SET {Type Nothing}\r\n").empty());
}

TEST_CASE("Encoders and odometry start anew, with or without their name") {
  for (const char* reset :
       {"SET {Type Encoder} {Opcode RESET}\r\n", "SET {Type Encoder} {Name ECLeft} {Opcode reset}\r\n"}) {
    INFO(reset);
    Conversation talk = with_robot();
    talk.send("DRIVE {Left 2} {Right 2}\r\n");
    REQUIRE(talk.run(1));
    CHECK(talk.lines("SEN {Type Encoder} {Name ECLeft Tick 0}").size() <= 2);
    talk.send("DRIVE {Left 0} {Right 0}\r\n");
    REQUIRE(talk.run(0.6));
    CHECK(talk.last("SEN {Type Encoder}").find("Tick 0}") == std::string::npos);
    talk.send(reset);
    REQUIRE(talk.run(0.2));
    const std::string ticks = talk.last("SEN {Type Encoder}");
    CHECK((ticks.find("{Name ECLeft Tick 0}") != std::string::npos ||
           ticks.find("{Name ECLeft Tick -1}") != std::string::npos ||
           ticks.find("{Name ECLeft Tick 1}") != std::string::npos));
  }
}

TEST_CASE("An encoder's name says which side starts anew, and one that does not exist leaves both alone") {
  Conversation talk = with_robot();
  const auto ticks = [&](const std::string& side) {
    REQUIRE(talk.run(0.2));
    const std::string line = talk.last("SEN {Type Encoder}");
    const std::size_t at = line.find("{Name " + side + " Tick ");
    REQUIRE(at != std::string::npos);
    return std::stoi(line.substr(at + 12 + side.size()));
  };
  // 2 rad/s for about a second at 318 counts a radian: some 600
  talk.send("DRIVE {Left 2} {Right 2}\r\n");
  REQUIRE(talk.run(1));
  talk.send("DRIVE {Left 0} {Right 0}\r\n");
  REQUIRE(talk.run(0.6));
  CHECK(talk.answer_to("SET {Type Encoder} {Name Bogus} {Opcode RESET}\r\n").ends_with("{Status Failed}"));
  CHECK(ticks("ECLeft") > 500);
  CHECK(talk.answer_to("SET {Type Encoder} {Name ecleft} {Opcode RESET}\r\n").ends_with("{Status OK}"));
  CHECK(std::abs(ticks("ECLeft")) <= 1);
  CHECK(ticks("ECRight") > 500);
  CHECK(talk.answer_to("SET {Type Encoder} {Name ECRight} {Opcode RESET}\r\n").ends_with("{Status OK}"));
  CHECK(std::abs(ticks("ECRight")) <= 1);
}

TEST_CASE("INS takes a pose, scanners scan by themselves") {
  Conversation talk = with_robot();
  CHECK(talk.answer_to("SET {Type INS} {Name INS} {Opcode POSE} {Params 1,2,3,0,0,0.5}\r\n") ==
        "RES {Time 0.0000} {Type INS} {Name INS} {Status OK}");
  CHECK(talk.answer_to("SET {Type RangeScanner} {Name Scanner1} {Opcode SCAN}\r\n").ends_with("{Status OK}"));
}

TEST_CASE("Cameras keep their zoom, within what they can, until a reset") {
  Conversation talk = with_robot();
  const auto angle_of = [&](const char* camera) {
    return number_in(talk.answer_to("GETCONF {Type Camera} {Name " + std::string(camera) + "}\r\n"), "CameraFov");
  };
  CHECK(talk.answer_to("GETCONF {Type Camera}\r\n") ==
        "CONF {Type Camera} {Name Camera} {CameraDefFov 1.0500} {CameraMinFov 0.1000} {CameraMaxFov 1.4000} {CameraFov "
        "1.0500} {CameraResX 640} {CameraResY 480} {Name BirdsEye} {CameraDefFov 1.4000} {CameraMinFov 1.4000} "
        "{CameraMaxFov 1.4000} {CameraFov 1.4000} {CameraResX 640} {CameraResY 480}");
  CHECK(talk.answer_to("SET {Type Camera} {Name camera} {Opcode Zoom} {Params 0.7}\r\n").ends_with("{Status OK}"));
  CHECK(angle_of("Camera") == 0.7);
  CHECK(talk.answer_to("SET {Type Camera} {Opcode FOV} {Params 0.01}\r\n").ends_with("{Status OK}"));  // all of them
  CHECK(angle_of("Camera") == 0.1);
  CHECK(angle_of("BirdsEye") == 1.4);  // has no zoom
  CHECK(talk.answer_to("SET {Type Camera} {Name Third} {Opcode Zoom} {Params 0.7}\r\n")
            .ends_with("{Name Third} {Status Failed}"));
  talk.send("CONTROL {Type Reset}\r\n");
  CHECK(angle_of("Camera") == 1.05);
}

// In a frame of x forward, y right, z down a turn about z leads from x to y, and one about y from z to x: a pan is
// positive to the right, a tilt positive up. Inside (REP 103) left and down are positive.
TEST_CASE("A camera mount turns by MISPKG and by ACT, and MISSTA tells how far") {
  Conversation talk = with_robot();
  const auto inside = [&](std::size_t link) {
    return talk.simulation.world.mission_link_rad(talk.session->robot->id, 0, link);
  };
  talk.send("MISPKG {Name CameraPanTilt} {Link 1} {Value 0.5} {Order 0} {Link 2} {Value 0.25}\r\n");
  REQUIRE(talk.run(1));
  std::string status = talk.last("MISSTA");
  CHECK(status ==
        "MISSTA {Time 1.00} {Name CameraPanTilt} {Link 1} {Value 0.5000} {Torque 0.00} {Link 2} {Value 0.2500} "
        "{Torque 0.00}");
  CHECK(inside(0) == Approx(-0.5));
  CHECK(inside(1) == Approx(-0.25));
  talk.send("ACT {Name CameraPanTilt} {Link 1} {Value -0.25} {Order 10}\r\n");  // relative
  REQUIRE(talk.run(1));
  CHECK(talk.last("MISSTA").find("{Link 1} {Value 0.2500}") != std::string::npos);
  talk.send("MISPKG {Name CameraPanTilt} {Link 7} {Value 1} {Link 0} {Value 1} {Link x} {Value 1}\r\n");
  talk.send("MISPKG {Name Arm} {Link 1} {Value 1}\r\n");
  REQUIRE(talk.run(1));
  CHECK(talk.last("MISSTA").find("{Link 1} {Value 0.2500}") != std::string::npos);
}

TEST_CASE("A link of a camera mount whose value is no number stays, the others turn, and the log says so") {
  const WholeLog log;
  Conversation talk = with_robot();
  talk.send("MISPKG {Name CameraPanTilt} {Link 1} {Value 0.5} {Link 2} {Value 0.25}\r\n");
  REQUIRE(talk.run(1));
  talk.send("MISPKG {Name CameraPanTilt} {Link 1} {Value 0.1rad} {Link 2} {Value 0.125}\r\n");
  REQUIRE(talk.run(1));
  CHECK(talk.last("MISSTA").ends_with("{Link 1} {Value 0.5000} {Torque 0.00} {Link 2} {Value 0.1250} {Torque 0.00}"));
  CHECK(log.has("MISPKG: Value is not a number: \"0.1rad\""));
}

TEST_CASE("A camera mount that is told a speed goes to that end of its range") {
  Conversation talk = with_robot();
  // up to 45 degrees, down to 90: the same limits that GETCONF tells
  const std::string tilt = talk.answer_to("GETCONF {Type MisPkg} {Name CameraPanTilt}\r\n");
  CHECK(tilt.ends_with("{MinRange -1.5708} {MaxRange 0.7854}"));
  talk.send("MISPKG {Name CameraPanTilt} {Link 2} {Value 1} {Order 1}\r\n");
  REQUIRE(talk.run(1));
  CHECK(talk.last("MISSTA").find("{Link 2} {Value 0.7854}") != std::string::npos);
}

TEST_CASE("UDK calls the mount's status ASTA") {
  Conversation talk = with_robot(true);
  REQUIRE(talk.run(0.001));
  CHECK(talk.last("ASTA") ==
        "ASTA {Time 0.0000} {Name CameraPanTilt} {Link 1} {Value 0.0000} {Torque 0.00} {Link 2} "
        "{Value 0.0000} {Torque 0.00}");
}

}  // namespace kenaf::world_server
