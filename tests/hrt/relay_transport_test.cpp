// libkenaf_sim's transport is tested below the whole library, against a fake relay. Loss, doubling and reordering
// change nothing but latency. A relay that is absent or refuses is named together with the remedy, a broken link is
// known in time, and a pause that only looks like a break ends nothing. Closing ends the session.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <thread>

#include "kenaf/hrt.h"
#include "libkenaf_sim/relay_transport.hpp"
#include "tests/hrt/fake_relay.hpp"
#include "tests/hrt/fake_transport.hpp"
#include "tests/hrt/name_servers.hpp"

using namespace kenaf;
using namespace kenaf::hrt::test;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace {

hrt_config config_for(const std::string& address) {
  hrt::test::use_transport([] { return std::make_unique<sim::RelayTransport>(); });
  hrt_config config = hrt_config_default();
  std::memset(config.relay, 0, sizeof config.relay);
  address.copy(config.relay, sizeof config.relay - 1);
  config.hold_s = 0.2;
  return config;
}

// A short program: a corner of a square, flippers and track speeds.
int drive_corner() {
  for (const int result : {hrt_go_forward(50), hrt_set_flipper(HRT_ALL_FLIPPERS, 30), hrt_turning(30),
                           hrt_set_tracks(50, 60), hrt_sleep(0.3), hrt_wait_flippers(2, 5)}) {
    if (result != HRT_OK) return result;
  }
  return HRT_OK;
}

std::vector<protocol::relay::Command> run_corner(const BadNetwork::Quality& quality, int& dropped) {
  FakeRelay::Behaviour behaviour;
  behaviour.plant.yaw_noise_rad = 0.0017;
  behaviour.plant.turn_efficiency = 0.6;
  FakeRelay relay(behaviour);
  BadNetwork network(relay.port(), quality);
  hrt_config config = config_for(network.address());
  config.link_timeout_s = 5;
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  const int result = drive_corner();
  INFO(hrt_last_error());
  CHECK(result == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.lost_cycles == 0);
  REQUIRE(hrt_close() == HRT_OK);
  dropped = network.dropped();
  std::vector<protocol::relay::Command> commands = relay.commands();
  REQUIRE(commands.size() + 1 >= state.cycle);
  commands.resize(state.cycle - 1);
  return commands;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A child of fork() that calls exit() runs what main() and the library have registered, and then ends here: what the
// test framework and the sanitizers do at the end is the parent's.
bool is_forked_child = false;
struct ChildEndsHere {
  ~ChildEndsHere() {
    if (is_forked_child) _exit(0);
  }
} child_ends_here;

}  // namespace

TEST_CASE("A bad network gives the same commands as a good one") {
  int dropped = 0;
  const std::vector<protocol::relay::Command> good = run_corner({}, dropped);
  CHECK(dropped == 0);
  for (const unsigned seed : {1u, 2u}) {
    const std::vector<protocol::relay::Command> bad =
        run_corner({.loss = 0.1, .doubling = 0.1, .delay = 0.1, .longest_delay_ms = 12, .seed = seed}, dropped);
    CHECK(dropped > 20);
    REQUIRE(bad.size() == good.size());
    for (std::size_t i = 0; i < good.size(); ++i) {
      CAPTURE(i);
      REQUIRE(bad[i].frame == i + 1);
      REQUIRE(bad[i].robot == good[i].robot);
    }
  }
}

TEST_CASE("A first state that was lost is asked for") {
  FakeRelay::Behaviour behaviour;
  behaviour.first_state_lost = true;
  FakeRelay relay(behaviour);
  const hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_sleep(0.1) == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A first state that never comes is waited for as long as a relay") {
  FakeRelay::Behaviour behaviour;
  behaviour.no_state = true;
  FakeRelay relay(behaviour);
  hrt_config config = config_for(relay.address());
  config.connect_timeout_s = 0.3;
  config.link_timeout_s = 0.05;
  const Clock::time_point start = Clock::now();
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_LINK);
  CHECK(seconds_since(start) >= 0.3);
  CHECK(relay.pings() >= 1);
  CHECK_THAT(hrt_last_error(), Catch::Contains("sent no state within"));
}

TEST_CASE("What the configuration says is what Hello asks for") {
  FakeRelay relay({});
  hrt_config config = config_for(relay.address());
  config.period_s = 0.02;
  config.command_timeout_s = 0.4;
  config.reset_robot = 0;
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
  const protocol::relay::Hello hello = relay.hello().value();
  CHECK(hello.period_s == 0.02);
  CHECK(hello.command_timeout_s == 0.4);
  CHECK(hello.lockstep);
  CHECK_FALSE(hello.reset_robot);
}

TEST_CASE("No relay: the error says what to start, after connect_timeout_s") {
  std::string address;
  {
    const FakeRelay gone({});
    address = gone.address();  // nobody listens there any more
  }
  hrt_config config = config_for(address);
  config.connect_timeout_s = 0.3;
  const Clock::time_point start = Clock::now();
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_LINK);
  CHECK(seconds_since(start) >= 0.3);
  CHECK_THAT(hrt_last_error(),
             Catch::Contains(address) && Catch::Contains("start kenaf-relayd") && Catch::Contains("nothing listens"));
}

TEST_CASE("A host that has also an IPv6 address is reached where the relay listens") {
  FakeRelay relay({});
  const hrt_config config = config_for("localhost:" + std::to_string(relay.port()));
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A name server that does not answer holds init up no longer than connect_timeout_s") {
  const SilentNameServer names;
  hrt_config config = config_for("robot.example:45454");
  use_transport([&] { return std::make_unique<sim::RelayTransport>(names.ask()); });
  config.connect_timeout_s = 0.1;
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_LINK);  // which it would never return if it waited for the answer
  CHECK_THAT(hrt_last_error(), Catch::Contains("robot.example:45454") && Catch::Contains("name server"));
}

TEST_CASE("A relay is reached by the second address of its name, too") {
  FakeRelay relay({});
  std::uint16_t nobodys = 0;
  {
    const FakeRelay gone({});
    nobodys = gone.port();
  }
  hrt_config config = config_for("robot.example:45454");
  use_transport([&] {
    return std::make_unique<sim::RelayTransport>(name_of({{"127.0.0.1", nobodys}, {"127.0.0.1", relay.port()}}));
  });
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("An address that is none is an error of the configuration") {
  for (const char* address :
       {"127.0.0.1", "127.0.0.1:", "127.0.0.1:port", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:-1", ":1"}) {
    const hrt_config config = config_for(address);
    CHECK(hrt_kenaf_init_with(&config) == HRT_E_CONFIG);
    CHECK_THAT(hrt_last_error(), Catch::Contains(address));
  }
}

TEST_CASE("A refusal carries the relay's words") {
  FakeRelay::Behaviour behaviour;
  behaviour.refuse = protocol::relay::RefusedReason::busy;
  behaviour.words = "another commander has the robot";
  FakeRelay relay(behaviour);
  hrt_config config = config_for(relay.address());
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_REFUSED);
  CHECK_THAT(hrt_last_error(), Catch::Contains("another commander has the robot"));
}

TEST_CASE("A relay that has no world server yet is asked again") {
  FakeRelay::Behaviour behaviour;
  behaviour.refuse = protocol::relay::RefusedReason::no_world_server;
  behaviour.refuse_times = 3;
  FakeRelay relay(behaviour);
  hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(relay.hellos() >= 4);
  CHECK(hrt_close() == HRT_OK);

  FakeRelay::Behaviour never;
  never.refuse = protocol::relay::RefusedReason::no_world_server;
  FakeRelay without(never);
  config = config_for(without.address());
  config.connect_timeout_s = 0.3;
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_REFUSED);
  CHECK_THAT(hrt_last_error(), Catch::Contains("start kenaf-world"));
}

TEST_CASE("A robot that does not begin at the first start pose is reported with the first state") {
  for (const bool displaced : {false, true}) {
    FakeRelay::Behaviour behaviour;
    behaviour.not_at_start = displaced;
    FakeRelay relay(behaviour);
    hrt_config config = config_for(relay.address());
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    char words[512];
    REQUIRE(hrt_get_warning(words, sizeof words) == HRT_OK);
    CHECK((std::string(words).find("first start pose") != std::string::npos) == displaced);
    hrt_state state = hrt_state_init();
    REQUIRE(hrt_get_state(&state) == HRT_OK);
    CHECK(((state.activity & HRT_DEGRADED) != 0) == displaced);
    CHECK(hrt_close() == HRT_OK);
  }
}

TEST_CASE("A link that falls silent is an error within a second") {
  FakeRelay::Behaviour behaviour;
  behaviour.silent_from_frame = 20;
  FakeRelay relay(behaviour);
  const hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  const Clock::time_point start = Clock::now();
  CHECK(hrt_go_forward(1000) == HRT_E_LINK);
  CHECK(seconds_since(start) >= 0.5);
  CHECK_THAT(hrt_last_error(), Catch::Contains("no state"));
  CHECK(hrt_close() == HRT_OK);
  for (int i = 0; i < 2000 && relay.byes() == 0; ++i) std::this_thread::sleep_for(1ms);
  CHECK(relay.byes() > 0);
}

TEST_CASE("A lost world server, a forgotten session and a vanished relay are told apart at once") {
  SECTION("world server lost") {
    FakeRelay::Behaviour behaviour;
    behaviour.world_lost_at_frame = 20;
    FakeRelay relay(behaviour);
    hrt_config config = config_for(relay.address());
    config.link_timeout_s = 10;
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    CHECK(hrt_go_forward(1000) == HRT_E_LINK);
    CHECK_THAT(hrt_last_error(), Catch::Contains("lost its world server"));
  }
  SECTION("session forgotten") {
    FakeRelay::Behaviour behaviour;
    behaviour.forgets_at_frame = 20;
    FakeRelay relay(behaviour);
    hrt_config config = config_for(relay.address());
    config.link_timeout_s = 10;
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    CHECK(hrt_go_forward(1000) == HRT_E_LINK);
    CHECK_THAT(hrt_last_error(), Catch::Contains("ended the session: because of the test"));
  }
  SECTION("relay gone") {
    auto relay = std::make_unique<FakeRelay>(FakeRelay::Behaviour{});
    hrt_config config = config_for(relay->address());
    config.link_timeout_s = 10;
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    relay.reset();
    CHECK(hrt_go_forward(1000) == HRT_E_LINK);
    CHECK_THAT(hrt_last_error(), Catch::Contains("is gone"));
  }
  (void)hrt_close();
}

TEST_CASE("A world whose time stands still without being paused is an error, not a hang") {
  FakeRelay::Behaviour behaviour;
  behaviour.frozen_from_frame = 20;
  FakeRelay relay(behaviour);
  hrt_config config = config_for(relay.address());
  config.link_timeout_s = 0.3;  // times 20: six seconds
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_go_forward(1000) == HRT_E_LINK);
  CHECK_THAT(hrt_last_error(), Catch::Contains("time has not advanced"));
  (void)hrt_close();
}

TEST_CASE("A paused world is waited for") {
  FakeRelay::Behaviour behaviour;
  behaviour.pause_at_frame = 20;
  behaviour.pause_states = 30;  // at one for each resend, every 32 ms: about a second
  FakeRelay relay(behaviour);
  hrt_config config = config_for(relay.address());
  config.link_timeout_s = 5;
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  const Clock::time_point start = Clock::now();
  CHECK(hrt_sleep(1) == HRT_OK);
  CHECK(seconds_since(start) > 0.5);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK((state.activity & HRT_PAUSED) == 0);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("The round trip is measured") {
  FakeRelay relay({});
  const hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  CHECK(hrt_sleep(1) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.round_trip_ms > 0);
  CHECK(relay.pings() >= 1);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A relay hears from a commander that thinks, and robot time stands still meanwhile") {
  FakeRelay relay({});
  sim::RelayTransport transport;
  transport.open(config_for(relay.address()));
  REQUIRE(transport.wait_state());
  transport.send(robot::Command{});
  REQUIRE(transport.wait_state());
  const int before = relay.repeats();
  while (relay.repeats() < before + 3) {
    transport.keep_alive();
    std::this_thread::sleep_for(1ms);
  }
  CHECK(relay.commands().size() == 1);
  transport.send(robot::Command{});
  const auto state = transport.wait_state();
  REQUIRE(state);
  CHECK(state->frame == 3);
}

TEST_CASE("Closing says goodbye three times") {
  FakeRelay relay({});
  const hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  REQUIRE(hrt_close() == HRT_OK);
  for (int i = 0; i < 2000 && relay.byes() < 3; ++i) std::this_thread::sleep_for(1ms);
  CHECK(relay.byes() == 3);
}

TEST_CASE("A child of fork() that calls exit() leaves its parent's robot alone") {
  FakeRelay relay({});
  const hrt_config config = config_for(relay.address());
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    is_forked_child = true;
    alarm(60);  // one that waits for threads that it does not have would wait for ever
    std::exit(0);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  CHECK(hrt_go_forward(10) == HRT_OK);
  CHECK(relay.byes() == 0);
  CHECK(hrt_close() == HRT_OK);
}
