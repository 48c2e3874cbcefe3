// The exact text of SEN and STA. Lines marked as recorded were sent by the historic servers.
#include "server/world_server/report.hpp"
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

using physics::SensorDescription;
using physics::SensorType;

SensorDescription sensor(SensorType type, const char* name) {
  SensorDescription description{};
  description.type = type;
  description.name = name;
  description.resolution_rad = 0.01745329;
  description.field_of_view_rad = 2 * description.resolution_rad;
  return description;
}

// The message of one reading, without its line end.
std::string message(Dialect dialect, const SensorDescription& description, const physics::Reading& reading,
                    double t_s = 3104.5749) {
  std::vector<physics::SensorSample> samples{{0, t_s, reading}};
  std::string out;
  write_samples(samples, {description}, dialect, formats_of(dialect), true, out);
  REQUIRE(out.ends_with("\r\n"));
  out.resize(out.size() - 2);
  return out;
}

}  // namespace

TEST_CASE("GroundTruth: UT2004 as recorded, with angles from 0 to 2 pi, UDK with signed angles and three digits") {
  // z up 1.85 below, y to the left -1.9; pitch 0.001 nose down and yaw 0.002 to the left are negative in USARSim.
  const physics::GroundTruthReading reading{{4.5, -1.9, -1.85}, {0, 0.0011, 0.0022}};
  CHECK(message(Dialect::ut2004, sensor(SensorType::ground_truth, "GroundTruth"), reading) ==
        "SEN {Time 3104.5749} {Type GroundTruth} {Name GroundTruth} {Location 4.50,1.90,1.85} "
        "{Orientation 0.00,6.28,6.28}");
  CHECK(message(Dialect::udk, sensor(SensorType::ground_truth, "GroundTruth"), reading) ==
        "SEN {Time 3104.5749} {Type GroundTruth} {Name GroundTruth} {Location 4.500,1.900,1.850} "
        "{Orientation 0.000,-0.001,-0.002}");
}

TEST_CASE("INS has no time, as recorded") {
  const physics::InsReading reading{{4.5, -1.9, -1.8}, {0, 0, 0}};
  CHECK(message(Dialect::ut2004, sensor(SensorType::ins, "INS"), reading) ==
        "SEN {Type INS} {Name INS} {Location 4.50,1.90,1.80} {Orientation 0.00,0.00,0.00}");
}

TEST_CASE("Odometry turns to the right where theta grows") {
  const physics::OdometryReading reading{1.25, 0.5, 0.25};  // ahead, to the left, turned left
  CHECK(message(Dialect::ut2004, sensor(SensorType::odometry, "Odometry"), reading) ==
        "SEN {Type Odometry} {Name Odometry} {Pose 1.2500,-0.5000,-0.2500}");
}

TEST_CASE("Encoders: one message of UT2004, as recorded, a message for each of UDK") {
  const physics::EncoderReading reading{{0, -7}};
  CHECK(message(Dialect::ut2004, sensor(SensorType::encoder, "Encoder"), reading) ==
        "SEN {Type Encoder} {Name ECLeft Tick 0} {Name ECRight Tick -7}");
  CHECK(message(Dialect::udk, sensor(SensorType::encoder, "Encoder"), reading) ==
        "SEN {Time 3104.5749} {Type Encoder} {Name ECLeft} {Tick 0}\r\n"
        "SEN {Time 3104.5749} {Type Encoder} {Name ECRight} {Tick -7}");
}

TEST_CASE("Sonars: all in one message of UT2004, a message for each of UDK") {
  std::vector<physics::SensorSample> samples{{0, 3104.5749, physics::SonarReading{4.5523}},
                                             {1, 3104.5749, physics::SonarReading{2.5}}};
  const std::vector<SensorDescription> sensors{sensor(SensorType::sonar, "F1"), sensor(SensorType::sonar, "F2")};
  std::string out;
  write_samples(samples, sensors, Dialect::ut2004, formats_of(Dialect::ut2004), false, out);
  CHECK(out == "SEN {Time 3104.5749} {Type Sonar} {Name F1 Range 4.5523} {Name F2 Range 2.5000}\r\n");
  out.clear();
  write_samples(samples, sensors, Dialect::udk, formats_of(Dialect::udk), false, out);
  CHECK(out ==
        "SEN {Time 3104.5749} {Type Sonar} {Name F1} {Range 4.5523}\r\n"
        "SEN {Time 3104.5749} {Type Sonar} {Name F2} {Range 2.5000}\r\n");
}

TEST_CASE("A range scan goes from the right end to the left one") {
  const physics::RangeScanReading from_the_left{{1.11111, 2.22222, 3.33339}};
  CHECK(message(Dialect::ut2004, sensor(SensorType::range_scanner, "Scanner1"), from_the_left) ==
        "SEN {Time 3104.57} {Type RangeScanner} {Name Scanner1} {Resolution 0.0174} {FOV 0.0349} "
        "{Range 3.3334,2.2222,1.1111}");
  CHECK(message(Dialect::udk, sensor(SensorType::range_scanner, "Scanner1"), from_the_left) ==
        "SEN {Time 3104.5749} {Type RangeScanner} {Name Scanner1} {Resolution 0.0174} {FOV 0.0349} "
        "{Range 3.33,2.22,1.11}");
}

TEST_CASE("The inertial sensor's y and z change their signs") {
  const physics::ImuReading reading{{1, 2, 9.80665}, {0.1, 0.2, 0.3}, {4, 5, 6}, {0.01, 0.02, 0.03}};
  CHECK(message(Dialect::ut2004, sensor(SensorType::imu, "IMU"), reading, 1) ==
        "SEN {Time 1.0000} {Type IMU} {Name IMU} {XYZAcceleration 1.0000,-2.0000,-9.8066} "
        "{AngularVel 0.1000,-0.2000,-0.3000} {AngularAccel 4.0000,-5.0000,-6.0000} {Rotation 0.0100,-0.0200,-0.0300}");
}

TEST_CASE("Tachometer, touch and drives are reported in the form of their dialect") {
  CHECK(message(Dialect::ut2004, sensor(SensorType::tachometer, "Tachometer"),
                physics::TachometerReading{{1, -2}, {3, -4}}, 1) ==
        "SEN {Time 1.0000} {Type Tachometer} {Name Tachometer} {Vel 1.0000,-2.0000} {Pos 3.0000,-4.0000}");
  CHECK(message(Dialect::ut2004, sensor(SensorType::touch, "Touch"), physics::TouchReading{false}, 1) ==
        "SEN {Time 1.0000} {Type Touch} {Name Touch Touch False}");
  CHECK(message(Dialect::udk, sensor(SensorType::touch, "Touch"), physics::TouchReading{true}, 1) ==
        "SEN {Time 1.0000} {Type Touch} {Name Touch} {Touch True}");
  CHECK(message(Dialect::ut2004, sensor(SensorType::drives, "Drives"),
                physics::DrivesReading{{1, 2}, {3, 4, 5, 6}, 25.5}, 1) ==
        "SEN {Time 1.0000} {Type Drives} {Name Drives} {TrackCurrent 1.0000,2.0000} "
        "{FlipperCurrent 3.0000,4.0000,5.0000,6.0000} {BatteryVoltage 25.5000}");
}

TEST_CASE("GPS tells degrees and minutes, or that it has no fix") {
  // 39 degrees and 8.03 minutes north: 39 + 8.03 / 60 = 39.133833...
  CHECK(message(Dialect::ut2004, sensor(SensorType::gps, "GPS"),
                physics::GpsReading{39 + 8.03 / 60, -(77 + 13.0 / 60), 11, true}, 1) ==
        "SEN {Type GPS} {Name GPS} {Latitude 39,8.0300,N} {Longitude 77,13.0000,W} {Fix 1} "
        "{Satellites 11}");
  CHECK(message(Dialect::udk, sensor(SensorType::gps, "GPS"), physics::GpsReading{0, 0, 0, false}, 1) ==
        "SEN {Time 1.0000} {Type GPS} {Name GPS} {Fix 0} {Satellites 0}");
}

TEST_CASE("A client that asked for more digits gets them everywhere, rounded") {
  std::vector<physics::SensorSample> samples{{0, 1, physics::GroundTruthReading{{0.123456789, 0, 0}, {0, 0, 0}}}};
  std::string out;
  write_samples(samples, {sensor(SensorType::ground_truth, "GT")}, Dialect::udk, formats_with(8), true, out);
  CHECK(out ==
        "SEN {Time 1.00000000} {Type GroundTruth} {Name GT} {Location 0.12345679,0.00000000,0.00000000} "
        "{Orientation 0.00000000,0.00000000,0.00000000}\r\n");
}

TEST_CASE("STA of a wheeled robot: UT2004 as recorded, UDK as recorded") {
  Conversation ut2004;
  ut2004.send("INIT {ClassName USARBot.P2DX}\r\n");
  ut2004.simulation.advance(0);
  CHECK(ut2004.last("STA") ==
        "STA {Type GroundVehicle} {Time 0.00} {FrontSteer 0.0000} {RearSteer 0.0000} {LightToggle False} "
        "{LightIntensity 0} {Battery 1200} {View -1}");
  Conversation udk(fast(true));
  udk.send("INIT {ClassName USARBot.P2DX}\r\n");
  udk.simulation.advance(0);
  CHECK(udk.last("STA") ==
        "STA {Time 0.0000} {Battery 1200} {Type GroundVehicle} {LightToggle False} {LightIntensity 100} "
        "{FrontSteer 0} {RearSteer 0}");
}

TEST_CASE("STA of a robot with flippers lists them as the UT2004 server did, and the battery counts down") {
  Conversation talk;
  talk.send(
      "INIT {ClassName USARBot.Kenaf} {Location 0,0,0}\r\nMULTIDRIVE {FRFlipper -1} {FLFlipper -1} {RRFlipper 1} "
      "{RLFlipper 1}\r\n");
  REQUIRE(talk.run(4));
  const std::string status = talk.last("STA");
  CHECK(status.starts_with("STA {Type GroundVehicle} {Time 4.00} {FrontSteer 0.0000} {RearSteer 0.0000} {FRFlipper -"));
  const auto at = [&](const char* name) { return status.find(name); };
  CHECK(at("{FRFlipper") < at("{FLFlipper"));
  CHECK(at("{FLFlipper") < at("{RRFlipper"));
  CHECK(at("{RRFlipper") < at("{RLFlipper"));
  CHECK(at("{RLFlipper") < at("{LightToggle"));
  CHECK(number_in(status, "RLFlipper") == Approx(1).margin(0.05));
  CHECK(number_in(status, "Battery") == Approx(3596).margin(1));
}

TEST_CASE("A plain client hears nothing of what USARSim did not have") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf}\r\n");
  REQUIRE(talk.run(1));
  for (const std::string& line : talk.lines()) {
    CHECK(line.find("Drives") == std::string::npos);
    for (const char* key : {"{Frame", "{Steps", "{Paused", "{Late", "{Silent"})
      CHECK(line.find(key) == std::string::npos);
  }
}

TEST_CASE("Every sensor of the Kenaf reports, in the UT2004 server's order, and STA ends the output") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf}\r\nCONTROL {Type Session} {Period 0.01}\r\n");
  REQUIRE(talk.run(3));
  std::vector<std::string> kinds;
  for (const std::string& line : talk.lines()) {
    for (const char* kind : {"Sonar", "RangeScanner", "INS", "Odometry", "Encoder", "GroundTruth", "GPS", "Tachometer",
                             "IMU", "Touch", "Drives"}) {
      if (line.find("{Type " + std::string(kind) + "}") != std::string::npos) kinds.emplace_back(kind);
    }
    if (!line.starts_with("STA")) continue;
    // All kinds were due once: the last output that has a scan and a position has everything before it.
    if (kinds.size() == 11) break;
    kinds.clear();
  }
  CHECK(kinds == std::vector<std::string>{"Sonar", "RangeScanner", "INS", "Odometry", "Encoder", "GroundTruth", "GPS",
                                          "Tachometer", "IMU", "Touch", "Drives"});
}

}  // namespace kenaf::world_server
