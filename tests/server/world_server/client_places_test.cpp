// Classes, start poses and names that clients of 2011 to 2016 have in their sources and launch files, whatever world
// is served.
#include "server/world_server/start_poses.hpp"
#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

std::string init(const std::string& class_name, const std::string& groups = "") {
  return "INIT {ClassName USARBot." + class_name + "} {Name R1} " + groups + "\r\n";
}

bool is_name_listed(const std::string& start_poses, const std::string& name, bool udk) {
  const std::string ut2004_form = "{Name " + name + " Location ";
  return start_poses.find(udk ? " " + name + " " : ut2004_form) != std::string::npos;
}

}  // namespace

TEST_CASE("UDK's default robots drive") {
  for (const char* class_name : {"P3AT", "p3at", "BasicSkidRobot"}) {
    INFO(class_name);
    Conversation talk(fast(true));
    talk.send("INIT {Classname USARBot." + std::string(class_name) + "} {Name R1} {Location 0,0,0}\r\n");
    REQUIRE(talk.session->robot);
    talk.send("DRIVE {Left 1} {Right 1}\r\n");
    REQUIRE(talk.run(2));
    const double radius_m = talk.session->robot->description->drive.sprocket_radius_m;
    CHECK(talk.truth().X_WB.p.x() == Approx(1.9 * radius_m).epsilon(0.05));  // 1 rad/s, less 0.1 s to get there
    const double before_rad = physics::roll_pitch_yaw(talk.truth().X_WB.q).z();
    talk.send("DRIVE {Left -1} {Right 1}\r\n");
    REQUIRE(talk.run(2));
    CHECK(physics::roll_pitch_yaw(talk.truth().X_WB.q).z() > before_rad + 0.1);
  }
}

TEST_CASE("The usual names of start poses are listed, and found") {
  const bool udk = GENERATE(false, true);
  Conversation talk(fast(udk));
  const std::string listed = talk.answer_to("GETSTARTPOSES\r\n");
  for (const char* name : {"PlayerStart", "RobotStart1", "RobotStart2", "RobotStart3", "RobotStart4"}) {
    INFO(name);
    CHECK(is_name_listed(listed, name, udk));
  }
  // share/worlds/flat.sdf: start_00 at y = 0, start_01 at y = 2, start_02 at y = -2, start_03 at y = 4
  for (const auto& [name, y_m] : {std::pair{"playerstart", 0.0},
                                  {"RobotStart1", 0.0},
                                  {"RobotStart2", 2.0},
                                  {"ROBOTSTART3", -2.0},
                                  {"RobotStart4", 4.0},
                                  {"start_03", 4.0}}) {
    INFO(name);
    Conversation placed(fast(udk));
    const WholeLog log;
    placed.send(init("P3AT", "{Start " + std::string(name) + "}"));
    REQUIRE(placed.session->robot);
    CHECK(placed.truth().X_WB.p.y() == y_m);
    CHECK_FALSE(log.has("warning"));
  }
}

TEST_CASE("The list begins with the world's own names, and their count is that of all") {
  Conversation talk;
  const std::string listed = talk.answer_to("GETSTARTPOSES\r\n");
  CHECK(listed.starts_with("NFO {StartPoses 21} {Name start_00 "));
  CHECK(listed.ends_with("{Name RobotStart4 Location 0.0000,-4.0000,0.0000 Orientation 0.0000,0.0000,0.0000}"));
}

TEST_CASE("A world has only as many usual names as start poses, and its own name of that kind is its own") {
  physics::WorldDescription world;
  world.start_poses = {{"robotstart1", {{7, 0, 0}, Eigen::Quaterniond::Identity()}},
                       {"start_b", {{8, 0, 0}, Eigen::Quaterniond::Identity()}}};
  std::vector<std::string> names;
  for (const physics::StartPose& start : offered_start_poses(world)) names.push_back(start.name);
  CHECK(names == std::vector<std::string>{"robotstart1", "start_b", "PlayerStart", "RobotStart2"});
  CHECK(find_start_pose(world, "PlayerStart")->p.x() == 7);
  CHECK(find_start_pose(world, "RobotStart2")->p.x() == 8);
  CHECK_FALSE(find_start_pose(world, "RobotStart3"));
}

TEST_CASE("A start pose that no world here has is another one, and the log says so") {
  const bool udk = GENERATE(false, true);
  Conversation talk(fast(udk));
  const WholeLog log;
  talk.send(init("P3AT", "{Start Robot_7}"));
  REQUIRE(talk.session->robot);
  CHECK(talk.truth().X_WB.p.head<2>().norm() == 0);  // the first start pose
  CHECK(log.has("no such start pose"));
  CHECK(log.has("Robot_7"));
  // the next robot gets the next place, and Location counts where Start names nothing
  Session& second = talk.simulation.connect("second");
  talk.send(second, init("P3AT", "{Start Robot_7}"));
  CHECK(talk.simulation.world.truth(second.robot->id).X_WB.p.y() == 2);
  Session& third = talk.simulation.connect("third");
  talk.send(third, init("P3AT", "{Start Robot_7} {Location 5,6,0}"));
  CHECK(talk.simulation.world.truth(third.robot->id).X_WB.p.x() == 5);
}

TEST_CASE("A client with a Session gets no robot at a start pose that does not exist") {
  Conversation talk;
  const WholeLog log;
  talk.send("CONTROL {Type Session} {Period 0.01}\r\n" + init("P3AT", "{Start Robot_7}"));
  CHECK_FALSE(talk.session->robot);
  CHECK(log.has("INIT refused: no such start pose"));
}

TEST_CASE("Two robots of one name are both told of, in the log and to clients that have a Session") {
  Conversation talk;
  talk.send("CONTROL {Type Session} {Period 0.01}\r\n" + init("P3AT"));
  talk.lines();
  const WholeLog log;
  Session& plain = talk.simulation.connect("plain");
  talk.send(plain, "INIT {ClassName USARBot.P3AT} {Name r1}\r\n");
  REQUIRE(plain.robot);
  CHECK(log.has("plain: robot r1 has the name of the robot of test"));
  const std::string warning = "{Type Robot} {Name R1} {Status OK} {Warning another robot has the same name}";
  CHECK(talk.last("RES").ends_with(warning));
  for (const std::string& line : talk.lines(plain)) CHECK_FALSE(line.starts_with("RES"));

  Session& third = talk.simulation.connect("third");
  talk.send(third,
            "INIT {ClassName USARBot.P3AT} {Name R2} {Location 3,3,0}\r\nCONTROL {Type Session} {Period 0.01}\r\n");
  CHECK_FALSE(log.has("robot R2 has"));
}

TEST_CASE("Two robots in one place are both told of, and two side by side are not") {
  Conversation talk;
  talk.send("CONTROL {Type Session} {Period 0.01}\r\n" + init("P3AT", "{Location 4,0,0}"));
  talk.lines();
  const WholeLog log;
  const std::string warning = "{Type Robot} {Name R1} {Status OK} {Warning another robot is in the same place}";
  Session& beside = talk.simulation.connect("beside");
  talk.send(beside, "INIT {ClassName USARBot.P3AT} {Name R2} {Location 4,1,0}\r\n");
  CHECK_FALSE(log.has("stands: they push"));
  Session& upon = talk.simulation.connect("upon");
  talk.send(upon, "INIT {ClassName USARBot.P3AT} {Name R3} {Location 4.1,0.1,0}\r\n");
  REQUIRE(upon.robot);
  CHECK(log.has("upon: robot R3 is placed where robot R1 of test stands"));
  CHECK(talk.last("RES").ends_with(warning));
}

}  // namespace kenaf::world_server
