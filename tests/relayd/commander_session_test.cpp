// Who commands the robot: rules of docs/relay-protocol.md with a clock of the test's own.
#include "relayd/commander_session.hpp"

#include <spdlog/spdlog.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/robot_command.hpp"

using namespace kenaf;
using namespace kenaf::relayd;
using namespace std::chrono_literals;

namespace {

// 10.0.0.0 to 10.0.255.255
Address numbered_address(int i) {
  return parse_address("10.0." + std::to_string(i / 256) + "." + std::to_string(i % 256) + ":1111");
}

const Address kFirst = parse_address("127.0.0.1:1111"), kSecond = parse_address("127.0.0.1:2222");

struct FakePort : SessionPort {
  void send(const Peer& to, const protocol::relay::Datagram& datagram) override {
    sent.emplace_back(to.address, datagram);
  }
  void open_world(const protocol::relay::Hello&) override { ++opened; }
  void close_world() override { ++closed; }
  void drive(const protocol::relay::Command& command, std::optional<std::int64_t> frame) override {
    driven.emplace_back(command.sequence, frame);
  }
  void stop_robot() override { ++stopped; }
  bool ping_world(std::uint32_t) override { return pings_world; }

  std::vector<std::pair<Address, protocol::relay::Datagram>> sent;
  std::vector<std::pair<std::uint32_t, std::optional<std::int64_t>>> driven;
  int opened = 0, closed = 0, stopped = 0;
  bool pings_world = true;
};

struct Fixture {
  Fixture() { spdlog::set_level(spdlog::level::off); }
  ~Fixture() { spdlog::set_level(spdlog::level::info); }

  void from(const Address& address, const protocol::relay::Datagram& datagram) {
    session.on_datagram(datagram, {address}, now);
  }
  void hello(const Address& address, std::uint64_t id) {
    from(address, protocol::relay::Hello{id, 0.01, 0.5, true, false});
  }
  void open(std::uint64_t id = 7) {
    hello(kFirst, id);
    session.on_world_ready({1.0, 0.01, true}, now);
  }
  void frame(std::int64_t number, double time_s, std::uint32_t late = 0) {
    WorldFrame world{{}, false, number, true, 0.01};
    world.state.robot_time_s = time_s;
    world.state.late_commands = late;
    session.on_frame(world, now);
  }
  void command(std::uint32_t sequence, std::uint32_t answers, std::uint64_t id = 7, const Address& address = kFirst) {
    from(address, protocol::relay::Command{id, sequence, answers, support::command_of({0.1, 0.1})});
  }
  void pass(CommanderSession::Duration time, bool world_is_alive = true) {
    now += time;
    session.on_time(now, world_is_alive);
  }
  template <class Kind>
  const Kind* newest() const {
    return port.sent.empty() ? nullptr : std::get_if<Kind>(&port.sent.back().second);
  }
  protocol::relay::RefusedReason refused() const {
    REQUIRE(newest<protocol::relay::Refused>() != nullptr);
    return newest<protocol::relay::Refused>()->reason;
  }

  CommanderSession::TimePoint now{1h};
  FakePort port;
  CommanderSession session{port};
};

}  // namespace

TEST_CASE_METHOD(Fixture,
                 "Hello opens the world, Welcome follows once it is ready, and again for each repeated Hello") {
  hello(kFirst, 7);
  hello(kFirst, 7);
  CHECK(port.opened == 1);
  CHECK(port.sent.empty());
  session.on_world_ready({1.0, 0.02, true}, now);
  REQUIRE(newest<protocol::relay::Welcome>() != nullptr);
  CHECK(newest<protocol::relay::Welcome>()->session == 7);
  CHECK(newest<protocol::relay::Welcome>()->robot_time_s == 1.0);
  CHECK(newest<protocol::relay::Welcome>()->period_s == 0.02);
  hello(kFirst, 7);
  CHECK(port.sent.size() == 2);
  CHECK(port.opened == 1);
}

TEST_CASE_METHOD(Fixture, "Another commander is refused, and told who commands and for how long") {
  open();
  now += 12s;
  hello(kSecond, 8);
  CHECK(refused() == protocol::relay::RefusedReason::busy);
  const auto* refusal = newest<protocol::relay::Refused>();
  CHECK(std::string(refusal->text.data(), refusal->text_length) == "127.0.0.1:1111 has commanded the robot for 12.0 s");
  CHECK(port.sent.back().first == kSecond);
  hello(kSecond, 7);  // nor under the first one's number
  CHECK(refused() == protocol::relay::RefusedReason::busy);
  command(1, 0, 7, kSecond);
  from(kSecond, protocol::relay::Bye{7});
  CHECK(port.driven.empty());
  CHECK(session.session() == 7);
}

TEST_CASE_METHOD(Fixture, "Strangers get a hundred answers a second in all, and the commander all of his") {
  const auto answers = [this](const auto& each) {
    const std::size_t before = port.sent.size();
    for (int i = 0; i < 10000; ++i) each(numbered_address(i));
    return port.sent.size() - before;
  };
  CHECK(answers([this](const Address& stranger) { from(stranger, protocol::relay::Ping{99, 1}); }) == 100);
  CHECK(answers([this](const Address& stranger) { command(1, 0, 99, stranger); }) == 0);
  open();
  const std::size_t with_welcome = port.sent.size();
  from(kFirst, protocol::relay::Command{7, 1, 0, support::command_of({99, 0})});  // out of range
  CHECK(port.sent.size() == with_welcome + 1);
  now += 500ms;
  CHECK(answers([this](const Address& stranger) { hello(stranger, 8); }) == 50);  // busy
  now += 1h;
  CHECK(answers([this](const Address& stranger) {
          from(stranger, protocol::relay::Hello{8, -1, 0.5, true, false});
        }) == 100);
}

TEST_CASE_METHOD(Fixture, "An unknown session is told so, an unknown Bye is nobody's") {
  command(1, 0, 99);
  CHECK(refused() == protocol::relay::RefusedReason::unknown_session);
  from(kFirst, protocol::relay::Ping{99, 1});
  CHECK(refused() == protocol::relay::RefusedReason::unknown_session);
  port.sent.clear();
  from(kFirst, protocol::relay::Bye{99});
  CHECK(port.sent.empty());
}

TEST_CASE_METHOD(Fixture, "A Hello out of range is refused in words") {
  from(kFirst, protocol::relay::Hello{7, 2.0, 0.5, true, false});
  CHECK(refused() == protocol::relay::RefusedReason::bad_request);
  CHECK(port.opened == 0);
}

TEST_CASE_METHOD(Fixture, "States count from 1, whatever the world counts from, and commands are counted back") {
  open();
  frame(31, 1.0, 5);
  CHECK(newest<protocol::relay::State>()->robot.frame == 1);
  CHECK(newest<protocol::relay::State>()->robot.late_commands == 0);
  frame(32, 1.01, 6);
  CHECK(newest<protocol::relay::State>()->robot.frame == 2);
  CHECK(newest<protocol::relay::State>()->robot.late_commands == 1);
  command(1, 2);
  CHECK(port.driven.back() == std::pair<std::uint32_t, std::optional<std::int64_t>>{1, 32});
  // The world counts anew; States go on.
  frame(1, 0.0);
  CHECK(newest<protocol::relay::State>()->robot.frame == 3);
  CHECK(newest<protocol::relay::State>()->acknowledged == 1);
}

TEST_CASE_METHOD(Fixture, "A frame that is told again is no new one: the world paused") {
  open();
  frame(1, 1.0);
  WorldFrame again{{}, 1, true, 0};
  again.state.robot_time_s = 1.0;
  again.paused = true;
  session.on_frame(again, now);
  CHECK(newest<protocol::relay::State>()->robot.frame == 1);
  CHECK(newest<protocol::relay::State>()->world_paused);
  CHECK_FALSE(newest<protocol::relay::State>()->robot.stopped_by_silence);
}

TEST_CASE_METHOD(Fixture, "Only a new Command reaches the world, a repeated one brings the newest State again") {
  open();
  frame(1, 1.0);
  command(1, 1);
  CHECK(port.driven.size() == 1);
  frame(2, 1.01);
  port.sent.clear();
  command(1, 1);
  CHECK(port.driven.size() == 1);
  REQUIRE(newest<protocol::relay::State>() != nullptr);
  CHECK(newest<protocol::relay::State>()->robot.frame == 2);
  CHECK(newest<protocol::relay::State>()->acknowledged == 1);

  command(3, 2);
  port.sent.clear();
  command(2, 2);  // overtaken: neither obeyed nor answered
  CHECK(port.driven.size() == 2);
  CHECK(port.sent.empty());
  command(4, 9);  // of a frame that is yet to come
  CHECK(port.driven.size() == 2);
}

TEST_CASE_METHOD(Fixture, "A Command before the first State takes effect at once") {
  open();
  command(1, 0);
  REQUIRE(port.driven.size() == 1);
  CHECK_FALSE(port.driven[0].second);
}

TEST_CASE_METHOD(Fixture, "An absurd Command is refused and does not count as one") {
  open();
  frame(1, 1.0);
  from(kFirst, protocol::relay::Command{7, 1, 1, support::command_of({10.5, 0})});
  CHECK(refused() == protocol::relay::RefusedReason::bad_request);
  CHECK(port.driven.empty());
  command(1, 1);
  CHECK(port.driven.size() == 1);
}

TEST_CASE_METHOD(Fixture, "Without Commands for the time-out of robot time the robot is stopped, once") {
  open();
  frame(1, 1.0);
  command(1, 1);
  frame(2, 1.5);  // exactly the time-out: not yet beyond
  CHECK(port.stopped == 0);
  frame(3, 1.51);
  frame(4, 1.52);
  CHECK(port.stopped == 1);
  CHECK(newest<protocol::relay::State>()->robot.stopped_by_silence);
  command(1, 1);  // a copy of an old one does not start it again
  CHECK(newest<protocol::relay::State>()->robot.stopped_by_silence);
  command(2, 4);
  frame(5, 1.53);
  CHECK_FALSE(newest<protocol::relay::State>()->robot.stopped_by_silence);
  CHECK(port.driven.size() == 2);
}

TEST_CASE_METHOD(Fixture, "A second of wall-clock silence ends the session, the next commander is served") {
  open();
  frame(1, 1.0);
  pass(999ms);
  CHECK(session.session() == 7);
  from(kFirst, protocol::relay::Ping{7, 1});  // anything of it counts
  pass(999ms);
  CHECK(session.session() == 7);
  pass(1ms);
  CHECK(session.session() == 0);
  CHECK(port.closed == 1);
  hello(kSecond, 8);
  CHECK(port.opened == 2);
}

TEST_CASE_METHOD(Fixture, "Bye ends it at once, a late copy of its Hello does not begin it again") {
  open();
  from(kFirst, protocol::relay::Bye{7});
  CHECK(session.session() == 0);
  CHECK(port.closed == 1);
  now += 900ms;
  hello(kFirst, 7);
  CHECK(refused() == protocol::relay::RefusedReason::unknown_session);
  CHECK(port.opened == 1);
  from(kFirst, protocol::relay::Bye{7});
  CHECK(port.closed == 1);
  now += 200ms;
  hello(kFirst, 7);
  CHECK(port.opened == 2);
}

TEST_CASE_METHOD(Fixture, "The newest State is the heartbeat while the world lives, and only then") {
  open();
  frame(1, 1.0);
  port.sent.clear();
  pass(99ms);
  CHECK(port.sent.empty());
  pass(1ms);
  CHECK(port.sent.size() == 1);
  pass(100ms, false);
  CHECK(port.sent.size() == 1);
  CHECK(*session.next_deadline() == now + 100ms);
}

TEST_CASE_METHOD(Fixture, "A lost world server is told until the commander leaves, others may begin") {
  open();
  frame(1, 1.0);
  session.on_world_lost("gone", now);
  CHECK(newest<protocol::relay::State>()->world_server_lost);
  CHECK(session.session() == 0);
  port.sent.clear();
  pass(50ms);
  CHECK(port.sent.size() == 1);
  command(2, 1);
  CHECK(port.sent.size() == 2);
  CHECK(port.driven.empty());

  SECTION("Bye") {
    from(kFirst, protocol::relay::Bye{7});
    port.sent.clear();
    pass(50ms);
    CHECK(port.sent.empty());
  }
  SECTION("silence") {
    pass(1s);
    port.sent.clear();
    pass(50ms);
    CHECK(port.sent.empty());
    CHECK_FALSE(session.next_deadline());
  }
  SECTION("another commander") {
    hello(kSecond, 8);
    CHECK(port.opened == 2);
    CHECK(session.commander() == kSecond);
  }
}

TEST_CASE_METHOD(Fixture, "A world server that cannot be opened refuses, with its reason") {
  hello(kFirst, 7);
  session.on_world_lost("no world server at 127.0.0.1:3000: Connection refused", now);
  CHECK(refused() == protocol::relay::RefusedReason::no_world_server);
  hello(kFirst, 7);  // the same may try again
  CHECK(port.opened == 2);
  pass(5s);
  CHECK(refused() == protocol::relay::RefusedReason::no_world_server);
  CHECK(session.session() == 0);
}

TEST_CASE_METHOD(Fixture, "Where the world cannot be pinged the relay answers itself") {
  open();
  from(kFirst, protocol::relay::Ping{7, 3});
  CHECK(newest<protocol::relay::Pong>() == nullptr);
  session.on_pong(3, now);
  CHECK(newest<protocol::relay::Pong>()->id == 3);
  port.pings_world = false;
  from(kFirst, protocol::relay::Ping{7, 4});
  CHECK(newest<protocol::relay::Pong>()->id == 4);
}

TEST_CASE_METHOD(Fixture, "A relay that ends tells its commander and stops the robot") {
  open();
  session.shut_down(now);
  CHECK(refused() == protocol::relay::RefusedReason::unknown_session);
  CHECK(port.closed == 1);
}

TEST_CASE("A Hello that is repeated while the world is slow is told so after a second, and may still begin") {
  Fixture f;
  f.hello(kFirst, 7);
  f.now += 900ms;
  f.hello(kFirst, 7);
  CHECK(f.port.sent.empty());
  f.now += 200ms;
  f.hello(kFirst, 7);
  REQUIRE(f.port.sent.size() == 1);
  const auto& refused = std::get<protocol::relay::Refused>(f.port.sent[0].second);
  CHECK(refused.reason == protocol::relay::RefusedReason::no_world_server);
  CHECK(std::string(refused.text.data(), refused.text_length).find("1.1 s") != std::string::npos);
  f.session.on_world_ready({1.0, 0.01, true}, f.now);
  CHECK(std::holds_alternative<protocol::relay::Welcome>(f.port.sent.back().second));
}
