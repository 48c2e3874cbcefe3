// A world server that hangs, as the commander sees it.
#include <spdlog/spdlog.h>

#include <catch2/catch.hpp>

#include "tests/relayd/fake_commander.hpp"
#include "tests/relayd/fake_world.hpp"
#include "tests/relayd/running_relay.hpp"

using namespace kenaf;
using namespace kenaf::test;

namespace {

constexpr std::uint64_t kSession = 11;

}  // namespace

TEST_CASE("A commander whose relay waits for a hung world is told so, and begins once the world is back", "[hostile]") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander first(relay.port(), 10);
  REQUIRE(is_welcome(first.hello(false)));
  first.send(protocol::relay::Bye{10});
  world.mute(true);

  // Asked again and again, as libkenaf_sim does; another commander is still answered by reason 1.
  const protocol::relay::Hello hello{kSession, 0.01, 0.5, false, true};
  FakeCommander commander(relay.port(), kSession);
  std::optional<protocol::relay::Refused> told;
  REQUIRE(eventually([&] {
    commander.send(hello);
    const auto answer = commander.receive(20);
    if (answer && std::holds_alternative<protocol::relay::Refused>(*answer)) told = refusal(*answer);
    return told.has_value();
  }));
  CHECK(told->reason == protocol::relay::RefusedReason::no_world_server);

  world.mute(false);
  REQUIRE(eventually([&] {
    commander.send(hello);
    const auto answer = commander.receive(20);
    return answer && is_welcome(*answer);
  }));
}
