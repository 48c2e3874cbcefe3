// Pause, step, speed, reset, ping: what USARSim's users lacked.
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

Conversation with_robot(double speed = 0) {
  ServerOptions options = fast();
  options.speed = speed;
  Conversation talk(options);
  talk.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  return talk;
}

constexpr const char* kOk = "RES {Time 0.0000} {Type Control} {Name ";

}  // namespace

TEST_CASE("A paused world stands still until it is resumed") {
  Conversation talk = with_robot();
  CHECK(talk.answer_to("CONTROL {Type Pause}\r\n") == std::string(kOk) + "Pause} {Status OK}");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 0);
  CHECK(talk.answer_to("CONTROL {Type resume}\r\n") == std::string(kOk) + "resume} {Status OK}");
  CHECK(talk.run(1));
}

TEST_CASE("Clients with a Session are told of a pause by an STA that repeats their newest frame") {
  Conversation talk = with_robot();
  talk.send("CONTROL {Type Session} {Period 0.01}\r\n");
  REQUIRE(talk.run(0.025));
  talk.lines();
  talk.send("CONTROL {Type Pause}\r\n");
  std::string status = talk.last("STA");
  CHECK(number_in(status, "Frame") == 3);
  CHECK(status.find("{Paused True}") != std::string::npos);
  talk.send("CONTROL {Type Resume}\r\n");
  CHECK(talk.last("STA").find("{Paused False}") != std::string::npos);
}

TEST_CASE("A reset forgets what earlier commands a later one would build on") {
  Conversation talk = with_robot();
  talk.send("DRIVE {Speed 50} {FrontSteer 0} {Normalized True}\r\n");
  talk.send("DRIVE {LinearVelocity 0.4} {RotationalVelocity 0}\r\nCONTROL {Type Reset}\r\n");
  talk.send("DRIVE {FrontSteer 0.1}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] == 0);
  talk.send("DRIVE {RotationalVelocity 0}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] == 0);
  talk.send("DRIVE {Left 2}\r\n");  // rad/s again, no per cent
  CHECK(talk.command().track_speed_mps[robot::kLeft] ==
        Approx(2 * talk.session->robot->description->drive.sprocket_radius_m));
}

TEST_CASE("A step runs exactly as long as it is asked to, pauses, and is answered when it is done") {
  Conversation talk = with_robot();
  CHECK(talk.answer_to("CONTROL {Type Step} {Time 0.5}\r\n").empty());
  CHECK_FALSE(talk.run(10));
  CHECK(talk.simulation.world.step_count() == 500);
  CHECK(talk.last("RES") == "RES {Time 0.5000} {Type Control} {Name Step} {Status OK}");
  talk.send("CONTROL {Type Step} {Steps 7}\r\nCONTROL {Type Step} {Steps 3}\r\n");
  CHECK_FALSE(talk.run(10));
  CHECK(talk.simulation.world.step_count() == 510);
  CHECK(talk.lines("RES").size() == 2);
}

TEST_CASE("A step that makes no sense is refused") {
  Conversation talk = with_robot();
  for (const char* step :
       {"", "{Time 0}", "{Time -1}", "{Time 1e9}", "{Steps 0}", "{Steps 0.5}", "{Steps 1e18}", "{Time x}"}) {
    INFO(step);
    const std::string answer = talk.answer_to("CONTROL {Type Step} " + std::string(step) + "\r\n");
    CHECK(answer == std::string(kOk) + "Step} {Status Failed}");
  }
  CHECK_FALSE(talk.simulation.clock.paused());
}

TEST_CASE("Of steps that wait for each other no more are taken than 1000") {
  Conversation talk = with_robot();
  for (int i = 0; i < 1000; ++i) CHECK(talk.answer_to("CONTROL {Type Step} {Steps 1}\r\n").empty());
  CHECK(talk.answer_to("CONTROL {Type Step} {Steps 1}\r\n").starts_with(std::string(kOk) + "Step} {Status Failed}"));
  CHECK_FALSE(talk.run(2));
  CHECK(talk.simulation.world.step_count() == 1000);
  CHECK(talk.answer_to("CONTROL {Type Step} {Steps 1}\r\n").empty());
}

TEST_CASE("The speed is a factor of wall-clock time") {
  Conversation talk = with_robot(1);
  const auto steps_in_a_second = [&] {
    const std::uint64_t before = talk.simulation.world.step_count();
    for (int i = 0; i < 100; ++i) {
      talk.wall_s += 0.01;
      while (talk.simulation.advance(talk.wall_s).stepped) {
      }
    }
    return static_cast<double>(talk.simulation.world.step_count() - before);
  };
  talk.simulation.advance(talk.wall_s);
  CHECK(steps_in_a_second() == Approx(1000).margin(2));
  talk.send("CONTROL {Type Speed} {Value 0.25}\r\n");
  CHECK(steps_in_a_second() == Approx(250).margin(2));
  talk.send("CONTROL {Type Speed} {Value 3}\r\n");
  CHECK(steps_in_a_second() == Approx(3000).margin(2));
  CHECK(talk.answer_to("CONTROL {Type Speed} {Value -1}\r\n").find("{Status Failed}") != std::string::npos);
  CHECK(talk.answer_to("CONTROL {Type Speed}\r\n").find("{Status Failed}") != std::string::npos);
}

namespace {

// To a millionth of a step, far less than Approx leaves by itself beside a time of 100 s.
Approx exactly(double wall_s) {
  return Approx(wall_s).epsilon(0).margin(1e-9);
}

}  // namespace

TEST_CASE("No time passes, and nothing is owed, while no robot is there") {
  ServerOptions options = fast();
  options.speed = 1;
  Conversation talk(options);
  CHECK_FALSE(talk.simulation.advance(talk.wall_s).wake_s);
  talk.wall_s += 3600;
  talk.send("INIT {ClassName USARBot.P2DX}\r\n");
  talk.simulation.advance(talk.wall_s);
  CHECK(talk.simulation.world.step_count() == 0);
  CHECK(talk.simulation.advance(talk.wall_s).wake_s == exactly(talk.wall_s + 0.005));
}

TEST_CASE("The world sleeps until somebody is told something, at most 5 ms, and who asks finds it up to date") {
  ServerOptions options = fast();
  options.speed = 1;
  Conversation talk(options);
  talk.send("INIT {ClassName USARBot.Kenaf}\r\n");
  talk.simulation.advance(talk.wall_s);
  const double start_s = talk.wall_s;
  CHECK(talk.simulation.advance(talk.wall_s).wake_s == exactly(start_s + 0.005));

  // 3.5 ms later three steps of 1 ms are due, which nobody has seen.
  talk.wall_s = start_s + 0.0035;
  CHECK(talk.simulation.world.step_count() == 0);
  talk.simulation.catch_up(talk.wall_s);
  CHECK(talk.simulation.world.step_count() == 3);
  talk.simulation.catch_up(talk.wall_s);
  CHECK(talk.simulation.world.step_count() == 3);

  // Who is to be called after the sixth step is called at its time.
  std::uint64_t called_at = 0;
  talk.simulation.call_at(&called_at, 6, [&](Simulation& then) { called_at = then.world.step_count(); });
  CHECK(talk.simulation.advance(talk.wall_s).wake_s == exactly(start_s + 0.006));
  talk.wall_s = start_s + 0.006;
  while (talk.simulation.advance(talk.wall_s).stepped) {
  }
  CHECK(called_at == 6);

  // And so is a client that gets an output every 2 ms.
  talk.send("CONTROL {Type Session} {Period 0.002}\r\n");
  CHECK(talk.simulation.advance(talk.wall_s).wake_s == exactly(start_s + 0.008));
}

TEST_CASE("A reset puts the robot back to its start, at rest, at time 0, and the frames go on") {
  Conversation talk = with_robot();
  talk.send("CONTROL {Type Session} {Period 0.01}\r\n");
  const Eigen::Vector3d start = talk.truth().X_WB.p;
  talk.send("DRIVE {Left 3} {Right 3}\r\nMULTIDRIVE {RRFlipper 0}\r\n");
  REQUIRE(talk.run(1));
  CHECK(talk.truth().X_WB.p.x() > start.x() + 0.05);
  CHECK(talk.last("STA").find("{Frame 101}") != std::string::npos);
  CHECK(talk.answer_to("CONTROL {Type Reset}\r\n") == std::string(kOk) + "Reset} {Status OK}");
  CHECK(talk.truth().X_WB.p == start);
  CHECK(talk.simulation.world.step_count() == 0);
  talk.simulation.advance(talk.wall_s);
  const std::string status = talk.last("STA");
  CHECK(number_in(status, "Time") == 0);
  CHECK(number_in(status, "Frame") == 102);
  REQUIRE(talk.run(1));
  CHECK(std::abs(talk.truth().X_WB.p.x() - start.x()) < 0.005);  // it was commanded to stop
}

TEST_CASE("After a reset the same commands give the same path, to the bit") {
  Conversation talk = with_robot();
  const auto drive = [&] {
    talk.lines();
    talk.send("DRIVE {Left 3} {Right 2}\r\n");
    REQUIRE(talk.run(1));
    return talk.lines("SEN");
  };
  const auto first = drive();
  talk.send("CONTROL {Type Reset}\r\n");
  CHECK(drive() == first);
}

TEST_CASE("A ping is answered at once, paused or not, and before INIT") {
  Conversation talk;
  CHECK(talk.answer_to("PING {Id 7}\r\n") == "PONG {Id 7} {Time 0.0000}");
  talk.send("CONTROL {Type Pause}\r\n");
  CHECK(talk.answer_to("ping {id 8}\r\n") == "PONG {Id 8} {Time 0.0000}");
}

TEST_CASE("UDK's dialect answers extensions all the same") {
  Conversation talk(fast(true));
  CHECK(talk.answer_to("CONTROL {Type Pause}\r\n") == "RES {Time 0.0000} {Type Control} {Name Pause} {Status OK}");
}

TEST_CASE("A CONTROL that nobody knows is refused in words") {
  Conversation talk = with_robot();
  talk.send("CONTROL {Type Session}\r\n");
  CHECK(talk.answer_to("CONTROL {Type Explode}\r\n") ==
        "RES {Time 0.0000} {Type Control} {Name Explode} {Status Failed} {Reason this server has no such CONTROL}");
  CHECK(talk.answer_to("CONTROL\r\n").find("{Status Failed}") != std::string::npos);
}

}  // namespace kenaf::world_server
