#include "relayd/world_handshake.hpp"

#include <catch2/catch.hpp>

using namespace kenaf;
using namespace kenaf::relayd;
using namespace std::chrono_literals;

namespace {

using Result = WorldHandshake::Result;

struct Conversation {
  explicit Conversation(const RobotPlacement& placement = {}) : handshake(placement, {0.01, true, 0.5}, now) {}

  // What the relay answers.
  std::string hears(std::string_view line) {
    protocol::usarsim::MessageView message;
    protocol::usarsim::parse_message(line, message);
    std::string out;
    handshake.on_message(message, message.is("STA"), now, out);
    return out;
  }
  std::string waits(std::chrono::milliseconds time) {
    now += time;
    std::string out;
    handshake.on_time(now, out);
    return out;
  }

  WorldHandshake::TimePoint now{};
  WorldHandshake handshake;
};

constexpr const char* kAccepted =
    "RES {Time 3} {Type Control} {Name Session} {Status OK} {Period 0.01} {Lockstep True}";

}  // namespace

TEST_CASE("A server with the extensions: one piece after its greeting, done with its first frame") {
  Conversation talk;
  CHECK(talk.hears("NFO {Gametype BotDeathMatch} {Level flat}") ==
        "CONTROL {Type Session} {Period 0.010000000000} {Lockstep True} {CommandTimeout 0.500000000000} "
        "{Precision 12}\r\n"
        "INIT {ClassName USARBot.Kenaf} {Name Kenaf}\r\n"
        "GETCONF {Type Robot}\r\nGETGEO {Type Robot}\r\nGETCONF {Type Encoder}\r\n");
  CHECK(talk.hears(kAccepted).empty());
  CHECK(talk.hears("GEO {Type GroundVehicle} {WheelRadius 0.05}").empty());
  CHECK(talk.hears("CONF {Type Encoder} {Name ECLeft} {Resolution 0.01}").empty());
  CHECK(talk.handshake.result() == Result::pending);
  talk.hears("STA {Time 3} {Frame 1}");
  CHECK(talk.handshake.result() == Result::extended);
  CHECK(talk.handshake.ready().robot_time_s == 3);
  CHECK(talk.handshake.ready().period_s == 0.01);
  CHECK(talk.handshake.ready().lockstep);
}

TEST_CASE("A plain server: a robot, but no answer to CONTROL") {
  Conversation talk;
  talk.hears("NFO {Gametype BotDeathMatch}");
  talk.hears("STA {Time 1}");
  talk.waits(499ms);
  CHECK(talk.handshake.result() == Result::pending);
  talk.hears("STA {Time 1.2}");  // does not make it wait longer
  talk.waits(1ms);
  CHECK(talk.handshake.result() == Result::plain);
}

TEST_CASE("A server that does not greet is asked all the same") {
  Conversation talk;
  CHECK(talk.waits(999ms).empty());
  CHECK(talk.waits(1ms).starts_with("CONTROL"));
}

TEST_CASE("No robot: with the extensions it is known at once, without them it takes patience") {
  Conversation extended;
  extended.hears("NFO");
  extended.hears(kAccepted);
  extended.waits(500ms);
  CHECK(extended.handshake.result() == Result::failed);
  CHECK(extended.handshake.failure().find("USARBot.Kenaf") != std::string::npos);

  Conversation plain;
  plain.hears("NFO");
  plain.waits(2999ms);
  CHECK(plain.handshake.result() == Result::pending);
  plain.waits(1ms);
  CHECK(plain.handshake.result() == Result::failed);
}

TEST_CASE("A refused session says why") {
  Conversation talk;
  talk.hears("NFO");
  talk.hears("RES {Time 3} {Type Control} {Name Session} {Status Failed} {Reason Period too short}");
  CHECK(talk.handshake.result() == Result::failed);
  CHECK(talk.handshake.failure().find("Period too short") != std::string::npos);
}

TEST_CASE("A place by name, or by pose: z up becomes z down, left becomes negative y and yaw") {
  RobotPlacement by_name;
  by_name.start = "start_2";
  Conversation name(by_name);
  CHECK(name.hears("NFO").find("INIT {ClassName USARBot.Kenaf} {Name Kenaf} {Start start_2}\r\n") != std::string::npos);

  RobotPlacement by_pose;
  by_pose.pose = {1, 2, 0.5, 0.1, 0.2, 0.3};
  Conversation pose(by_pose);
  CHECK(pose.hears("NFO").find("{Location 1.000000000000,-2.000000000000,-0.500000000000} "
                               "{Rotation 0.100000000000,-0.200000000000,-0.300000000000}\r\n") != std::string::npos);
}
