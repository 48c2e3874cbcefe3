#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

using robot::JointMode;

struct Kenaf : Conversation {
  explicit Kenaf(const char* class_name = "USARBot.Kenaf") {
    send("INIT {ClassName " + std::string(class_name) + "} {Name R1} {Location 0,0,0}\r\n");
    REQUIRE(session->robot);
  }
  double left_mps() { return command().track_speed_mps[robot::kLeft]; }
  double right_mps() { return command().track_speed_mps[robot::kRight]; }
  const physics::RobotDescription& description() { return *session->robot->description; }
  double radius_m() { return description().drive.sprocket_radius_m; }
  double fastest_mps() { return description().drive.max_speed_mps; }
};

}  // namespace

TEST_CASE("DRIVE gives the spin of each side's wheel in rad/s") {
  Kenaf kenaf;
  kenaf.send("DRIVE {Left 2.0} {Right -1}\r\n");
  CHECK(kenaf.left_mps() == Approx(2 * kenaf.radius_m()));
  CHECK(kenaf.right_mps() == Approx(-1 * kenaf.radius_m()));
}

TEST_CASE("A side that DRIVE does not name keeps its speed") {
  Kenaf kenaf;  // RCRP; THAF sends only Left
  kenaf.send("DRIVE {Left 2} {Right 3}\r\nDrive {RIGHT 1}\r\n");
  CHECK(kenaf.left_mps() == Approx(2 * kenaf.radius_m()));
  CHECK(kenaf.right_mps() == Approx(1 * kenaf.radius_m()));
}

TEST_CASE("Normalized speeds are per cent of the fastest, for this and the following commands") {
  Kenaf kenaf;
  // .NET clients write True, which the UDK server took for false.
  kenaf.send("DRIVE {Left 50} {Right -100} {Normalized True}\r\n");
  CHECK(kenaf.left_mps() == Approx(0.5 * kenaf.fastest_mps()));
  CHECK(kenaf.right_mps() == Approx(-kenaf.fastest_mps()));
  kenaf.send("DRIVE {Left 10} {Right 10}\r\n");
  CHECK(kenaf.left_mps() == Approx(0.1 * kenaf.fastest_mps()));
  kenaf.send("DRIVE {Normalized false} {Left 1}\r\n");
  CHECK(kenaf.left_mps() == Approx(kenaf.radius_m()));
}

TEST_CASE("Speeds are clamped to what the drives can do, and a number that is none changes nothing") {
  Kenaf kenaf;
  kenaf.send("DRIVE {Left 1e300} {Right -1e300}\r\n");
  CHECK(kenaf.left_mps() == kenaf.fastest_mps());
  CHECK(kenaf.right_mps() == -kenaf.fastest_mps());
  kenaf.send("DRIVE {Left nan} {Right inf}\r\nDRIVE {Left} {Right x}\r\n");
  CHECK(kenaf.left_mps() == kenaf.fastest_mps());
}

TEST_CASE("A decimal comma is understood") {
  Kenaf kenaf;  // .NET and Portuguese clients
  kenaf.send("DRIVE {Left 1,5} {Right 0,0000}\r\n");
  CHECK(kenaf.left_mps() == Approx(1.5 * kenaf.radius_m()));
  CHECK(kenaf.right_mps() == 0);
}

TEST_CASE("A turn to the left lowers USARSim's yaw") {
  Kenaf kenaf;
  kenaf.send("DRIVE {Left -2} {Right 2}\r\n");
  REQUIRE(kenaf.run(2));
  const std::string truth = kenaf.last("SEN {Time 2.0000} {Type GroundTruth}");
  CHECK(angle_in(truth, "Orientation", 2) < -0.3);
  CHECK(physics::roll_pitch_yaw(kenaf.truth().X_WB.q).z() > 0.3);
  CHECK(number_in(truth, "Location", 2) < 0);  // it stands on the ground, so its centre is above it
}

TEST_CASE("Forward is x for a robot that was not turned") {
  Kenaf kenaf("USARBot.P2AT");
  kenaf.send("DRIVE {Left 2} {Right 2}\r\n");
  REQUIRE(kenaf.run(2));
  CHECK(kenaf.truth().X_WB.p.x() > 0.3);
  CHECK(std::abs(kenaf.truth().X_WB.p.y()) < 0.02);
}

TEST_CASE("A client of USARSim's P3AT drives it on its wheels") {
  Kenaf kenaf("USARBot.P3AT");
  // 3 rad/s on wheels of 0.111 m: 0.333 m/s; 2 s less what it takes to get there, 0.1 s
  kenaf.send("DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(kenaf.run(2));
  CHECK(kenaf.truth().X_WB.p.x() == Approx(0.333 * 1.9).epsilon(0.03));
  // On the spot to the left, slower than slipless wheels 0.394 m apart: 0.666 / 0.394 = 1.69 rad/s.
  const double before_rad = physics::roll_pitch_yaw(kenaf.truth().X_WB.q).z();
  kenaf.send("DRIVE {Left -3} {Right 3}\r\n");
  REQUIRE(kenaf.run(1));
  const double turned_rad = physics::roll_pitch_yaw(kenaf.truth().X_WB.q).z() - before_rad;
  CHECK(turned_rad > 0.8);
  CHECK(turned_rad < 1.5);
}

TEST_CASE("An Ackermann command drives the curve of its steering angle") {
  Kenaf kenaf("USARBot.P2DX");
  const double wheel_base_m = 0.215;  // from the axle, at x = 0.045 m, to the caster, at -0.17 m
  // Positive FrontSteer turns right: the left track runs faster. v = 1 rad/s x radius; turn rate = v tan(0.1) / base.
  kenaf.send("DRIVE {Speed 1} {FrontSteer 0.1} {RearSteer 0}\r\n");
  const double turn_radps = kenaf.radius_m() * std::tan(0.1) / wheel_base_m;
  CHECK((kenaf.left_mps() + kenaf.right_mps()) / 2 == Approx(kenaf.radius_m()));
  CHECK((kenaf.left_mps() - kenaf.right_mps()) / kenaf.description().track_gauge_m() == Approx(turn_radps));
  kenaf.send("DRIVE {FrontSteer 0}\r\n");
  CHECK(kenaf.left_mps() == Approx(kenaf.radius_m()));
  CHECK(kenaf.right_mps() == Approx(kenaf.radius_m()));
}

TEST_CASE("A curve at full speed is driven slower, not wider") {
  Kenaf kenaf("USARBot.P2DX");
  const double wheel_base_m = 0.215;  // from the axle, at x = 0.045 m, to the caster, at -0.17 m
  const double half_gauge_m = kenaf.description().track_gauge_m() / 2;
  // Half the difference of the sides over half their sum: half the gauge over the radius of the curve, at any speed.
  const auto bend = [&] { return (kenaf.left_mps() - kenaf.right_mps()) / (kenaf.left_mps() + kenaf.right_mps()); };
  kenaf.send("DRIVE {Speed 100} {FrontSteer 0.1} {RearSteer 0} {Normalized True}\r\n");
  CHECK(kenaf.left_mps() == Approx(kenaf.fastest_mps()));
  CHECK(bend() == Approx(half_gauge_m * std::tan(0.1) / wheel_base_m));
  kenaf.send("DRIVE {Speed -100} {FrontSteer 0.1}\r\n");
  CHECK(kenaf.left_mps() == Approx(-kenaf.fastest_mps()));
  CHECK(bend() == Approx(half_gauge_m * std::tan(0.1) / wheel_base_m));
  // 1 rad/s at 10 m/s, which no P2DX reaches: a radius of 10 m all the same.
  kenaf.send("DRIVE {LinearVelocity 10} {RotationalVelocity -1}\r\n");
  CHECK(kenaf.right_mps() == Approx(kenaf.fastest_mps()));
  CHECK(bend() == Approx(-half_gauge_m / 10));
  kenaf.send("DRIVE {LinearVelocity 1e308} {RotationalVelocity 1e308}\r\n");
  CHECK(kenaf.left_mps() == Approx(kenaf.fastest_mps()));
  CHECK(std::abs(kenaf.right_mps()) <= kenaf.fastest_mps());
}

TEST_CASE("A body velocity is given to both tracks") {
  Kenaf kenaf;
  // 0.1 m/s ahead and 0.2 rad/s clockwise: left 0.1 + 0.2 gauge / 2.
  kenaf.send("DRIVE {AltitudeVelocity 0} {LinearVelocity 0.1} {LateralVelocity 0} {RotationalVelocity 0.2}\r\n");
  CHECK(kenaf.left_mps() == Approx(0.1 + 0.1 * kenaf.description().track_gauge_m()));
  CHECK(kenaf.right_mps() == Approx(0.1 - 0.1 * kenaf.description().track_gauge_m()));
}

TEST_CASE("MULTIDRIVE lifts front flippers with negative angles and rear ones with positive angles") {
  Kenaf kenaf;  // UsarCommander's front up; MRL writes the type so, and two blanks
  kenaf.send("MultiDrive {FRFlipper -0.5} {FLFlipper -0.5} {RRFlipper 0.5} {RLFlipper  0.25} {Normalized False}\r\n");
  const auto flippers = kenaf.command().flipper;
  for (const auto flipper : {robot::kFrontLeft, robot::kFrontRight, robot::kRearRight}) {
    CHECK(flippers[flipper].mode == JointMode::angle);
    CHECK(flippers[flipper].value == 0.5);
  }
  CHECK(flippers[robot::kRearLeft].value == 0.25);
}

TEST_CASE("MULTIDRIVE of one flipper leaves the others, and STA tells angles with the sign of the command") {
  Kenaf kenaf;
  kenaf.send("MULTIDRIVE {FRFlipper 0} {FLFlipper 0} {RRFlipper 0} {RLFlipper 0}\r\nMULTIDRIVE {RRFlipper 0.3}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearLeft].value == 0);
  REQUIRE(kenaf.run(2));
  const std::string status = kenaf.last("STA");
  CHECK(number_in(status, "RRFlipper") == Approx(0.3).margin(0.05));
  CHECK(number_in(status, "FLFlipper") == Approx(0).margin(0.05));
  kenaf.send("MULTIDRIVE {FLFlipper -0.4}\r\n");
  REQUIRE(kenaf.run(2));
  CHECK(number_in(kenaf.last("STA"), "FLFlipper") == Approx(-0.4).margin(0.05));
  CHECK(kenaf.truth().flipper_rad[robot::kFrontLeft] == Approx(0.4).margin(0.05));
}

TEST_CASE("A flipper angle beyond its range is the same direction within the range, a relative one ends at its end") {
  Kenaf kenaf;  // -pi to pi
  // 2 pi + 0.4 = 6.6832 and 0.4 - 2 pi = -5.8832 are 0.4 tip up. Front flippers have the other sign.
  kenaf.send("MULTIDRIVE {RRFlipper 6.683185307} {RLFlipper 6.683185307} {FRFlipper -6.683185307}\r\n");
  kenaf.send("DRIVE {Name FLFlipper} {Order 0} {Value 5.883185307}\r\n");
  REQUIRE(kenaf.run(3));
  for (const auto flipper : {robot::kRearRight, robot::kRearLeft, robot::kFrontRight, robot::kFrontLeft})
    CHECK(kenaf.truth().flipper_rad[flipper] == Approx(0.4).margin(0.02));
  kenaf.send("DRIVE {Name RRFlipper} {Order 10} {Value 4}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearRight].value == kenaf.description().flipper.front().max_angle_rad);
}

TEST_CASE("Half a turn lifts a flipper over the top, however its digits are rounded") {
  Kenaf kenaf;
  // What a program on hrt.h asks for by 180 degrees, and what a client of USARSim writes.
  kenaf.send(
      "MULTIDRIVE {RRFlipper 3.14159265358979} {RLFlipper 3.1416} {FRFlipper -3.1416} {FLFlipper -3.14159266}\r\n");
  REQUIRE(kenaf.run(0.5));
  // from 1 rad at up to 1.5 rad/s
  for (const double tip_up_rad : kenaf.truth().flipper_rad) CHECK(tip_up_rad > 1.3);
}

TEST_CASE("DRIVE orders joints by number, several in one line") {
  Kenaf kenaf;
  const double most_radps = kenaf.description().servo.max_speed_radps;
  kenaf.send(
      "DRIVE {Name FRFlipper} {Steer 0} {Order 0} {Value -0.2} {Name RRFlipper} {Order 1} {Value 0.5} "
      "{Name FLFlipper} {Order 2} {Value -3} {Name RLFlipper} {Order 3}\r\n");
  const auto flippers = kenaf.command().flipper;
  CHECK(flippers[robot::kFrontRight].mode == JointMode::angle);
  CHECK(flippers[robot::kFrontRight].value == 0.2);
  CHECK(flippers[robot::kRearRight].mode == JointMode::speed);
  CHECK(flippers[robot::kRearRight].value == 0.5);
  CHECK(flippers[robot::kFrontLeft].mode == JointMode::torque);
  CHECK(flippers[robot::kFrontLeft].value == 3);
  CHECK(flippers[robot::kRearLeft].mode == JointMode::brake);
  kenaf.send("DRIVE {Name RRFlipper} {Order 1} {Value 1000}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearRight].value == most_radps);
}

TEST_CASE("Relative orders start from what the joint does now, what is missing is 0") {
  Kenaf kenaf;
  const double start_rad = kenaf.truth().flipper_rad[robot::kRearLeft];
  kenaf.send("DRIVE {Name RLFlipper} {Order 10} {Value 0.25}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearLeft].value == Approx(start_rad + 0.25));
  kenaf.send("DRIVE {Name FLFlipper} {Order 10} {Value 0.25}\r\n");  // front: + lowers the tip
  CHECK(kenaf.command().flipper[robot::kFrontLeft].value == Approx(start_rad - 0.25));
  kenaf.send("DRIVE {Name RLFlipper} {Order 11} {Value 0.1}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearLeft].mode == JointMode::speed);
  kenaf.send("DRIVE {Name RLFlipper} {Order 12} {Value 0.1}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearLeft].mode == JointMode::torque);
  kenaf.send("DRIVE {Name RLFlipper}\r\n");
  CHECK(kenaf.command().flipper[robot::kRearLeft].mode == JointMode::angle);
  CHECK(kenaf.command().flipper[robot::kRearLeft].value == 0);
}

TEST_CASE("Joints and orders that do not exist change nothing") {
  Kenaf kenaf;
  kenaf.send("DRIVE {Name Tail} {Order 0} {Value 1}\r\nDRIVE {Name FLFlipper} {Order 77} {Value 1}\r\n");
  for (const auto& joint : kenaf.command().flipper)
    CHECK(joint.value == kenaf.description().flipper[0].start_angle_rad);
  Kenaf wheels("USARBot.P2DX");
  wheels.send("MULTIDRIVE {FRFlipper 1}\r\nDRIVE {Name FRFlipper} {Value 1}\r\n");
  REQUIRE(wheels.run(0.1));
}

TEST_CASE("A joint whose value is no number keeps its command, and the log says so") {
  const auto logged = [](std::string_view line, std::string_view complaint) {
    const WholeLog log;  // a connection complains once in 5 s, so each line has its own
    Kenaf kenaf;
    kenaf.send(line);
    const double start_rad = kenaf.description().flipper[0].start_angle_rad;
    CHECK(kenaf.command().flipper[robot::kFrontRight].value == start_rad);
    CHECK(kenaf.command().flipper[robot::kRearRight].value == 0.25);  // named beside it
    return log.has(complaint);
  };
  CHECK(logged("DRIVE {Name FRFlipper} {Order 0} {Value -0.5rad} {Name RRFlipper} {Order 0} {Value 0.25}\r\n",
               "DRIVE: Value of FRFlipper is not a number: \"-0.5rad\""));
  CHECK(logged("DRIVE {Name RRFlipper} {Value 0.25} {Name FRFlipper} {Value }\r\n",
               "DRIVE: Value of FRFlipper is not a number: \"\""));
  CHECK(logged("MULTIDRIVE {FRFlipper 0.5rad} {RRFlipper 0.25}\r\n",
               "MULTIDRIVE: FRFlipper is not a number: \"0.5rad\""));
  // A brake needs no value.
  Kenaf kenaf;
  kenaf.send("DRIVE {Name FRFlipper} {Order 3} {Value x}\r\n");
  CHECK(kenaf.command().flipper[robot::kFrontRight].mode == JointMode::brake);
}

TEST_CASE("The light is switched and told") {
  Kenaf kenaf;
  kenaf.send("DRIVE {Light true}\r\n");
  REQUIRE(kenaf.run(0.001));
  CHECK(kenaf.last("STA").find("{LightToggle True} {LightIntensity 100}") != std::string::npos);
}

TEST_CASE("Flip puts a fallen robot back upright, looking where it looked, and leaves an upright one alone") {
  Kenaf kenaf;
  const physics::Pose upside_down{{1, 2, 0.1}, physics::rotation_from({std::numbers::pi, 0, 0.5})};
  kenaf.simulation.world.teleport(kenaf.session->robot->id, upside_down);
  kenaf.send("DRIVE {Flip True}\r\n");
  const physics::Pose X_WB = kenaf.truth().X_WB;
  CHECK((X_WB.q * Eigen::Vector3d::UnitZ()).z() == Approx(1));
  CHECK(physics::roll_pitch_yaw(X_WB.q).z() == Approx(0.5));
  CHECK(X_WB.p.x() == Approx(1));
  REQUIRE(kenaf.run(0.5));
  const physics::Pose standing = kenaf.truth().X_WB;
  kenaf.send("DRIVE {Flip True}\r\n");
  CHECK(kenaf.truth().X_WB.p == standing.p);
}

TEST_CASE("Commands without a robot are ignored") {
  Conversation talk;
  CHECK(talk.answer_to("DRIVE {Left 1} {Right 1}\r\nMULTIDRIVE {FRFlipper 1}\r\nMISPKG {Name C} {Link 1}\r\n").empty());
}

}  // namespace kenaf::world_server
