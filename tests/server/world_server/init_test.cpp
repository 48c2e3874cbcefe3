// Placing a robot, with every oddity of real clients. What they send is named by its source: THAF, ROSU, RCRP, MRL,
// AP2DX, MALDO, AUT, MAK are client programs, see docs/world-server-protocol.md.
#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

// Where INIT put the robot, in the world's z-up frame.
Eigen::Vector3d placed_at(const std::string& init) {
  Conversation talk;
  talk.send(init);
  REQUIRE(talk.session->robot);
  return talk.truth().X_WB.p;
}

}  // namespace

TEST_CASE("A client is greeted with the game and the level") {
  Conversation talk;
  CHECK(talk.lines() == std::vector<std::string>{"NFO {Gametype BotDeathMatch} {Level flat} {TimeLimit 20}"});
}

TEST_CASE("The x coordinate stays, y changes its sign, and a height above the ground is kept") {
  // USARSim: y right, z down. 2 m to the left and 3 m up are y = -2, z = -3.
  const Eigen::Vector3d p = placed_at("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 1,-2,-3}\r\n");
  CHECK(p.x() == 1);
  CHECK(p.y() == 2);
  CHECK(p.z() == 3);
}

TEST_CASE("A place below the ground is lifted onto it") {
  // Old clients send the z of their own levels, such as 1.8, which is below flat ground.
  const Eigen::Vector3d p = placed_at("INIT {ClassName USARBot.Kenaf} {Location 4.5,1.9,1.8}\r\n");
  CHECK(p.x() == 4.5);
  CHECK(p.y() == -1.9);
  CHECK(p.z() > 0.05);
  CHECK(p.z() < 0.2);
}

TEST_CASE("Vectors are read as clients write them") {
  for (const char* location : {"1.0 2.0 3.0", "1.0, 2.0, 3.0", "1,2,3", " 1.0  2.0  3.0 ", "1.,2.,3.", "1,0 2,0 3,0"}) {
    INFO(location);
    const auto p = placed_at("INIT {ClassName USARBot.Kenaf} {Location " + std::string(location) + "}\r\n");
    CHECK(p.x() == 1);
    CHECK(p.y() == -2);
  }
  const auto p = placed_at("INIT {ClassName USARBot.P2AT} {Location .4, .4, 1.8}\r\n");  // MAK
  CHECK(p.x() == 0.4);
  CHECK(p.y() == -0.4);
}

TEST_CASE("Class names are read without case, and keys too") {
  for (const char* init : {"INIT {ClassName USARBot.kenaf}\r\n", "init {Classname usarbot.KENAF} {name x}\r\n",
                           "Init{ClassName   USARBot.Kenaf}{  Name   R }   \n", "INIT {ClassName Kenaf}\n\r"}) {
    INFO(init);
    Conversation talk;
    talk.send(init);
    REQUIRE(talk.session->robot);
    CHECK(talk.session->robot->description->usarsim_class == "USARBot.Kenaf");
  }
}

TEST_CASE("The order of INIT's groups does not matter, and unknown ones are skipped") {
  Conversation talk;  // AP2DX's order, RCRP's battery
  talk.send("INIT {ClassName USARBot.P2DX} {Location 1,0,0} {Rotation 0,0,1} {Name R1} {Battery 3600}\r\n");
  REQUIRE(talk.session->robot);
  CHECK(talk.session->robot->name == "R1");
  CHECK(physics::roll_pitch_yaw(talk.truth().X_WB.q).z() == Approx(-1));  // clockwise is negative in z-up
}

TEST_CASE("Nose up is a positive pitch of USARSim's") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf} {Location 0,0,-2} {Rotation 0,0.3,0}\r\n");
  const Eigen::Vector3d ahead = talk.truth().X_WB.q * Eigen::Vector3d::UnitX();
  CHECK(ahead.z() == Approx(std::sin(0.3)));
  talk.simulation.advance(talk.wall_s);
  const std::string truth = talk.last("SEN {Time 0.0000} {Type GroundTruth}");
  CHECK(angle_in(truth, "Orientation", 1) == Approx(0.3).margin(0.006));
  CHECK(number_in(truth, "Location", 2) == Approx(-2).margin(0.006));  // above ground: negative
}

TEST_CASE("A place or a rotation that is none is left out, and the log says so") {
  const auto logged = [](const char* groups, std::string_view complaint, const Eigen::Vector3d& p_WB) {
    const WholeLog log;
    Conversation talk;
    talk.send("INIT {ClassName USARBot.Kenaf} " + std::string(groups) + "\r\n");
    REQUIRE(talk.session->robot);
    CHECK(talk.truth().X_WB.p.head<2>() == p_WB.head<2>());
    CHECK(physics::roll_pitch_yaw(talk.truth().X_WB.q).norm() == Approx(0).margin(1e-9));
    return log.has(complaint);
  };
  CHECK(logged("{Location 1,2,-3} {Rotation 0,90}",
               "INIT: Rotation is not roll,pitch,yaw, so it counts as none: \"0,90\"", {1, -2, 0}));
  CHECK(logged("{Location 1,2}", "INIT: Location is not a place", {0, 0, 0}));
}

TEST_CASE("Start names a start pose without case, and wins over Location") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf} {Start START_02} {Location 50,50,0}\r\n");
  REQUIRE(talk.session->robot);
  CHECK(talk.truth().X_WB.p.y() == -2);  // share/worlds/flat.sdf
}

TEST_CASE("Without a place the robot gets the first start pose that is free") {
  Conversation talk;
  Session& other = talk.simulation.connect("other");
  talk.send("INIT {ClassName USARBot.Kenaf}\r\n");
  talk.send(other, "INIT {ClassName USARBot.Kenaf}\r\n");
  REQUIRE(other.robot);
  CHECK(talk.truth().X_WB.p.y() == 0);
  CHECK(talk.simulation.world.truth(other.robot->id).X_WB.p.y() == 2);
  CHECK(other.robot->name != talk.session->robot->name);
}

TEST_CASE("A class that nobody described gets no robot and no answer") {
  for (const char* init : {"INIT {ClassName USARBot.Hercules} {Name R1}\r\n", "INIT {Name R1}\r\n", "INIT\r\n",
                           "INIT {ClassName ../../etc/passwd}\r\n"}) {
    INFO(init);
    Conversation talk;
    CHECK(talk.answer_to(init).empty());
    CHECK_FALSE(talk.run(0.1));
    CHECK(talk.lines().empty());
  }
}

TEST_CASE("A second INIT on one connection is ignored") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf} {Name A}\r\nINIT {ClassName USARBot.P2DX} {Name B}\r\n");
  CHECK(talk.session->robot->name == "A");
  CHECK(talk.simulation.robot_count() == 1);
}

TEST_CASE("Commands back to back, without waiting for the robot, are obeyed in their order") {
  Conversation talk;  // THAF, ROSU
  talk.send("GETSTARTPOSES\r\nINIT {ClassName USARBot.P2DX} {Name R} {Location 0,0,0}\r\nDRIVE {Left 1.0}\r\n");
  REQUIRE(talk.session->robot);
  CHECK(talk.lines("NFO {StartPoses").size() == 1);
  const double radius_m = talk.session->robot->description->drive.sprocket_radius_m;
  CHECK(talk.command().track_speed_mps[robot::kLeft] == Approx(radius_m));
}

TEST_CASE("A line that comes in pieces is one line") {
  Conversation talk;
  for (const char c : std::string_view("INIT {ClassName USARBot.Kenaf} {Name R1}\r\n\r\n\n")) talk.send({&c, 1});
  REQUIRE(talk.session->robot);
  CHECK(talk.session->bad_lines == 0);
}

TEST_CASE("The first output follows INIT at once, further ones every 0.2 s of robot time") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2DX}\r\n");
  REQUIRE(talk.run(1));
  const auto status = talk.lines("STA");
  REQUIRE(status.size() == 6);
  for (std::size_t i = 0; i < status.size(); ++i)
    CHECK(number_in(status[i], "Time") == Approx(0.2 * static_cast<double>(i)));
}

TEST_CASE("UDK's outputs come every 0.1 s") {
  Conversation talk(fast(true));
  talk.send("INIT {ClassName USARBot.P2DX}\r\n");
  REQUIRE(talk.run(1));
  CHECK(talk.lines("STA").size() == 11);
}

TEST_CASE("Start poses are told before INIT, in each dialect's form") {
  Conversation ut2004;
  const std::string groups = ut2004.answer_to("GETSTARTPOSES\r\n");
  CHECK(
      groups.starts_with("NFO {StartPoses 21} {Name start_00 Location 0.0000,0.0000,0.0000 Orientation "
                         "0.0000,0.0000,0.0000} {Name start_01 Location 0.0000,-2.0000,0.0000 Orientation "));
  Conversation udk(fast(true));
  const std::string triplets = udk.answer_to("GetStartPoses\r\n");
  CHECK(
      triplets.starts_with("NFO {StartPoses 21} {start_00 0.0000,0.0000,0.0000 0.0000,0.0000,0.0000 start_01 "
                           "0.0000,-2.0000,0.0000 0.0000,0.0000,0.0000 start_02 "));
  CHECK(triplets.ends_with("0.0000,0.0000,0.0000}"));
}

TEST_CASE("The robot leaves with its connection") {
  Conversation talk;
  Session& other = talk.simulation.connect("other");
  talk.send(other, "INIT {ClassName USARBot.Kenaf}\r\n");
  CHECK(talk.simulation.world.robots().size() == 1);
  talk.simulation.disconnect(other);
  CHECK(talk.simulation.world.robots().empty());
}

TEST_CASE("The option --robot replaces what USARBot.Kenaf is, and nothing else") {
  ServerOptions options = fast();
  options.robot = "p2at";
  Conversation talk(options);
  Session& other = talk.simulation.connect("other");
  talk.send("INIT {ClassName USARBot.Kenaf}\r\n");
  talk.send(other, "INIT {ClassName USARBot.P2DX}\r\n");
  CHECK(talk.session->robot->description->name == "p2at");
  CHECK(other.robot->description->name == "p2dx");
}

TEST_CASE("There is room for 64 robots, and the next one is refused") {
  Conversation talk;
  for (int i = 0; i < 65; ++i) {
    Session& other = talk.simulation.connect("other");
    talk.send(other, "INIT {ClassName USARBot.P2DX} {Location " + std::to_string(2 * i) + ",0,0}\r\n");
    CHECK(other.robot.has_value() == (i < 64));
  }
}

}  // namespace kenaf::world_server
