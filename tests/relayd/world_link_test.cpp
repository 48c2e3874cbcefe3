// The relay's connection to the world server: how it begins, breaks, and begins anew.
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "tests/relayd/fake_commander.hpp"
#include "tests/relayd/fake_world.hpp"
#include "tests/relayd/running_relay.hpp"
#include "tests/support/loopback.hpp"

using namespace kenaf;
using namespace kenaf::test;

namespace {

// Whether the system lets us connect to `port` at once; the connection is kept in `kept`.
bool connects_at_once(std::uint16_t port, std::vector<relayd::Descriptor>& kept) {
  relayd::Descriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const sockaddr_in address = loopback(port);
  (void)::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  pollfd connected{fd.get(), POLLOUT, 0};
  if (::poll(&connected, 1, 500) <= 0) return false;
  kept.push_back(std::move(fd));
  return true;
}

// Whether somebody on this machine waits for an answer to his connect() to `port`.
bool connect_is_pending(std::uint16_t port) {
  std::ifstream table("/proc/net/tcp");
  const std::string wanted = fmt::format(":{:04X} 02 ", port);  // remote port, state SYN_SENT
  for (std::string line; std::getline(table, line);) {
    if (line.find(wanted) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("A Hello while the relay is still connecting is answered by what comes of a try, not of its interruption") {
  FakeWorld world;
  // The world serves one client at a time; more wait until the system takes no further ones, and a connect() waits too.
  std::vector<relayd::Descriptor> waiting;
  while (connects_at_once(world.port(), waiting)) REQUIRE(waiting.size() < 50);
  RunningRelay relay(world.port());
  REQUIRE(eventually([&] { return connect_is_pending(world.port()); }));

  FakeCommander commander(relay.port(), 7);
  commander.send(protocol::relay::Hello{7, 0.01, 0.5, true, false});
  // A connect() that comes to nothing within its time is a reason to refuse; that the Hello came is none.
  const auto patient_hello = [&] {
    const auto answer = commander.hello(true);
    if (is_welcome(answer)) return true;
    CHECK(text_of(refusal(answer)).find("anceled") == std::string::npos);
    return false;
  };
  if (const auto early = commander.receive(300)) CHECK(text_of(refusal(*early)).find("anceled") == std::string::npos);
  waiting.clear();
  CHECK(eventually(patient_hello));
  CHECK(commander.drive(3, [](const protocol::relay::State&, protocol::relay::Command&) {}).size() == 3);
}

TEST_CASE("What a lost world server did not answer any more is not waited for on the next connection") {
  FakeWorld world;
  RunningRelay relay(world.port());
  FakeCommander first(relay.port(), 1), second(relay.port(), 2);
  REQUIRE(is_welcome(first.hello(false)));
  const int controls = world.count("CONTROL"), connections = world.connections();
  world.close_at_control();  // what Bye makes of it is not answered
  first.send(protocol::relay::Bye{1});
  // Connected anew, the relay begins a session and, as nobody wants it, ends it.
  REQUIRE(eventually([&] { return world.count("CONTROL") == controls + 3; }));
  CHECK(world.connections() == connections + 1);
  CHECK(is_welcome(second.hello(false)));
}
