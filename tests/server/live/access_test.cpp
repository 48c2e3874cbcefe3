// Who may look and drive. Hosts and origins as browsers write them (RFC 9110 section 7.2, RFC 6454 section 7).
#include "server/live/access.hpp"

#include <catch2/catch.hpp>

#include "server/live/speed_meter.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::live {

TEST_CASE("A host that names an address or this machine is served, one that a name server may point here is not") {
  for (const char* host : {"127.0.0.1", "127.0.0.1:8080", "localhost", "LocalHost:1", "[::1]", "[::1]:8080",
                           "192.168.1.5:80", "workbench", "workbench.local:8080", "WORKBENCH"}) {
    INFO(host);
    CHECK(host_allowed(host, "workbench"));
  }
  for (const char* host :
       {"", "evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
        "evil.example#127.0.0.1", "127.0.0.1:", "127.0.0.1:80:80", "127.0.0.1:http", "[::1", "[::1]x", "[127.0.0.1]",
        "0x7f.1", "2130706433", "user@localhost", "workbench.evil.example"}) {
    INFO(host);
    CHECK_FALSE(host_allowed(host, "workbench"));
  }
  CHECK_FALSE(host_allowed(std::string(300, '1'), "workbench"));
  CHECK_FALSE(host_allowed(".local", ""));
}

TEST_CASE("A page's origin is this server, or nobody's") {
  CHECK(origin_allowed("", "127.0.0.1:8080"));
  CHECK(origin_allowed("http://127.0.0.1:8080", "127.0.0.1:8080"));
  CHECK(origin_allowed("https://robot.local", "robot.local"));  // behind a proxy that encrypts
  for (const char* origin : {"null", "http://127.0.0.1", "http://127.0.0.1:8081", "http://evil.example", "file://",
                             "http://evil.example/127.0.0.1:8080", "ws://127.0.0.1:8080", "127.0.0.1:8080"}) {
    INFO(origin);
    CHECK_FALSE(origin_allowed(origin, "127.0.0.1:8080"));
  }
}

TEST_CASE("A token is found in a query, compared whole, and made of 128 bits that differ") {
  CHECK(query_value("token=abc", "token") == "abc");
  CHECK(query_value("a=1&token=abc&b=2", "token") == "abc");
  CHECK(query_value("xtoken=abc", "token").empty());
  CHECK(query_value("token", "token").empty());
  CHECK(query_value("", "token").empty());
  CHECK(equal_in_constant_time("abc", "abc"));
  CHECK_FALSE(equal_in_constant_time("abc", "abd"));
  CHECK_FALSE(equal_in_constant_time("abc", "ab"));
  CHECK_FALSE(equal_in_constant_time("", "a"));
  const std::string one = make_token(), other = make_token();
  CHECK(one.size() == 32);
  CHECK(one.find_first_not_of("0123456789abcdef") == std::string::npos);
  CHECK(one != other);
}

TEST_CASE("The option --view is an address with a port, or off") {
  CHECK_FALSE(parse_view_options("off").on);
  CHECK(parse_view_options("127.0.0.1:8080") == ViewOptions{});
  CHECK(parse_view_options("localhost:0").address == "127.0.0.1");
  CHECK(parse_view_options("0.0.0.0:80").port == 80);
  CHECK(parse_view_options("[::1]:8080").address == "::1");
  CHECK(parse_view_options("::1:8080") == parse_view_options("[::1]:8080"));
  for (const char* wrong : {"", "on", "8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:70000", "127.0.0.1:-1",
                            "127.0.0.1:8080x", "some.host:80", "::1", "[127.0.0.1]:80", ":80"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(parse_view_options(wrong),
                      Catch::StartsWith("must be ADDRESS:PORT, ") && Catch::EndsWith("or off"));
  }
}

TEST_CASE("A token that stands in an address as it is is taken, another is not") {
  for (const char* token : {"", "chosen", "0123456789abcdef", "A-b.C_d~9"}) CHECK(parse_view_token(token) == token);
  for (const char* token : {"a b", "a=b", "a+b", "a/b", "a&b", "a%20b", "a#b", "a?b", "\xc3\xa4"}) {
    INFO(token);
    CHECK_THROWS_WITH(parse_view_token(token), Catch::Contains("letters, digits"));
  }
}

TEST_CASE("The speed is that of the last second") {
  SpeedMeter meter;
  CHECK(meter.read(100, 7) == 0);
  CHECK(meter.read(100.5, 7.25) == Approx(0.5));
  CHECK(meter.read(101.5, 9.25) == Approx(2));  // 2 s within the last second, the half speed before is forgotten
  CHECK(meter.read(102.5, 9.25) == Approx(0));
  CHECK(meter.read(103, 0) == 0);  // put back to its start
  CHECK(meter.read(103.5, 0.5) == Approx(1));
}

}  // namespace kenaf::live
