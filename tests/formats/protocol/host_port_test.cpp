#include "formats/protocol/host_port.hpp"

#include <catch2/catch.hpp>

using kenaf::protocol::HostPort;
using kenaf::protocol::parse_host;
using kenaf::protocol::parse_host_port;
using kenaf::protocol::parse_listen_host;
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

TEST_CASE("An IPv6 address is a whole one, and brackets come in one pair") {
  CHECK(parse_host_port("2001:db8:0:0:0:0:0:1:80") == HostPort{"2001:db8:0:0:0:0:0:1", 80});
  CHECK(parse_host_port("::ffff:10.0.0.1:80") == HostPort{"::ffff:10.0.0.1", 80});
  CHECK(parse_host_port("[::]:0") == HostPort{"::", 0});
  CHECK(parse_host_port(":::80") == HostPort{"::", 80});
  CHECK(parse_host_port("[::1%2]:80") == HostPort{"::1%2", 80});
  for (const char* wrong :
       {"[[::1]]:80", "[::1:80", "::1]:80", "[:80", "::1", "fe80::1", "a:b:80", "1:2:3:80", "[::1]80", "[::1]",
        "[::1%]:80", "[a:b]:80", "[::1] :80", "[localhost]:80", "[127.0.0.1]:80"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_host_port(wrong));
  }
}

TEST_CASE("A host alone is the same with brackets and without") {
  CHECK(parse_host("::1") == "::1");
  CHECK(parse_host("[::1]") == "::1");
  CHECK(parse_host("[fe80::1%eth0]") == "fe80::1%eth0");
  CHECK(parse_host("robot.example") == "robot.example");
  CHECK(parse_host("::1:80") == "::1:80");  // an address too: there is no port here
  for (const char* wrong : {"", "[]", "[::1", "::1]", "localhost:80", "127.0.0.1:80", "[::1]:80", ":"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_host(wrong));
  }
}

TEST_CASE("To listen there must be an address in digits, or localhost") {
  CHECK(parse_listen_host("localhost") == "127.0.0.1");
  CHECK(parse_listen_host("0.0.0.0") == "0.0.0.0");
  CHECK(parse_listen_host("[::]") == "::");
  CHECK(parse_listen_host("::1") == "::1");
  for (const char* wrong : {"", "robot.example", "127.1", "0x7f000001", "127.0.0.1:80", "256.0.0.1", "1.2.3.4 "}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_listen_host(wrong));
  }
}

TEST_CASE("An address is written as it is read") {
  for (const HostPort& address : {HostPort{"127.0.0.1", 80}, HostPort{"::1", 0}, HostPort{"fe80::1%eth0", 65535}})
    CHECK(parse_host_port(to_text(address)) == address);
  CHECK(to_text(HostPort{"::1", 80}) == "[::1]:80");
  CHECK(to_text(HostPort{"robot", 80}) == "robot:80");
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
