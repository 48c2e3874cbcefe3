// What docs/world-server-protocol.md says and no other test of this folder shows, in the page's order.
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <filesystem>

#include "server/world_server/connection.hpp"
#include "server/world_server/report.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPlaceKenaf = "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n";

// The first INS line of a robot of that name, which has noise.
std::string first_ins(const std::string& name) {
  Conversation talk;
  talk.send("CONTROL {Type Session} {Precision 12}\r\nINIT {ClassName USARBot.P2AT} {Name " + name +
            "} {Location 0,0,0}\r\n");
  talk.simulation.advance(talk.wall_s);
  return talk.last("SEN {Type INS}");
}

}  // namespace

TEST_CASE("The system sends each line to a client without delay") {
  namespace ip = boost::asio::ip;
  boost::asio::io_context io{1};
  ip::tcp::acceptor acceptor(io, ip::tcp::endpoint(ip::address_v4::loopback(), 0));
  ip::tcp::socket client(io);
  client.connect(acceptor.local_endpoint());
  ip::tcp::socket accepted = acceptor.accept();
  const int fd = accepted.native_handle();
  Simulation simulation(fast());
  const auto connection = std::make_shared<Connection>(std::move(accepted), simulation, "test", [](Connection&) {});
  connection->start();
  int on = 0;
  socklen_t size = sizeof on;
  REQUIRE(::getsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, &size) == 0);
  CHECK(on != 0);
  connection->close();
  io.poll();
}

TEST_CASE("A positive roll lowers the right side") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf} {Location 0,0,-2} {Rotation 0.3,0,0}\r\n");
  const Eigen::Vector3d to_the_left = talk.truth().X_WB.q * Eigen::Vector3d::UnitY();
  CHECK(to_the_left.z() == Approx(std::sin(0.3)));
}

TEST_CASE("UDK's INS has two digits, rounded, from 0 to 2 pi") {
  physics::SensorDescription ins{};
  ins.type = physics::SensorType::ins;
  ins.name = "INS";
  // turned 0.5 to the left: 2 pi - 0.5 = 5.783
  std::vector<physics::SensorSample> samples{{0, 1, physics::InsReading{{4.506, -1.904, -1.806}, {0, 0, 0.5}}}};
  std::string out;
  write_samples(samples, {ins}, Dialect::udk, formats_of(Dialect::udk), false, out);
  CHECK(out == "SEN {Type INS} {Name INS} {Location 4.51,1.90,1.81} {Orientation 0.00,0.00,5.78}\r\n");
}

TEST_CASE("Every shipped robot is placed by its class, with and without the package's name") {
  std::size_t robots = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(KENAF_SOURCE_DIR) / "share/robots")) {
    const physics::RobotDescription robot = physics::load_robot(entry.path().string());
    INFO(robot.usarsim_class);
    for (const std::string& name :
         {robot.usarsim_class, robot.usarsim_class.substr(robot.usarsim_class.find('.') + 1)}) {
      Conversation talk;
      talk.send("INIT {ClassName " + name + "} {Location 0,0,0}\r\n");
      REQUIRE(talk.session->robot);
      CHECK(talk.session->robot->description->name == entry.path().stem());
    }
    ++robots;
  }
  CHECK(robots >= 10);
}

TEST_CASE("A robot's name seeds the noise of its sensors") {
  const std::string ins = first_ins("R1");
  CHECK(!ins.empty());
  CHECK(first_ins("R1") == ins);
  CHECK(first_ins("R2") != ins);
}

TEST_CASE("A place beyond 100 km is no place: the robot gets a start pose, and the log says so") {
  for (const char* place : {"100001,0,0", "0,0,-1e300", "here"}) {
    INFO(place);
    Conversation talk;
    const WholeLog log;
    talk.send("INIT {ClassName USARBot.P3AT} {Location " + std::string(place) + "}\r\n");
    REQUIRE(talk.session->robot);
    CHECK(talk.truth().X_WB.p.head<2>().norm() == 0);
    CHECK(log.has("Location is not a place"));
  }
}

TEST_CASE("A robot that would stand in another one is lifted above it") {
  Conversation talk;
  Session& other = talk.simulation.connect("other");
  talk.send("INIT {ClassName USARBot.P3AT} {Name A} {Location 0,0,0}\r\n");
  talk.send(other, "INIT {ClassName USARBot.P3AT} {Name B} {Location 0,0,0}\r\n");
  const Eigen::Vector3d p_WB = talk.simulation.world.truth(other.robot->id).X_WB.p;
  CHECK(p_WB.head<2>().norm() == 0);
  CHECK(p_WB.z() > talk.truth().X_WB.p.z() + 0.15);
}

TEST_CASE("A Step passes time without a robot") {
  Conversation talk;
  talk.send("CONTROL {Type Step} {Time 0.5}\r\n");
  CHECK_FALSE(talk.run(10));
  CHECK(talk.simulation.world.step_count() == 500);
}

TEST_CASE("Sideways and upward velocities are ignored") {
  Conversation talk;
  talk.send(kPlaceKenaf);
  talk.send("DRIVE {LinearVelocity 0.1} {LateralVelocity 5} {AltitudeVelocity -5} {RotationalVelocity 0}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] == Approx(0.1));
  CHECK(talk.command().track_speed_mps[robot::kRight] == Approx(0.1));
}

TEST_CASE("Every opcode of a joint, by its word and by its number") {
  using robot::JointMode;
  struct Case {
    const char* word;
    const char* number;
    JointMode mode;
  };
  for (const Case& c : {Case{"Angle", "0", JointMode::angle}, Case{"Target", "0", JointMode::angle},
                        Case{"Velocity", "1", JointMode::speed}, Case{"Torque", "2", JointMode::torque},
                        Case{"Brake", "3", JointMode::brake}, Case{"RelAngle", "10", JointMode::angle},
                        Case{"RelVelocity", "11", JointMode::speed}, Case{"RelTorque", "12", JointMode::torque}}) {
    for (const char* opcode : {c.word, c.number}) {
      INFO(opcode);
      Conversation talk;
      talk.send(kPlaceKenaf);
      CHECK(talk.answer_to("SET {Type Joint} {Name RRFlipper} {Opcode " + std::string(opcode) + "} {Params 0.25}\r\n")
                .ends_with("{Status OK}"));
      CHECK(talk.command().flipper[robot::kRearRight].mode == c.mode);
    }
  }
}

TEST_CASE("Odometry and tachometer start anew, and INS takes its pose") {
  Conversation talk;
  talk.send(std::string(kPlaceKenaf) + "DRIVE {Left 2} {Right 2}\r\n");
  REQUIRE(talk.run(2));
  CHECK(number_in(talk.last("SEN {Type Odometry}"), "Pose", 0) > 0.1);
  talk.send("DRIVE {Left 0} {Right 0}\r\n");
  REQUIRE(talk.run(1));
  talk.lines();
  talk.send(
      "SET {Type Odometry} {Opcode RESET}\r\nSET {Type Tachometer} {Name Tachometer} {Opcode RESET}\r\n"
      "SET {Type INS} {Opcode POSE} {Params 1,2,3,0,0,0.5}\r\n");
  REQUIRE(talk.run(0.4));
  const std::vector<std::string> lines = talk.lines();
  const auto last = [&](const char* type) {
    return *std::find_if(lines.rbegin(), lines.rend(),
                         [&](const std::string& line) { return line.find(type) != std::string::npos; });
  };
  CHECK(number_in(last("{Type Odometry}"), "Pose", 0) == Approx(0).margin(0.01));
  CHECK(number_in(last("{Type Tachometer}"), "Pos", 0) == Approx(0).margin(0.05));
  CHECK(number_in(last("{Type INS}"), "Location", 1) == Approx(2).margin(0.1));
  CHECK(number_in(last("{Type INS}"), "Location", 2) == Approx(3).margin(0.1));
  CHECK(number_in(last("{Type INS}"), "Orientation", 2) == Approx(0.5).margin(0.05));
}

TEST_CASE("A camera mount that is told the speed 0 stops") {
  Conversation talk;
  talk.send(std::string(kPlaceKenaf) + "MISPKG {Name CameraPanTilt} {Link 1} {Value 1} {Order 1}\r\n");
  REQUIRE(talk.run(0.5));
  talk.send("MISPKG {Name CameraPanTilt} {Link 1} {Value 0} {Order 1}\r\n");
  REQUIRE(talk.run(0.2));
  const double there = number_in(talk.last("MISSTA"), "Value");  // of link 1, the first
  CHECK(there == Approx(1).margin(0.05));                        // 0.5 s at 2 rad/s
  REQUIRE(talk.run(1));
  CHECK(number_in(talk.last("MISSTA"), "Value") == Approx(there).margin(0.01));
}

TEST_CASE("CONF of scanners and flippers") {
  Conversation talk;
  talk.send(kPlaceKenaf);
  CHECK(
      talk.answer_to("GETCONF {Type RangeScanner}\r\n") ==
      "CONF {Type RangeScanner} {Name Scanner1} {ScanInterval 0.2000} {MaxRange 4.0000} {MinRange 0.0200} {Resolution "
      "0.0174} {Fov 3.1415} {Panning True} {Tilting False}");
  const physics::RobotDescription& kenaf = *talk.session->robot->description;
  const std::string flipper = talk.answer_to("GETCONF {Type Joint} {Name FLFlipper}\r\n");
  CHECK(flipper.starts_with("CONF {Type Joint} {Name FLFlipper} {JointType Revolute} {MaxSpeed "));
  // a front flipper's tip goes up with a negative angle: its highest is its least
  CHECK(number_in(flipper, "MinValue") == Approx(-kenaf.flipper.front().max_angle_rad).margin(1e-4));
  CHECK(number_in(flipper, "MaxValue") == Approx(-kenaf.flipper.front().min_angle_rad).margin(1e-4));
  // COG is the body's, without the flippers
  CHECK(number_in(talk.answer_to("GETGEO {Type Robot}\r\n"), "COG", 2) ==
        Approx(-kenaf.body.p_BBcm_m.z()).margin(1e-4));
}

TEST_CASE("Boxes by the end of their class, movable ones by their physics and of 100 kg/m3") {
  Conversation talk;
  int number = 0;
  const auto created = [&](const std::string& class_name, const std::string& groups = "") {
    return talk
        .answer_to("CONTROL {Type Create} {ClassName " + class_name + "} {Name N" + std::to_string(++number) +
                   "} {Location 0,0,-9} " + groups + "\r\n")
        .ends_with("{Status OK}");
  };
  for (const char* name : {"Box", "USARPhysObj.SmallBox", "block", "Cube", "USARPhysObj.Crate"}) CHECK(created(name));
  for (const char* name : {"Boxer", "Barrel", "Box.Ball", ""}) CHECK_FALSE(created(name));
  for (const char* physics : {"RigidBody", "Falling", "ground"}) {
    CHECK(created("Box", "{Scale 0.5,0.2,0.1} {Physics " + std::string(physics) + "}"));
    CHECK(talk.simulation.world.box(talk.simulation.objects.back().box).mass_kg == Approx(1));  // 0.01 m3
  }
  CHECK(created("Box", "{Physics None}"));
  CHECK(talk.simulation.world.box(talk.simulation.objects.back().box).mass_kg == 0);
  for (const char* verb : {"Rotate", "SetWP", "AddWP", "ClearWP", "Conveyor"}) {
    CHECK(talk.answer_to("CONTROL {Type " + std::string(verb) + "} {Name N1}\r\n").ends_with("{Status Failed}"));
  }
}

TEST_CASE("There are at most 1000 objects") {
  Conversation talk;
  for (int i = 0; i < 1001; ++i) {
    const std::string answer = talk.answer_to("CONTROL {Type Create} {ClassName Box} {Name N" + std::to_string(i) +
                                              "} {Location " + std::to_string(2 * i) + ",0,-5}\r\n");
    if (answer.ends_with(i < 1000 ? "{Status OK}" : "{Status Failed}")) continue;
    FAIL(answer);
  }
}

TEST_CASE("GetSTA tells a robot by its name, without a size") {
  Conversation talk;
  talk.send(kPlaceKenaf);
  const std::string status = talk.answer_to("CONTROL {Type GetSTA} {Name r1}\r\n");
  CHECK(status.starts_with("STA {Name R1} {Location 0.0000,0.0000,-0.0"));
  CHECK(status.ends_with("{Rotation 0.0000,0.0000,0.0000}"));
}

TEST_CASE("A sensor's time is earlier than STA's by its delay") {
  const test::TemporaryFolder folder;
  std::string text = test::read_file(fs::path(KENAF_SOURCE_DIR) / "share/robots/p2dx.toml");
  const std::string name = "name = \"GroundTruth\"\n";
  REQUIRE(text.find(name) != std::string::npos);
  text.insert(text.find(name) + name.size(), "delay_s = 0.05\n");
  test::write_file(folder / "late.toml", text);
  ServerOptions options = fast();
  options.robot = (folder / "late.toml").string();
  Conversation talk(options);
  talk.send(kPlaceKenaf);
  REQUIRE(talk.run(1));
  const std::vector<std::string> lines = talk.lines();
  REQUIRE(lines.back().starts_with("STA"));
  const auto truth = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
    return line.find("{Type GroundTruth}") != std::string::npos;
  });
  REQUIRE(truth != lines.rend());
  CHECK(number_in(lines.back(), "Time") == Approx(1));
  CHECK(number_in(*truth, "Time") == Approx(0.95).margin(1e-4));
}

TEST_CASE("The page's example of a session") {
  Conversation talk;
  talk.lines();
  talk.send(
      "CONTROL {Type Session} {Period 0.01} {Lockstep True} {CommandTimeout 0.5} {Precision 12}\r\n"
      "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  talk.simulation.advance(talk.wall_s);
  const std::vector<std::string> first = talk.lines();
  CHECK(first.front() ==
        "RES {Time 0.000000000000} {Type Control} {Name Session} {Status OK} {Period 0.010000000000} {Lockstep True}");
  CHECK(first.back().ends_with("{Frame 1} {Late 0} {Steps 0} {Paused False}"));
  talk.send("MULTIDRIVE {FRFlipper -0.5} {FLFlipper -0.5} {Frame 1}\r\nDRIVE {Left 2.0} {Right 2.0} {Frame 1}\r\n");
  REQUIRE(talk.run(0.01));
  CHECK(talk.last("STA").ends_with("{Frame 2} {Late 0} {Steps 10} {Paused False}"));
  CHECK(talk.command().flipper[robot::kFrontLeft].value == 0.5);
}

}  // namespace kenaf::world_server
