// From USARSim's lines to a State. Signs by hand: USARSim's y points right and its z down, so y and z, pitch and yaw
// change sign; x and roll stay.
#include "relayd/sensor_transform.hpp"
#include "robot/state.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <numbers>

using namespace kenaf;
using namespace kenaf::relayd;

namespace {

bool take(SensorTransform& transform, std::string_view line) {
  protocol::usarsim::MessageView message;
  REQUIRE(protocol::usarsim::parse_message(line, message) == protocol::usarsim::ParseError::none);
  return transform.take(message);
}

robot::State after(std::initializer_list<std::string_view> lines) {
  SensorTransform transform;
  for (const std::string_view line : lines) CHECK_FALSE(take(transform, line));
  CHECK(take(transform, "STA {Type GroundVehicle} {Time 1.5}"));
  return transform.frame().state;
}

}  // namespace

TEST_CASE("Ground truth: a robot 0.1 m above the ground, 2 m to the left, turned left, nose down, right side down") {
  const auto state =
      after({"SEN {Time 1} {Type GroundTruth} {Name G} {Location 1,-2,-0.1} {Orientation 0.1,-0.2,-0.3}"});
  CHECK(state.fields == robot::kHasGroundTruth);
  CHECK(state.p_WB_m == std::array<double, 3>{1, 2, 0.1});
  CHECK(state.orientation_rad[0] == Approx(0.1));
  CHECK(state.orientation_rad[1] == Approx(0.2));
  CHECK(state.orientation_rad[2] == Approx(0.3));
  CHECK(state.robot_time_s == 1.5);
}

TEST_CASE("UT2004 angles from 0 to 2 pi come out from -pi to pi") {
  // 6.1831853 = 2 pi - 0.1: 0.1 to the left.
  const auto state = after({"SEN {Type INS} {Name INS} {Location 0,0,0} {Orientation 0,0.2,6.183185307}"});
  CHECK(state.fields == robot::kHasPosture);
  CHECK(state.posture_rad[1] == Approx(-0.2));
  CHECK(state.posture_rad[2] == Approx(0.1));
}

TEST_CASE("The posture is the INS's where there is one, else the IMU's") {
  const std::string_view imu =
      "SEN {Time 1} {Type IMU} {Name I} {XYZAcceleration 0.5,-1,-9.8} {AngularVel 0.1,0.2,-0.3} {AngularAccel 0,0,0} "
      "{Rotation 0.01,0.02,0.03}";
  const auto alone = after({imu});
  CHECK(alone.fields == (robot::kHasPosture | robot::kHasInertial));
  CHECK(alone.posture_rad == std::array<double, 3>{0.01, -0.02, -0.03});
  CHECK(alone.acceleration_mps2 == std::array<double, 3>{0.5, 1, 9.8});  // at rest +g on z
  CHECK(alone.gyro_radps == std::array<double, 3>{0.1, -0.2, 0.3});      // turning left is positive

  const auto both = after({"SEN {Type INS} {Orientation 0.5,0,0}", imu});
  CHECK(both.posture_rad[0] == 0.5);
  CHECK(both.gyro_radps[2] == 0.3);
}

TEST_CASE("Encoders: ticks x resolution x wheel radius, in both dialects") {
  // 1000 ticks x 0.002 rad x 0.05 m = 0.1 m.
  const auto ut2004 = after({"GEO {Type GroundVehicle} {Name Kenaf} {WheelRadius 0.05}",
                             "CONF {Type Encoder} {Name ECLeft} {Resolution 0.002} {Name ECRight} {Resolution 0.002}",
                             "SEN {Type Encoder} {Name ECLeft Tick 1000} {Name ECRight Tick -500}"});
  CHECK(ut2004.fields == robot::kHasEncoders);
  CHECK(ut2004.track_m[robot::kLeft] == Approx(0.1));
  CHECK(ut2004.track_m[robot::kRight] == Approx(-0.05));
  const auto udk = after({"SEN {Time 1} {Type Encoder} {Name ECLeft} {Tick 1000}",
                          "SEN {Time 1} {Type Encoder} {Name ECRight} {Tick -500}", "GEO {WheelRadius 0.05}",
                          "CONF {Type Encoder} {Resolution 0.002}"});  // late is early enough
  CHECK(udk.track_m == ut2004.track_m);
}

TEST_CASE("One side's encoder is not both") {
  CHECK(after({"SEN {Type Encoder} {Name ECLeft Tick 1000}"}).fields == 0);
}

TEST_CASE("Track speed: the tachometer's, else the change of travel by robot time") {
  SensorTransform transform;
  take(transform, "GEO {WheelRadius 0.05}");
  take(transform, "CONF {Type Encoder} {Resolution 0.001}");
  take(transform, "SEN {Type Encoder} {Name ECLeft Tick 0} {Name ECRight Tick 0}");
  take(transform, "STA {Time 1.0}");
  CHECK(transform.frame().state.track_mps == std::array<double, 2>{0, 0});
  take(transform, "SEN {Type Encoder} {Name ECLeft Tick 400} {Name ECRight Tick -200}");
  take(transform, "STA {Time 1.1}");
  // 400 x 0.001 x 0.05 m in 0.1 s = 0.2 m/s.
  CHECK(transform.frame().state.track_mps[0] == Approx(0.2));
  CHECK(transform.frame().state.track_mps[1] == Approx(-0.1));
  CHECK(transform.frame().interval_s == Approx(0.1));
  take(transform, "SEN {Time 1.2} {Type Tachometer} {Name T} {Vel 6,-8} {Pos 0,0}");
  take(transform, "STA {Time 1.2}");
  CHECK(transform.frame().state.track_mps[0] == Approx(0.3));
  CHECK(transform.frame().state.track_mps[1] == Approx(-0.4));
}

TEST_CASE("Flippers: as STA reports them, tip up positive for all four") {
  SensorTransform transform;
  take(transform, "STA {Time 1} {FRFlipper -0.2} {FLFlipper -0.1} {RRFlipper 0.4} {RLFlipper 0.3}");
  CHECK(transform.frame().state.fields == robot::kHasFlippers);
  CHECK(transform.frame().state.flipper_rad == std::array<double, 4>{0.1, 0.2, 0.3, 0.4});
  SensorTransform three;
  take(three, "STA {Time 1} {FRFlipper -0.2} {FLFlipper -0.1} {RRFlipper 0.4}");
  CHECK(three.frame().state.fields == 0);
}

TEST_CASE("A robot with one pair of flippers has these, and none elsewhere") {
  SensorTransform front, rear;
  take(front, "STA {Time 1} {FRFlipper -0.2} {FLFlipper -0.1}");
  CHECK(front.frame().state.fields == robot::kHasFlippers);
  CHECK(front.frame().state.flipper_rad[robot::kFrontLeft] == 0.1);
  CHECK(front.frame().state.flipper_rad[robot::kFrontRight] == 0.2);
  CHECK(std::isnan(front.frame().state.flipper_rad[robot::kRearLeft]));
  CHECK(std::isnan(front.frame().state.flipper_rad[robot::kRearRight]));
  take(rear, "STA {Time 1} {RRFlipper 0.4} {RLFlipper 0.3}");
  CHECK(rear.frame().state.fields == robot::kHasFlippers);
  CHECK(std::isnan(rear.frame().state.flipper_rad[robot::kFrontLeft]));
  CHECK(rear.frame().state.flipper_rad[robot::kRearLeft] == 0.3);
}

TEST_CASE("Currents and battery are those that the drives report") {
  const auto state = after(
      {"SEN {Time 1} {Type Drives} {Name Drives} {TrackCurrent 1,2} {FlipperCurrent 3,4,5,6} {BatteryVoltage 24.5}"});
  CHECK(state.fields == (robot::kHasCurrents | robot::kHasBattery));
  CHECK(state.track_a == std::array<double, 2>{1, 2});
  CHECK(state.flipper_a == std::array<double, 4>{3, 4, 5, 6});
  CHECK(state.battery_v == 24.5);
}

TEST_CASE("STA counts frames, without a number the relay counts") {
  SensorTransform transform;
  take(transform, "STA {Time 2.0} {Frame 41} {Late 3} {Silent True} {Paused True}");
  CHECK(transform.frame().number == 41);
  CHECK(transform.frame().numbered);
  CHECK(transform.frame().state.late_commands == 3);
  CHECK(transform.frame().state.stopped_by_silence);
  CHECK(transform.frame().paused);
  take(transform, "STA {Time 2.2}");
  CHECK(transform.frame().number == 42);
  CHECK_FALSE(transform.frame().numbered);
  CHECK_FALSE(transform.frame().state.stopped_by_silence);
  CHECK_FALSE(transform.frame().paused);
}

TEST_CASE("What was not measured since the STA before holds, and is marked as held") {
  SensorTransform transform;
  const auto fields_after = [&](std::initializer_list<std::string_view> lines) {
    for (const std::string_view line : lines) take(transform, line);
    return transform.frame().state.fields;
  };
  const std::string_view ins = "SEN {Type INS} {Orientation 0,0,-0.3}",
                         drives = "SEN {Type Drives} {BatteryVoltage 24}";
  CHECK(fields_after({ins, drives, "STA {Time 1.0} {Frame 1}"}) == (robot::kHasPosture | robot::kHasBattery));
  CHECK(fields_after({ins, "STA {Time 1.01} {Frame 2}"}) ==
        (robot::kHasPosture | robot::kHasBattery | robot::held(robot::kHasBattery)));
  // the same frame again, as the world was paused: its posture is as new as it was
  CHECK(fields_after({"STA {Time 1.01} {Frame 2} {Paused True}"}) ==
        (robot::kHasPosture | robot::kHasBattery | robot::held(robot::kHasBattery)));
  CHECK(fields_after({"STA {Time 1.02} {Frame 3}"}) ==
        (robot::kHasPosture | robot::kHasBattery | robot::held(robot::kHasPosture | robot::kHasBattery)));
  CHECK(transform.frame().state.posture_rad[2] == Approx(0.3));
  CHECK(fields_after({ins, drives, "STA {Time 1.03} {Frame 4}"}) == (robot::kHasPosture | robot::kHasBattery));
}

TEST_CASE("Encoders slower than STA: the speed is the change of travel by the time between two of their words") {
  SensorTransform transform;
  take(transform, "GEO {WheelRadius 0.05}");
  take(transform, "CONF {Type Encoder} {Resolution 0.001}");
  take(transform, "SEN {Type Encoder} {Name ECLeft Tick 0} {Name ECRight Tick 0}");
  take(transform, "STA {Time 1.0}");
  take(transform, "STA {Time 1.1}");
  CHECK(transform.frame().state.fields == (robot::kHasEncoders | robot::held(robot::kHasEncoders)));
  take(transform, "SEN {Type Encoder} {Name ECLeft Tick 400} {Name ECRight Tick -200}");
  take(transform, "STA {Time 1.2}");
  CHECK(transform.frame().state.fields == robot::kHasEncoders);
  // 400 x 0.001 x 0.05 m in 0.2 s = 0.1 m/s
  CHECK(transform.frame().state.track_mps[0] == Approx(0.1));
  CHECK(transform.frame().state.track_mps[1] == Approx(-0.05));
  take(transform, "STA {Time 1.3}");
  CHECK(transform.frame().state.track_mps[0] == Approx(0.1));
}

TEST_CASE("Values that are no values change nothing") {
  const auto state =
      after({"SEN {Type GroundTruth} {Location nan,0,0} {Orientation 0,0,0}",
             "SEN {Type GroundTruth} {Location 1e300,0,0} {Orientation 0,0,0}", "SEN {Type INS} {Orientation 1,2}",
             "SEN {Type IMU} {AngularVel 1,2,3}", "SEN {Type Encoder} {Name ECLeft Tick x} {Name ECRight Tick 1e400}",
             "SEN {Type Tachometer} {Vel 1,2,3,4}", "SEN {Type Sonar} {Name F1 Range 4.5}", "SEN",
             "GEO {WheelRadius 0}", "GEO {WheelRadius -0.1}", "CONF {Type Encoder} {Resolution 0}"});
  CHECK(state.fields == 0);
  CHECK(state.p_WB_m == std::array<double, 3>{});
  SensorTransform transform;
  CHECK_FALSE(take(transform, "STA {Type GroundVehicle}"));
  CHECK_FALSE(transform.wheel_radius_m());
}
