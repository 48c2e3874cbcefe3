// The whole relay in process, between a fake world server and fake commanders, over real sockets.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/relayd/allocations.hpp"
#include "tests/relayd/fake_commander.hpp"
#include "tests/relayd/fake_world.hpp"
#include "tests/relayd/running_relay.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/lossy_proxy.hpp"
#include "tests/support/robot_command.hpp"

using namespace kenaf;
using namespace kenaf::test;
using namespace std::chrono_literals;

namespace {

// Drives to x = 0.5 m by what it measures, so that each lost or stale State would show in all later ones.
void approach(const protocol::relay::State& state, protocol::relay::Command& command) {
  const double speed_mps = 2 * (0.5 - state.robot.track_m[robot::kLeft]) + 0.01 * std::sin(state.robot.frame);
  command.robot = support::command_of({speed_mps, speed_mps}, 0b0101, {0.1 * speed_mps, 0, -0.1 * speed_mps, 0});
}

std::vector<std::string> commands_only(const FakeWorld& world) {
  std::vector<std::string> out;
  for (const std::string& line : world.lines()) {
    if (line.starts_with("DRIVE") && line.find("Frame") != std::string::npos) out.push_back(line);
    if (line.starts_with("MULTIDRIVE")) out.push_back(line);
  }
  return out;
}

}  // namespace

TEST_CASE("The relay places a robot, opens a session in lock step and carries commands and States") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 7);
  const auto answer = commander.hello(true, true);
  REQUIRE(is_welcome(answer));
  CHECK(std::get<protocol::relay::Welcome>(answer).lockstep);
  CHECK(std::get<protocol::relay::Welcome>(answer).period_s == Approx(0.01));
  CHECK(world.last("INIT") == "INIT {ClassName USARBot.Kenaf} {Name Kenaf}");

  // 0.2 m/s for 50 periods of 0.01 s: 0.1 m.
  const auto states = commander.drive(50, [](const protocol::relay::State&, protocol::relay::Command& command) {
    command.robot.track_speed_mps = {0.2, 0.2};
  });
  CHECK(world.x_m() == Approx(0.1).margin(1e-9));
  CHECK(world.last("DRIVE") == "DRIVE {Left 4.000000000000} {Right 4.000000000000} {Frame 50}");
  for (std::size_t i = 0; i < states.size(); ++i) {
    CHECK(states[i].robot.frame == i + 1);
    CHECK(states[i].acknowledged == i);
    CHECK(states[i].robot.late_commands == 0);
  }
  CHECK(states[49].robot.track_m[robot::kLeft] == Approx(49 * 0.002).margin(1e-9));
  CHECK(states[49].robot.p_WB_m[2] == Approx(0.1));  // z down on the wire
  CHECK(states[49].robot.posture_rad[1] == Approx(-0.2));
}

TEST_CASE("A relay on [::] serves commanders of IPv4 too, and names them by their IPv4 address") {
  if (!has_ipv6_loopback()) {
    WARN("skipped: this machine has no address ::1");
    return;
  }
  FakeWorld world;
  RunningRelay relay(world.port(), "[::]:0");
  FakeCommander commander(relay.port(), 7);  // to 127.0.0.1
  REQUIRE(is_welcome(commander.hello(true)));
  CHECK(eventually([&] { return relay.log().count("127.0.0.1:") > 0; }));
  CHECK(relay.log().count("listening on [::]:") == 1);
  CHECK(relay.log().count("any program that reaches this address") == 1);
}

// All of 127.0.0.0/8 are this machine's. The system would answer from 127.0.0.1, which a connected socket does not
// take.
TEST_CASE("A relay on every address answers from the one that its commander asked") {
  FakeWorld world;
  for (const std::string listen : {"0.0.0.0:0", "[::]:0"}) {
    if (listen.starts_with("[") && !has_ipv6_loopback()) continue;
    INFO(listen);
    RunningRelay relay(world.port(), listen);
    relayd::Address address = relayd::parse_address("127.0.0.2:0");
    address.port = relay.port();
    FakeCommander commander(address, 7), stranger(address, 8);
    REQUIRE(is_welcome(commander.hello(true)));
    CHECK(commander.next_state(0, protocol::relay::Ping{7, 0}));
    CHECK(refusal(stranger.hello(true)).reason == protocol::relay::RefusedReason::busy);
    commander.send(protocol::relay::Bye{7});
  }
}

TEST_CASE("A relay on [::] answers commanders of IPv6 and of 127.0.0.1") {
  if (!has_ipv6_loopback()) return;
  FakeWorld world;
  RunningRelay relay(world.port(), "[::]:0");
  relayd::Address address = relayd::parse_address("[::1]:0");
  address.port = relay.port();
  FakeCommander commander(address, 7), stranger(relay.port(), 8);
  CHECK(is_welcome(commander.hello(true)));
  CHECK(refusal(stranger.hello(true)).reason == protocol::relay::RefusedReason::busy);
}

TEST_CASE("Loss, reordering and duplicates change nothing but latency") {
  std::vector<std::string> clean;
  std::vector<protocol::relay::State> clean_states;
  {
    FakeWorld world;
    RunningRelay relay(world.port());
    FakeCommander commander(relay.port(), 1);
    REQUIRE(is_welcome(commander.hello(true, true)));
    clean_states = commander.drive(150, approach);
    clean = commands_only(world);
  }
  REQUIRE(clean.size() == 300);
  for (const unsigned seed : {1u, 2u, 3u}) {
    FakeWorld world;
    RunningRelay relay(world.port());
    support::LossyProxy proxy(relay.port(), seed, {}, {.at_start = leave_this_thread_out});
    FakeCommander commander(proxy.port(), 1);
    REQUIRE(is_welcome(commander.hello(true, true)));
    const auto states = commander.drive(150, approach);
    CHECK(commands_only(world) == clean);  // to the last digit
    REQUIRE(states.size() == clean_states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      CHECK(states[i].robot.frame == clean_states[i].robot.frame);
      CHECK(states[i].robot.robot_time_s == clean_states[i].robot.robot_time_s);
      CHECK(states[i].robot.track_m == clean_states[i].robot.track_m);
    }
  }
}

TEST_CASE("One commander at a time, the next one is served after Bye or silence") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander first(relay.port(), 1), second(relay.port(), 2);
  REQUIRE(is_welcome(first.hello(false)));
  const auto busy = refusal(second.hello(false));
  CHECK(busy.reason == protocol::relay::RefusedReason::busy);
  CHECK(text_of(busy).find("127.0.0.1:") != std::string::npos);

  second.send(second.command(1, 1, 1, 1));
  CHECK(refusal(*second.receive(5000)).reason == protocol::relay::RefusedReason::unknown_session);
  CHECK(is_welcome(first.hello(false)));  // the Welcome may have been lost

  first.send(protocol::relay::Bye{1});
  REQUIRE(eventually([&] { return is_welcome(second.hello(false)); }));
  // The second falls silent.
  FakeCommander third(relay.port(), 3);
  REQUIRE(eventually([&] { return is_welcome(third.hello(false)); }));
  CHECK(relay.log().count("fell silent") == 1);
}

TEST_CASE("A silent commander's robot is stopped by robot time, and the commander may go on") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 9);
  REQUIRE(is_welcome(commander.hello(false, false, 0.01, 0.5)));
  const auto first = commander.next_state(0, protocol::relay::Ping{9, 1});
  REQUIRE(first);
  commander.send(commander.command(1, first->robot.frame, 0.3, 0.3));
  REQUIRE(eventually([&] { return world.speed_mps() > 0.29; }));
  const auto stopped = commander.wait_for([](const auto& s) { return s.robot.stopped_by_silence; });
  REQUIRE(stopped);
  CHECK(stopped->acknowledged == 1);
  REQUIRE(eventually([&] { return world.speed_mps() == 0; }));

  commander.send(commander.command(2, stopped->robot.frame, 0.1, 0.1));
  const auto going =
      commander.wait_for([](const auto& s) { return s.acknowledged == 2 && !s.robot.stopped_by_silence; });
  CHECK(going);
  CHECK(eventually([&] { return world.speed_mps() > 0.09; }));
}

TEST_CASE("The world server is lost and comes back") {
  auto world = std::make_unique<FakeWorld>();
  const std::uint16_t port = world->port();
  RunningRelay relay(port);
  FakeCommander commander(relay.port(), 5);
  REQUIRE(is_welcome(commander.hello(true)));
  REQUIRE(commander.drive(5, approach).size() == 5);

  const auto killed = std::chrono::steady_clock::now();
  world.reset();
  REQUIRE(commander.wait_for([](const auto& s) { return s.world_server_lost; }));
  CHECK(std::chrono::steady_clock::now() - killed < 5s);
  // Again, in case it was lost.
  REQUIRE(commander.wait_for([](const auto& s) { return s.world_server_lost; }));

  FakeCommander next(relay.port(), 6);
  const auto none = refusal(next.hello(true));
  CHECK(none.reason == protocol::relay::RefusedReason::no_world_server);
  CHECK(text_of(none).find("refused") != std::string::npos);

  FakeWorldOptions same;
  same.port = port;
  world = std::make_unique<FakeWorld>(same);
  FakeCommander after(relay.port(), 8);
  REQUIRE(eventually([&] { return is_welcome(after.hello(true)); }));
  CHECK(after.drive(5, approach).size() == 5);
}

TEST_CASE("A world server that hangs is left") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 5);
  REQUIRE(is_welcome(commander.hello(true)));
  commander.drive(3, approach);
  world.mute(true);
  // The commander keeps the session alive, as it must.
  protocol::relay::State lost{};
  REQUIRE(eventually([&] {
    commander.send(protocol::relay::Ping{5, 1});
    const auto datagram = commander.receive(50);
    if (!datagram || !std::holds_alternative<protocol::relay::State>(*datagram)) return false;
    lost = std::get<protocol::relay::State>(*datagram);
    return lost.world_server_lost;
  }));
  world.mute(false);
  FakeCommander next(relay.port(), 6);
  CHECK(eventually([&] { return is_welcome(next.hello(true)); }));
}

TEST_CASE("reset_robot enters the world anew, in lock step from the first frame") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander first(relay.port(), 1);
  REQUIRE(is_welcome(first.hello(true)));
  first.drive(20, approach);
  CHECK(world.x_m() > 0.01);
  first.send(protocol::relay::Bye{1});

  const int before = world.connections();
  FakeCommander second(relay.port(), 2);
  REQUIRE(is_welcome(second.hello(true, true)));
  const auto states = second.drive(3, approach);
  CHECK(world.connections() == before + 1);
  CHECK(states[0].robot.frame == 1);
  CHECK(states[0].robot.robot_time_s == 0);
  CHECK(states[0].robot.track_m[robot::kLeft] == 0);
}

TEST_CASE("Without a commander there is no lock step and the robot stands") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 1);
  REQUIRE(is_welcome(commander.hello(true)));
  commander.drive(5, approach);
  CHECK(world.speed_mps() > 0);
  for (int i = 0; i < 3; ++i) commander.send(protocol::relay::Bye{1});
  REQUIRE(eventually([&] { return world.last("CONTROL").find("{Lockstep False}") != std::string::npos; }));
  CHECK(world.speed_mps() == 0);
  CHECK(world.last("DRIVE") == "DRIVE {Left 0.000000000000} {Right 0.000000000000}");
}

TEST_CASE("A ping goes to the world server and back") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  bool answered = false;
  REQUIRE(eventually([&] {
    commander.send(protocol::relay::Ping{4, 4000000000u});
    const auto datagram = commander.receive(100);
    const auto* pong = datagram ? std::get_if<protocol::relay::Pong>(&*datagram) : nullptr;
    answered = pong != nullptr && pong->id == 4000000000u && pong->session == 4;
    return answered;
  }));
  CHECK(world.count("PING {Id 4000000000}") >= 1);
}

TEST_CASE("A plain USARSim server works without the extensions") {
  FakeWorldOptions plain;
  plain.extended = false;
  FakeWorld world(plain);
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  protocol::relay::Datagram answer = commander.hello(true);
  REQUIRE(is_welcome(answer));
  CHECK_FALSE(std::get<protocol::relay::Welcome>(answer).lockstep);
  CHECK(std::get<protocol::relay::Welcome>(answer).period_s == Approx(0.2));

  const auto first = commander.next_state(0, protocol::relay::Ping{4, 1});
  REQUIRE(first);
  protocol::relay::Command command = commander.command(1, first->robot.frame, 0.1, -0.2);
  const std::array<double, robot::kFlipperCount> flipper_rad{0.5, 0.5, 0.25, 0.25};
  command.robot = support::command_of(command.robot.track_speed_mps, 0b1111, flipper_rad);
  commander.send(command);
  const auto later =
      commander.wait_for([](const auto& s) { return s.acknowledged == 1 && s.robot.flipper_rad[0] != 0; });
  REQUIRE(later);
  CHECK(later->robot.frame > first->robot.frame);
  CHECK(later->robot.flipper_rad == flipper_rad);
  CHECK(world.last("DRIVE") == "DRIVE {Left 2.000000000000} {Right -4.000000000000}");
  CHECK(world.last("MULTIDRIVE") ==
        "MULTIDRIVE {FLFlipper -0.500000000000} {FRFlipper -0.500000000000} {RLFlipper 0.250000000000} "
        "{RRFlipper 0.250000000000}");
  commander.send(protocol::relay::Ping{4, 77});
  CHECK(eventually([&] {
    const auto datagram = commander.receive(100);
    return datagram && std::holds_alternative<protocol::relay::Pong>(*datagram);
  }));
}

TEST_CASE("A world server that accepts no robot is named with a reason") {
  FakeWorldOptions options;
  options.accepts_robot = false;
  FakeWorld world(options);
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  const auto refused = refusal(commander.hello(true));
  CHECK(refused.reason == protocol::relay::RefusedReason::no_world_server);
  CHECK(text_of(refused).find("USARBot.Kenaf") != std::string::npos);
}

TEST_CASE("Hostile datagrams: a log line, nothing dead, nothing lost") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4), attacker(relay.port(), 666);
  REQUIRE(is_welcome(commander.hello(true)));
  std::mt19937 random(1);
  std::array<std::byte, 600> bytes;
  const auto attack = [&] {
    for (std::uint32_t i = 0; i < 50; ++i) {
      for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
      const std::size_t size = protocol::relay::encode(attacker.command(1 + i % 3, 0, 5, 5), bytes);
      const std::size_t cut = i % 2 == 0 ? size : random() % bytes.size();
      bytes[random() % size] ^= static_cast<std::byte>(1 << random() % 8);
      attacker.send_bytes({bytes.data(), cut});
    }
    attacker.send(protocol::relay::Bye{4});           // of another's session
    attacker.send(commander.command(1000, 0, 9, 9));  // likewise
    protocol::relay::State not_for_a_relay{};
    not_for_a_relay.session = 4;
    attacker.send(not_for_a_relay);
  };
  std::uint32_t frames = 0;
  const auto states = commander.drive(40, [&](const protocol::relay::State& state, protocol::relay::Command& command) {
    if (state.robot.frame % 4 == 0) attack();
    command.robot.track_speed_mps = {0.2, 0.2};
    ++frames;
  });
  CHECK(frames == 40);
  CHECK(world.x_m() == Approx(40 * 0.002).margin(1e-9));
  CHECK(relay.log().count("ignored") >= 1);
  CHECK(relay.log().count("") < 40);  // and not one a datagram

  // Out of range: refused, and the robot keeps its last command.
  commander.send(commander.command(100, 41, 11, 0));
  const auto refused = [&] {
    const auto datagram = commander.receive(100);
    return datagram && std::holds_alternative<protocol::relay::Refused>(*datagram);
  };
  CHECK(eventually(refused));
}

TEST_CASE("Hostile lines from the world server: a log line, nothing dead, nothing lost") {
  FakeWorldOptions options;
  options.garbage = "}{ \x01\x02\r\nSEN {Type GroundTruth} {Location nan,inf,1e999} {Orientation a,b}\r\n" +
                    std::string(200, '{') +
                    "\r\nSTA\r\nSTA {Time}\r\nRES {Type Control} {Name Session}\r\nPONG {Id x}\r\n" +
                    "GEO {WheelRadius -1}\r\nCONF {Type Encoder} {Resolution 0}\r\n" + std::string(70000, 'x') + "\r\n";
  FakeWorld world(options);
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  const auto states = commander.drive(10, [](const protocol::relay::State&, protocol::relay::Command& command) {
    command.robot.track_speed_mps = {0.2, 0.2};
  });
  CHECK(world.x_m() == Approx(10 * 0.002).margin(1e-9));
  CHECK(states[9].robot.track_m[robot::kLeft] == Approx(9 * 0.002).margin(1e-9));
  CHECK(relay.log().count("the world server sent") >= 1);
}

TEST_CASE("What the world server warns of is in the relay's log") {
  FakeWorldOptions options;
  options.garbage = "RES {Time 1} {Type Robot} {Name R1} {Status OK} {Warning another robot has the same name}\r\n";
  FakeWorld world(options);
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  CHECK(relay.log().count("the world server warns of robot R1: another robot has the same name") >= 1);
}

TEST_CASE("Lines that arrive in pieces are put together") {
  FakeWorldOptions options;
  options.piece = 7;
  FakeWorld world(options);
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  const auto states = commander.drive(10, approach);
  CHECK(states[9].robot.frame == 10);
}

TEST_CASE("The relay ends cleanly: the commander is told and the robot stands") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  commander.drive(10, approach);
  CHECK(world.speed_mps() > 0);
  relay.stop();
  CHECK(eventually([&] { return world.speed_mps() == 0; }));
  bool is_refused = false;
  while (const auto datagram = commander.receive(200))
    is_refused |= std::holds_alternative<protocol::relay::Refused>(*datagram);
  CHECK(is_refused);
}

TEST_CASE("The relay ends cleanly before it ever found a world server") {
  std::uint16_t nobody = 0;
  {
    FakeWorld gone;
    nobody = gone.port();
  }
  RunningRelay relay(nobody);
  FakeCommander commander(relay.port(), 4);
  CHECK(refusal(commander.hello(true)).reason == protocol::relay::RefusedReason::no_world_server);
  CHECK(eventually([&] { return relay.log().count("no world server at") >= 1; }));
  std::this_thread::sleep_for(300ms);
  CHECK(relay.log().count("no world server at") == 1);  // once a change of state
}

TEST_CASE("The steady path allocates nothing") {
  leave_this_thread_out();
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander commander(relay.port(), 4);
  REQUIRE(is_welcome(commander.hello(true)));
  std::uint64_t before = 0, after = 0;
  commander.drive(600, [&](const protocol::relay::State& state, protocol::relay::Command& command) {
    approach(state, command);
    commander.send(protocol::relay::Ping{4, 1});
    if (state.robot.frame == 200) before = allocations();
    if (state.robot.frame == 600) after = allocations();
  });
  CHECK(before > 0);  // the counter works
  CHECK(after == before);
}
