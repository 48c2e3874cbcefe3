#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

Conversation with_robot(const std::string& class_name, bool udk_dialect = false) {
  Conversation talk(fast(udk_dialect));
  talk.send("INIT {ClassName " + class_name + "} {Name R1} {Location 0,0,0}\r\n");
  return talk;
}

}  // namespace

TEST_CASE("A P2AT is told as the UT2004 server told it") {
  Conversation talk = with_robot("USARBot.P2AT");
  const std::string geometry = talk.answer_to("GETGEO {Type Robot}\r\n");
  CHECK(geometry.starts_with("GEO {Type GroundVehicle} {Name P2AT} {Dimensions "));
  CHECK(number_in(geometry, "WheelRadius") == 0.13);
  CHECK(number_in(geometry, "WheelSeparation") == 0.4712);
  CHECK(number_in(geometry, "WheelBase") == 0.2884);
  CHECK(number_in(geometry, "COG", 2) == 0.05);  // below the centre: z down is positive
  const std::string configuration = talk.answer_to("GETCONF {Type Robot}\r\n");
  CHECK(configuration.starts_with(
      "CONF {Type GroundVehicle} {Name P2AT} {SteeringType SkidSteered} {Mass 14.0000} {MaxSpeed 5.3846} {MaxTorque "));
  CHECK(configuration.ends_with("{MaxFrontSteer 0} {MaxRearSteer 0}"));
}

TEST_CASE("UDK names the robot first in CONF, and cuts digits") {
  Conversation talk = with_robot("USARBot.P2AT", true);
  // 0.7 m/s / 0.13 m = 5.38461...
  CHECK(talk.answer_to("GETCONF {Type Robot}\r\n")
            .starts_with("CONF {Name P2AT} {Type GroundVehicle} {SteeringType SkidSteered} {Mass 14.0000} "
                         "{MaxSpeed 5.3846} "));
}

TEST_CASE("Sensors are told by type, all or one by name, in each dialect's grouping") {
  Conversation talk = with_robot("USARBot.Kenaf");
  CHECK(talk.answer_to("GETGEO {Type Sonar} {Name F1}\r\n") ==
        "GEO {Type Sonar} {Name F1 Location 0.2200,0.0000,-0.0500 Orientation 0.0000,0.0000,0.0000 Mount HARD}");
  CHECK(talk.answer_to("GETCONF {Type Sonar}\r\n") ==
        "CONF {Type Sonar} {Name F1} {ScanInterval 0.1000} {MaxRange 5.0000} {MinRange 0.0500} {BeamAngle 0.3500}");
  Conversation udk = with_robot("USARBot.Kenaf", true);
  CHECK(udk.answer_to("GETGEO {Type Sonar}\r\n") ==
        "GEO {Type Sonar} {Name F1} {Location 0.2200,0.0000,-0.0500} {Orientation 0.0000,0.0000,0.0000} {Mount Kenaf}");
}

TEST_CASE("The encoder's resolution is the angle of one tick") {
  Conversation talk = with_robot("USARBot.P2AT");
  talk.send("CONTROL {Type Session} {Precision 12}\r\n");
  const std::string configuration = talk.answer_to("GETCONF {Type Encoder}\r\n");
  CHECK(configuration.starts_with("CONF {Type Encoder} {Name ECLeft} "));
  CHECK(number_in(configuration, "Resolution") == Approx(1 / 57.2957795).epsilon(1e-10));
}

TEST_CASE("A mission package tells its links") {
  Conversation talk = with_robot("USARBot.Kenaf");
  CHECK(talk.answer_to("GETCONF {Type MisPkg} {Name CameraPanTilt}\r\n")
            .starts_with("CONF {Type MisPkg} {Name CameraPanTilt} {Link 1} {JointType Revolute} {MaxSpeed "));
}

TEST_CASE("A camera's mount is told, and what turns it") {
  Conversation talk = with_robot("USARBot.Kenaf");
  CHECK(talk.answer_to("GETGEO {Type Camera}\r\n") ==
        "GEO {Type Camera} {Name Camera Location 0.2000,0.0000,-0.0900 Orientation 0.0000,0.0000,0.0000 Mount "
        "CameraPanTilt} {Name BirdsEye Location -0.2800,0.0000,-0.6200 Orientation 0.0000,-0.6500,0.0000 Mount HARD}");
  Conversation udk = with_robot("USARBot.Kenaf", true);
  CHECK(udk.answer_to("GETGEO {Type Camera} {Name Camera}\r\n") ==
        "GEO {Type Camera} {Name Camera} {Location 0.2000,0.0000,-0.0900} {Orientation 0.0000,0.0000,0.0000} {Mount "
        "CameraPanTilt}");
}

TEST_CASE("A flipper's pivot is told with y to the right") {
  Conversation talk = with_robot("USARBot.Kenaf");
  const auto p = talk.session->robot->description->flipper.front().p_BPivot_m;
  const std::string right = talk.answer_to("GETGEO {Type Joint} {Name RRFlipper}\r\n");
  CHECK(number_in(right, "Location", 0) == Approx(-p.x()));
  CHECK(number_in(right, "Location", 1) == Approx(p.y()));
  CHECK(number_in(right, "Location", 2) == Approx(-p.z()));
}

TEST_CASE("What the robot does not have is echoed, so that nobody waits for ever") {
  for (const bool udk : {false, true}) {
    Conversation talk = with_robot("USARBot.P2DX", udk);
    CHECK(talk.answer_to("GETGEO {Type Wings}\r\n") == "GEO {Type Wings}");
    CHECK(talk.answer_to("GETCONF {Type Wings} {Name Left}\r\n") == "CONF {Type Wings} {Name Left}");
    CHECK(talk.answer_to("GETCONF {Type Sonar} {Name Nobody}\r\n") == "CONF {Type Sonar} {Name Nobody}");
    CHECK(talk.answer_to("GETGEO {Type Joint}\r\n") == "GEO {Type Joint}");
    CHECK(talk.answer_to("GETGEO {Type MisPkg} {Name Arm}\r\n") == "GEO {Type MisPkg} {Name Arm}");
  }
  Conversation without_robot;
  CHECK(without_robot.answer_to("GETCONF {Type Robot}\r\n") == "CONF {Type Robot}");
}

}  // namespace kenaf::world_server
