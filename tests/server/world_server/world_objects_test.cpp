// CONTROL as the UDK server's WorldController had it.
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

struct Controller : Conversation {
  Controller() {
    send("INIT {ClassName USARBotAPI.WorldController}\r\n");
    lines();
  }
  std::string control(const std::string& groups) { return answer_to("CONTROL " + groups + "\r\n"); }
  bool ok(const std::string& groups) { return control(groups).ends_with("{Status OK}"); }
};

}  // namespace

TEST_CASE("A world controller is no robot: it gets no outputs and lets no time pass") {
  Controller controller;
  CHECK_FALSE(controller.run(1));
  CHECK(controller.lines().empty());
}

TEST_CASE("Boxes are created, moved, told and removed, in USARSim's frame") {
  Controller controller;
  CHECK(
      controller.ok("{Type Create} {ClassName USARPhysObj.SmallBox} {Name B1} {Location 1,2,-3} {Rotation 0,0,0.5} "
                    "{Scale 0.5,0.25,0.125} {Physics None}"));
  CHECK(controller.control("{Type GetSTA}") ==
        "STA {Name B1} {Size 0.5000,0.2500,0.1250} {Location 1.0000,2.0000,-3.0000} {Rotation 0.0000,0.0000,0.5000}");
  REQUIRE(controller.simulation.objects.size() == 1);
  const physics::Pose X_WBox = controller.simulation.world.box_pose(controller.simulation.objects[0].box);
  CHECK(X_WBox.p.y() == -2);
  CHECK(X_WBox.p.z() == 3);
  CHECK(physics::roll_pitch_yaw(X_WBox.q).z() == Approx(-0.5));
  CHECK(controller.ok("{Type RelMove} {Name b1} {Location 0.5,0,0} {Rotation 0,0,0.25}"));
  CHECK(controller.control("{Type GetSTA} {Name B1}")
            .find("{Location 1.5000,2.0000,-3.0000} {Rotation 0.0000,0.0000,0.7500}") != std::string::npos);
  CHECK(controller.ok("{Type AbsMove} {Name B1} {Location 0,0,-1}"));
  CHECK(controller.control("{Type GetSTA}").find("{Location 0.0000,0.0000,-1.0000} {Rotation 0.0000,0.0000,0.7500}") !=
        std::string::npos);
  CHECK(controller.ok("{Type Kill} {Name B1}"));
  CHECK(controller.control("{Type GetSTA}") == "STA");
  CHECK_FALSE(controller.ok("{Type Kill} {Name B1}"));
}

TEST_CASE("Moves that add up end at 100 km, and the server goes on") {
  Controller controller;
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name A} {Location 90000,90000,-90000}"));
  CHECK_FALSE(controller.ok("{Type RelMove} {Name A} {Location 90000,90000,-90000}"));
  CHECK(controller.control("{Type GetSTA}").find("{Location 90000.0000,90000.0000,-90000.0000}") != std::string::npos);
  CHECK(controller.ok("{Type RelMove} {Name A} {Location -90000,-90000,90000}"));
  CHECK(controller.control("{Type GetSTA}").find("{Location 0.0000,0.0000,0.0000}") != std::string::npos);
}

TEST_CASE("GetSTA tells objects by name or class, all in one line") {
  Controller controller;
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name A} {Location 0,0,-1}"));
  CHECK(controller.ok("{Type Create} {ClassName Block} {Name B} {Location 5,0,-1}"));
  const std::string both = controller.control("{Type GetSTA}");
  CHECK(both.find("{Name A}") != std::string::npos);
  CHECK(both.find("{Name B}") != std::string::npos);
  CHECK(controller.control("{Type GetSTA} {ClassName block}").find("{Name A}") == std::string::npos);
  CHECK(controller.control("{Type GetSTA} {Name a}").find("{Name B}") == std::string::npos);
}

TEST_CASE("An object is found by the name that it was given, whatever the server shows of it") {
  // UTF-8's two bytes of the umlaut are shown as two question marks, and of 70 bytes 64 are.
  for (const std::string& name : {std::string("Kiste_\xc3\xa4"), std::string(70, 'n')}) {
    INFO(name);
    Controller controller;
    CHECK(controller.ok("{Type Create} {ClassName Box} {Name " + name + "} {Location 0,0,-1}"));
    CHECK_FALSE(controller.ok("{Type Create} {ClassName Box} {Name " + name + "} {Location 9,0,-1}"));
    CHECK(controller.ok("{Type AbsMove} {Name " + name + "} {Location 5,0,-1}"));
    CHECK(controller.control("{Type GetSTA} {Name " + name + "}").find("{Location 5.0000,0.0000,-1.0000}") !=
          std::string::npos);
    CHECK(controller.ok("{Type Kill} {Name " + name + "}"));
    CHECK(controller.control("{Type GetSTA}") == "STA");
  }
}

TEST_CASE("A robot is found by the name that it was given, whatever the server shows of it") {
  Controller controller;
  Session& robot = controller.simulation.connect("robot");
  controller.send(robot, "INIT {ClassName USARBot.Kenaf} {Name R\xc3\xa4} {Location 0,0,0}\r\n");
  CHECK(controller.ok("{Type AbsMove} {Name R\xc3\xa4} {Location 3,-2,-1}"));
  CHECK(controller.control("{Type GetSTA} {Name R\xc3\xa4}").starts_with("STA {Name R??} {Location 3.0000,"));
}

TEST_CASE("KillAll takes what is inside its corners, or everything, a permanent object stays") {
  Controller controller;
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name A} {Location 0,0,-1}"));
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name B} {Location 5,0,-1}"));
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name C} {Location 9,0,-1} {Permanent true}"));
  CHECK(controller.ok("{Type KillAll} {MinPos 4,-1,-2} {MaxPos 6,1,0}"));
  CHECK(controller.simulation.objects.size() == 2);
  CHECK(controller.ok("{Type KillAll}"));
  REQUIRE(controller.simulation.objects.size() == 1);
  CHECK(controller.simulation.objects[0].name == "C");
}

TEST_CASE("A robot is moved by its name") {
  Controller controller;
  Session& robot = controller.simulation.connect("robot");
  controller.send(robot, "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  CHECK(controller.ok("{Type AbsMove} {Name R1} {Location 3,-2,-1} {Rotation 0,0,1}"));
  const physics::Pose X_WB = controller.simulation.world.truth(robot.robot->id).X_WB;
  CHECK(X_WB.p.isApprox(Eigen::Vector3d(3, 2, 1)));
  CHECK(physics::roll_pitch_yaw(X_WB.q).z() == Approx(-1));
}

TEST_CASE("A box with RigidBody falls, one without stays where it is") {
  Controller controller;
  Session& robot = controller.simulation.connect("robot");
  controller.send(robot, "INIT {ClassName USARBot.P2DX} {Location 0,0,0}\r\n");
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name A} {Location 10,0,-5} {Physics RigidBody}"));
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name B} {Location 20,0,-5}"));
  REQUIRE(controller.run(0.5));
  // g t^2 / 2 = 1.226 m after half a second
  CHECK(controller.simulation.world.box_pose(controller.simulation.objects[0].box).p.z() ==
        Approx(5 - 1.226).margin(0.01));
  CHECK(controller.simulation.world.box_pose(controller.simulation.objects[1].box).p.z() == 5);
}

TEST_CASE("What cannot be done is refused with a reason") {
  Controller controller;
  controller.send("CONTROL {Type Session}\r\n");
  CHECK(controller.ok("{Type Create} {ClassName Box} {Name A} {Location 0,0,-1}"));
  for (const char* groups :
       {"{Type Create} {ClassName USARPhysObj.Forklift} {Name F} {Location 0,0,0}",
        "{Type Create} {ClassName Box} {Name A} {Location 0,0,0}", "{Type Create} {ClassName Box} {Location 0,0,0}",
        "{Type Create} {ClassName Box} {Name Z} {Location 0,0}",
        "{Type Create} {ClassName Box} {Name Z} {Location 0,0,0} {Rotation 0,90}",
        "{Type Create} {ClassName Box} {Name Z} {Location 0,0,1e300}",
        "{Type Create} {ClassName Box} {Name Z} {Location 0,0,0} {Scale 0,1,1}",
        "{Type Create} {ClassName Box} {Name Z} {Location 0,0,0} {Scale 1,1}", "{Type Create}",
        "{Type AbsMove} {Name Nobody} {Location 0,0,0}", "{Type AbsMove} {Name A} {Location x}", "{Type Kill}",
        "{Type Conveyor} {Name A}", "{Type SetWP} {Name A} {WP 0,0,0;1,1,1}", "{Type Rotate} {Name A} {Speed 0,0,1}"}) {
    INFO(groups);
    CHECK(controller.control(groups).find("{Status Failed} {Reason ") != std::string::npos);
  }
  CHECK(controller.simulation.objects.size() == 1);
}

}  // namespace kenaf::world_server
