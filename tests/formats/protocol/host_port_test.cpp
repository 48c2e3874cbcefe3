#include "formats/protocol/host_port.hpp"

#include <catch2/catch.hpp>

using kenaf::protocol::HostPort;
using kenaf::protocol::parse_host_port;
using kenaf::protocol::split_host_port;

TEST_CASE("Addresses, names and IPv6 addresses with and without brackets are hosts") {
  CHECK(parse_host_port("127.0.0.1:45454") == HostPort{"127.0.0.1", 45454});
  CHECK(parse_host_port("0.0.0.0:0") == HostPort{"0.0.0.0", 0});
  CHECK(parse_host_port("localhost:0") == HostPort{"localhost", 0});
  CHECK(parse_host_port("robot.example:3000") == HostPort{"robot.example", 3000});
  CHECK(parse_host_port("[::1]:4000") == HostPort{"::1", 4000});
  CHECK(parse_host_port("::1:4000") == HostPort{"::1", 4000});
  CHECK(parse_host_port("[fe80::1%eth0]:80") == HostPort{"fe80::1%eth0", 80});
}

TEST_CASE("One pair of brackets is taken off, half a pair is part of the host") {
  CHECK(parse_host_port("[[::1]]:80") == HostPort{"[::1]", 80});
  CHECK(parse_host_port("[::1:80") == HostPort{"[::1", 80});
  CHECK(parse_host_port("[:80") == HostPort{"[", 80});
}

TEST_CASE("A port is digits alone, from 0 to 65535") {
  CHECK(parse_host_port("a:65535") == HostPort{"a", 65535});
  CHECK(parse_host_port("a:00080") == HostPort{"a", 80});
  for (const char* wrong : {"a:65536", "a:70000", "a:99999999999999999999", "a:-1", "a:+1", "a: 1", "a:1 ", "a:0x10",
                            "a:1.5", "a:http", "[::1]"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_host_port(wrong));
  }
}

TEST_CASE("Without a colon, a host or a port it is refused") {
  for (const char* wrong : {"", ":", "localhost", "nowhere", "host:", ":5003", "[]:5003", "[]:", "8080"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_host_port(wrong));
    CHECK_FALSE(split_host_port(wrong));
  }
}

TEST_CASE("The two sides alone: a port may be the name of a service") {
  const auto sides = split_host_port("[::1]:http");
  REQUIRE(sides);
  CHECK(sides->host == "::1");
  CHECK(sides->port == "http");
}
