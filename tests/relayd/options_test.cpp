#include "relayd/options.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "relayd/sockets.hpp"

using namespace kenaf::relayd;

namespace {

std::optional<Options> read(std::vector<const char*> arguments, int& status) {
  arguments.insert(arguments.begin(), "kenaf-relayd");
  return read_options(static_cast<int>(arguments.size()), arguments.data(), status);
}

}  // namespace

TEST_CASE("Without options: loopback only, the world server's usual port") {
  int status = -1;
  const auto options = read({}, status);
  REQUIRE(options);
  CHECK(options->relay.world_server.host == "127.0.0.1");
  CHECK(options->relay.world_server.port == 3000);
  CHECK(options->relay.listen == parse_address("127.0.0.1:45454"));
  CHECK(is_loopback(options->relay.listen));
  CHECK(options->relay.placement.class_name == "USARBot.Kenaf");
  CHECK_FALSE(options->relay.placement.pose);
  CHECK_FALSE(options->embedded);
}

TEST_CASE("All options are read") {
  int status = -1;
  auto options = read({"--world-server", "[::1]:4000", "--listen", "0.0.0.0:0", "--class", "USARBot.P2AT", "--name",
                       "R", "--pose", "1,2,3,-0.1,0.2,0.3", "--log-level", "warn"},
                      status);
  REQUIRE(options);
  CHECK(options->relay.world_server.host == "::1");
  CHECK(options->relay.world_server.port == 4000);
  CHECK_FALSE(is_loopback(options->relay.listen));
  CHECK(options->relay.placement.pose == std::array<double, 6>{1, 2, 3, -0.1, 0.2, 0.3});
  CHECK(options->log_level == "warn");
  options = read({"--log-level", "warning"}, status);
  REQUIRE(options);
  CHECK(options->log_level == "warn");
  options =
      read({"--embedded", "--world", "step-100", "--robot", "kenaf", "--speed", "0", "--start", "start_1"}, status);
  REQUIRE(options);
  CHECK(options->embedded->world == "step-100");
  CHECK(options->embedded->speed == 0);
  CHECK(options->embedded->view == kenaf::live::ViewOptions{});
  CHECK(options->embedded->cameras == kenaf::image_server::CameraOptions{});
  CHECK(options->relay.placement.start == "start_1");
}

TEST_CASE("Cameras are chosen on the command line of --embedded") {
  int status = 0;
  const auto with_cameras =
      read({"--embedded", "--cameras", "off", "--camera-port", "0", "--camera-image", "raw"}, status);
  REQUIRE(with_cameras);
  CHECK_FALSE(with_cameras->embedded->cameras.on);
  CHECK(with_cameras->embedded->cameras.image_port == 0);
  CHECK(with_cameras->embedded->cameras.image_type == kenaf::image_server::ImageType::raw);
}

TEST_CASE("Wrong options end with status 2, help with 0") {
  int status = -1;
  for (const std::vector<const char*>& wrong :
       std::vector<std::vector<const char*>>{{"--listen", "nowhere"},
                                             {"--listen", "127.0.0.1:70000"},
                                             {"--listen", "some.host:1"},
                                             {"--world-server", "host"},
                                             {"--world-server", "host:"},
                                             {"--name", "two words"},
                                             {"--class", "a}b"},
                                             {"--pose", "1,2,3"},
                                             {"--pose", "1,2,3,4,5,6", "--start", "a"},
                                             {"--world", "flat"},
                                             {"--embedded", "--world-server", "a:1"},
                                             {"--embedded", "--speed", "-1"},
                                             {"--embedded", "--view", "8080"},
                                             {"--embedded", "--view-token", "a&b"},
                                             {"--view", "off"},
                                             {"--cameras", "off"},
                                             {"--embedded", "--camera-port", "65536"},
                                             {"--embedded", "--camera-image", "best"},
                                             {"--log-level", "loud"}}) {
    CAPTURE(wrong.front(), wrong.back());
    CHECK_FALSE(read(wrong, status));
    CHECK(status == 2);
  }
  CHECK_FALSE(read({"--help"}, status));
  CHECK(status == 0);
}

TEST_CASE("An address of IPv6 is the same with brackets and without, and written with them") {
  CHECK(to_text(parse_address("[::1]:45454")) == "[::1]:45454");
  CHECK(parse_address("::1:45454") == parse_address("[::1]:45454"));
  CHECK(is_loopback(parse_address("::1:1")));
  CHECK_FALSE(is_ipv4(parse_address("::1:1")));
  CHECK_FALSE(is_loopback(parse_address("[::]:1")));
  CHECK(to_text(parse_address("[2001:DB8:0:0:0:0:0:1]:1")) == "[2001:db8::1]:1");
  CHECK(parse_address("localhost:1") == parse_address("127.0.0.1:1"));
  CHECK(is_loopback(parse_address("127.9.9.9:1")));
  // IPv4 within IPv6 is the IPv4 address, as a socket of both families sees its peers
  CHECK(parse_address("[::ffff:10.0.0.2]:1") == parse_address("10.0.0.2:1"));
  CHECK(to_text(parse_address("[::ffff:10.0.0.2]:1")) == "10.0.0.2:1");
}

TEST_CASE("A zone is the interface's name or number") {
  CHECK(to_text(parse_address("[fe80::1%1]:80")) == "[fe80::1%1]:80");
  CHECK(parse_address("[fe80::1%lo]:80").zone != 0);
  CHECK_THROWS_WITH(parse_address("[fe80::1%nosuch0]:80"), Catch::Contains("nosuch0"));
}

TEST_CASE("An address is the same for the system's calls and back") {
  for (const char* text : {"127.0.0.1:80", "[::1]:80", "[fe80::1%1]:65535", "0.0.0.0:0"}) {
    const Address address = parse_address(text);
    CHECK(address_of(endpoint_of(address, AF_INET6).address) == address);
    if (is_ipv4(address)) CHECK(address_of(endpoint_of(address, AF_INET).address) == address);
  }
}

TEST_CASE("An address in use is named") {
  Address bound, second;
  const Descriptor first = open_udp(parse_address("127.0.0.1:0"), bound);
  CHECK(bound.port != 0);
  CHECK_THROWS_WITH(open_udp(bound, second), Catch::Contains(to_text(bound)) && Catch::Contains("--listen"));
}
