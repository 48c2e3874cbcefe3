// Frames, commands with {Frame n}, lock step, silence: what makes a result independent of latency.
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

constexpr const char* kPlace = "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n";

struct Framed : Conversation {
  explicit Framed(const char* settings) {
    send(std::string(kPlace) + "CONTROL {Type Session} " + settings + "\r\n");
    REQUIRE(session->robot);
  }
  double left_mps() { return command().track_speed_mps[robot::kLeft]; }
  double radius_m() { return session->robot->description->drive.sprocket_radius_m; }
};

}  // namespace

TEST_CASE("A Session is answered with what is in force: whole time steps") {
  Conversation talk;
  talk.send(kPlace);
  CHECK(talk.answer_to("CONTROL {Type Session} {Period 0.0104} {Lockstep True} {CommandTimeout 0.5}\r\n") ==
        "RES {Time 0.0000} {Type Control} {Name Session} {Status OK} {Period 0.0100} {Lockstep True}");
  CHECK(talk.answer_to("CONTROL {Type Session} {Precision 12}\r\n") ==
        "RES {Time 0.000000000000} {Type Control} {Name Session} {Status OK} {Period 0.010000000000} {Lockstep True}");
}

TEST_CASE("Lock step is not in force before there are frames to answer") {
  Conversation talk;
  talk.send(kPlace);
  CHECK(talk.answer_to("CONTROL {Type Session} {Lockstep True}\r\n").ends_with("{Lockstep False}"));
  CHECK(talk.run(1));
  CHECK(talk.answer_to("CONTROL {Type Session} {Period 0.01}\r\n").ends_with("{Lockstep True}"));
  CHECK_FALSE(talk.run(1));
}

TEST_CASE("A Session that makes no sense changes nothing") {
  Conversation talk;
  talk.send(kPlace);
  for (const char* settings : {"{Period 0}", "{Period -1}", "{Period 11}", "{Period x}", "{Lockstep maybe}",
                               "{CommandTimeout -1}", "{Precision 99}", "{Period 0.01} {Precision -1}"}) {
    INFO(settings);
    const std::string answer = talk.answer_to("CONTROL {Type Session} " + std::string(settings) + "\r\n");
    CHECK(answer.find("{Status Failed} {Reason ") != std::string::npos);
    CHECK_FALSE(talk.session->schedule.numbered());
    CHECK_FALSE(talk.session->extended);
  }
}

TEST_CASE("Frames are numbered from 1, the first at once, one period of robot time apart") {
  Framed talk("{Period 0.01}");
  REQUIRE(talk.run(0.05));
  const auto status = talk.lines("STA");
  REQUIRE(status.size() == 6);
  for (std::size_t i = 0; i < status.size(); ++i) {
    CHECK(number_in(status[i], "Frame") == static_cast<double>(i + 1));
    CHECK(number_in(status[i], "Steps") == static_cast<double>(10 * i));
  }
}

TEST_CASE("A Session that comes before INIT holds for the robot that follows") {
  Conversation talk;
  talk.send("CONTROL {Type Session} {Period 0.02}\r\n" + std::string(kPlace));
  REQUIRE(talk.run(0.1));
  const auto status = talk.lines("STA");
  CHECK(status.size() == 6);
  CHECK(number_in(status.front(), "Frame") == 1);
}

TEST_CASE("A command with a frame takes effect exactly when the next frame begins") {
  Framed talk("{Period 0.01}");
  REQUIRE(talk.run(0.003));
  talk.send("DRIVE {Left 1} {Right 1} {Frame 1}\r\n");
  REQUIRE(talk.run(0.006));  // step 9
  CHECK(talk.left_mps() == 0);
  REQUIRE(talk.run(0.001));  // step 10: frame 2 begins
  CHECK(talk.left_mps() == Approx(talk.radius_m()));
  CHECK(number_in(talk.last("STA"), "Late") == 0);
}

TEST_CASE("Flippers and SET keep to their frame too, and are answered when they take effect") {
  Framed talk("{Period 0.01}");
  REQUIRE(talk.run(0.001));
  talk.lines();
  talk.send(
      "MULTIDRIVE {RRFlipper 0.5} {Frame 1}\r\nSET {Type Joint} {Name RLFlipper} {Opcode Angle} {Params 0.5} "
      "{Frame 1}\r\n");
  CHECK(talk.lines("RES").empty());
  CHECK(talk.command().flipper[robot::kRearRight].value != 0.5);
  REQUIRE(talk.run(0.009));
  CHECK(talk.command().flipper[robot::kRearRight].value == 0.5);
  CHECK(talk.command().flipper[robot::kRearLeft].value == 0.5);
  CHECK(talk.last("RES") == "RES {Time 0.0100} {Type Joint} {Name RLFlipper} {Status OK}");
}

TEST_CASE("A command that comes late takes effect at once and is counted, one of a coming frame is ignored") {
  Framed talk("{Period 0.01}");
  REQUIRE(talk.run(0.025));  // frame 3 is the newest
  talk.send("MULTIDRIVE {RRFlipper 0.5} {Frame 2}\r\nDRIVE {Left 1} {Right 1} {Frame 2}\r\n");
  CHECK(talk.left_mps() == Approx(talk.radius_m()));
  REQUIRE(talk.run(0.005));
  CHECK(number_in(talk.last("STA"), "Late") == 1);
  talk.send("DRIVE {Left 2} {Right 2} {Frame 99}\r\n");
  REQUIRE(talk.run(0.02));
  CHECK(talk.left_mps() == Approx(talk.radius_m()));
  CHECK(number_in(talk.last("STA"), "Late") == 1);
}

TEST_CASE("Of two answers to one frame the newest wins") {
  Framed talk("{Period 0.01}");
  REQUIRE(talk.run(0.001));
  talk.send("DRIVE {Left 1} {Right 1} {Frame 1}\r\nDRIVE {Left 2} {Right 2} {Frame 1}\r\n");
  REQUIRE(talk.run(0.009));
  CHECK(talk.left_mps() == Approx(2 * talk.radius_m()));
}

TEST_CASE("Lock step: robot time waits for the answer, then goes on at once") {
  Framed talk("{Period 0.01} {Lockstep True}");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 10);
  CHECK(number_in(talk.last("STA"), "Frame") == 1);
  for (int frame = 1; frame < 20; ++frame) {
    talk.send("DRIVE {Left 1} {Right 1} {Frame " + std::to_string(frame) + "}\r\n");
    CHECK_FALSE(talk.run(1));
    CHECK(talk.simulation.world.step_count() == 10u * static_cast<unsigned>(frame + 1));
    CHECK(number_in(talk.last("STA"), "Frame") == frame + 1);
  }
}

TEST_CASE("Lock step waits two seconds of wall-clock time, then runs until the client is back") {
  Framed talk("{Period 0.01} {Lockstep True}");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.advance(talk.wall_s).wake_s == Approx(talk.wall_s + 2));
  talk.wall_s += 1.99;
  CHECK_FALSE(talk.run(1));
  talk.wall_s += 0.02;
  REQUIRE(talk.run(0.015));
  REQUIRE(talk.run(0.1));
  const double newest = number_in(talk.last("STA"), "Frame");
  talk.send("DRIVE {Left 1} {Right 1} {Frame " + std::to_string(static_cast<int>(newest)) + "}\r\n");
  CHECK_FALSE(talk.run(1));  // in step again: the frame after it is not answered
  CHECK(number_in(talk.last("STA"), "Frame") == newest + 1);
}

TEST_CASE("Time that is paused is not time that lock step waited") {
  Framed talk("{Period 0.01} {Lockstep True}");
  talk.send("CONTROL {Type Pause}\r\n");
  talk.wall_s += 10;
  CHECK_FALSE(talk.run(1));
  talk.send("CONTROL {Type Resume}\r\n");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 10);
}

TEST_CASE("Two clients in lock step wait for each other, and a plain one does not hold them") {
  Framed talk("{Period 0.01} {Lockstep True}");
  Session& other = talk.simulation.connect("other");
  Session& plain = talk.simulation.connect("plain");
  talk.send(other, "INIT {ClassName USARBot.P2DX}\r\nCONTROL {Type Session} {Period 0.02} {Lockstep True}\r\n");
  talk.send(plain, "INIT {ClassName USARBot.P2DX}\r\n");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 10);
  talk.send("DRIVE {Left 0} {Right 0} {Frame 1}\r\n");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 20);
  talk.send("DRIVE {Left 0} {Right 0} {Frame 2}\r\n");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 20);  // the other holds it
  talk.send(other, "DRIVE {Left 0} {Right 0} {Frame 1}\r\n");
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 30);
  talk.simulation.disconnect(*talk.session);  // and who leaves holds nobody
  talk.session = &other;
  CHECK_FALSE(talk.run(1));
  CHECK(talk.simulation.world.step_count() == 40);
}

TEST_CASE("When an answer comes within its frame does not change the path by a bit") {
  const auto drive = [](double answer_after_s) {
    Framed talk("{Period 0.01} {Precision 15}");
    for (int frame = 1; frame <= 100; ++frame) {
      REQUIRE(talk.run(answer_after_s));
      const double left = 1 + 0.02 * frame, right = 3 - 0.05 * frame;
      talk.send("DRIVE {Left " + std::to_string(left) + "} {Right " + std::to_string(right) + "} {Frame " +
                std::to_string(frame) + "}\r\n");
      REQUIRE(talk.run(0.01 - answer_after_s));
    }
    return talk.lines();
  };
  CHECK(drive(0.001) == drive(0.009));
}

TEST_CASE("A silent commander's robot stops, flippers hold their angle, and STA says so until the next command") {
  Framed talk("{Period 0.01} {CommandTimeout 0.3}");
  talk.send("DRIVE {Left 3} {Right 3}\r\nMULTIDRIVE {RRFlipper 0.5}\r\n");
  talk.send("SET {Type Joint} {Name RLFlipper} {Opcode Velocity} {Params 0.5}\r\n");
  REQUIRE(talk.run(0.29));
  CHECK(talk.last("STA").find("Silent") == std::string::npos);
  CHECK(talk.left_mps() > 0);
  REQUIRE(talk.run(0.01));
  CHECK(talk.last("STA").find("{Silent True}") != std::string::npos);
  CHECK(talk.left_mps() == 0);
  CHECK(talk.command().flipper[robot::kRearRight].value == 0.5);
  CHECK(talk.command().flipper[robot::kRearLeft].mode == robot::JointMode::brake);
  REQUIRE(talk.run(0.2));  // 0.5 s after the last command it stands
  CHECK(std::abs(talk.truth().v_WB_mps.x()) < 0.02);
  talk.send("DRIVE {Left 3}\r\n");
  REQUIRE(talk.run(0.01));
  CHECK(talk.last("STA").find("Silent") == std::string::npos);
  CHECK(talk.left_mps() > 0);
  CHECK(talk.command().track_speed_mps[robot::kRight] == 0);
}

TEST_CASE("A part of a curve does not bring back the speed that silence took") {
  Framed talk("{Period 0.01} {CommandTimeout 0.3}");
  talk.send("DRIVE {Speed 3} {FrontSteer 0}\r\n");
  REQUIRE(talk.run(0.5));
  REQUIRE(talk.session->silent);
  talk.send("DRIVE {FrontSteer 0.1}\r\n");
  CHECK(talk.left_mps() == 0);
}

TEST_CASE("Whoever keeps commanding is not stopped, and a plain client never is") {
  Framed talk("{Period 0.01} {CommandTimeout 0.1}");
  for (int i = 0; i < 20; ++i) {
    talk.send("DRIVE {Left 3} {Right 3}\r\n");
    REQUIRE(talk.run(0.09));
    CHECK(talk.left_mps() > 0);
  }
  Conversation plain;
  plain.send(std::string(kPlace) + "DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(plain.run(5));
  CHECK(plain.command().track_speed_mps[robot::kLeft] > 0);
}

TEST_CASE("A frame without a Session's period is no frame") {
  Conversation talk;
  talk.send(std::string(kPlace) + "DRIVE {Left 1} {Right 1} {Frame 5}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] > 0);
}

}  // namespace kenaf::world_server
