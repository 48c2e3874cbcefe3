// The operator's sockets: addresses of both families, and names that have several.
#include "teleop/udp.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/support/loopback.hpp"
#include "tests/support/patience.hpp"

using namespace kenaf::teleop;
using namespace std::chrono_literals;

namespace {

const std::array<std::byte, 3> kWords{std::byte{1}, std::byte{2}, std::byte{3}};

// The server answers the client, which says its words until it hears something.
bool is_answered(UdpSocket& client, UdpSocket& server) {
  std::array<std::byte, 10> buffer;
  return kenaf::support::eventually([&] {
    client.send(kWords);
    Peer from;
    if (const auto got = server.receive(buffer, from)) server.send(std::span(buffer).first(*got), from);
    return client.receive(buffer, from) == kWords.size();
  });
}

// Nobody listens there: the port was another socket's, which is closed.
Peer deserted(const std::string& host) {
  const UdpSocket gone = UdpSocket::bound_to(resolve_listener(host + ":0"));
  return resolve_listener(host + ":" + std::to_string(gone.port()));
}

}  // namespace

TEST_CASE("An address of IPv6 is the same with brackets and without") {
  if (!kenaf::test::has_ipv6_loopback()) {
    WARN("skipped: this machine has no address ::1");
    return;
  }
  CHECK(to_text(resolve_listener("::1:80")) == "[::1]:80");
  CHECK(to_text(resolve_listener("[::1]:80")) == "[::1]:80");
  UdpSocket server = UdpSocket::bound_to(resolve_listener("[::1]:0"));
  UdpSocket client = UdpSocket::connected_to(resolve("::1:" + std::to_string(server.port())));
  CHECK(is_answered(client, server));
}

// All of 127.0.0.0/8 are this machine's. The system would answer from 127.0.0.1, which a connected socket does not
// take.
TEST_CASE("A server on every address answers from the one that its client asked") {
  for (const std::string listen : {"0.0.0.0:0", "[::]:0"}) {
    if (listen.starts_with("[") && !kenaf::test::has_ipv6_loopback()) continue;
    INFO(listen);
    UdpSocket server = UdpSocket::bound_to(resolve_listener(listen));
    UdpSocket client = UdpSocket::connected_to(resolve("127.0.0.2:" + std::to_string(server.port())));
    CHECK(is_answered(client, server));
  }
}

TEST_CASE("Of the addresses of a name the one where somebody listens is found") {
  UdpSocket server = UdpSocket::bound_to(resolve_listener("localhost:0"));
  const Peer there = resolve_listener("127.0.0.1:" + std::to_string(server.port()));
  std::vector<Peer> remotes{deserted("127.0.0.1"), there};
  if (kenaf::test::has_ipv6_loopback()) remotes.insert(remotes.begin(), deserted("::1"));
  UdpSocket client = UdpSocket::connected_to(remotes);
  CHECK(is_answered(client, server));
}

TEST_CASE("What is no HOST:PORT is refused in the words of all programs") {
  for (const char* wrong : {"", "localhost", "::1", "[::1]", "host:"}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(require_host_port(wrong), Catch::StartsWith("must be HOST:PORT"));
    CHECK_THROWS_WITH(resolve(wrong), Catch::Contains("must be HOST:PORT"));
  }
}
