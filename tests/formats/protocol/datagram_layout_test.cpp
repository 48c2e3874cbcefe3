// The bytes of every kind, written by hand from the layout: little-endian, no padding; header u32 magic, u8 version,
// u8 kind, u16 length, u64 session; then the fields in their order.
#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"
#include "tests/formats/protocol/encoded.hpp"
#include "tests/support/robot_command.hpp"

using kenaf::protocol::DecodeError;
using namespace kenaf::protocol::relay;

namespace {

// "4b 4e" as bytes.
std::vector<std::byte> bytes_from_hex(std::string_view hex) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < hex.size(); ++i) {
    if (hex[i] == ' ') continue;
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    ++i;
  }
  return bytes;
}

// Encodes to exactly `hex`, and `hex` decodes to what encodes to it again.
void check_bytes(const Datagram& datagram, const std::string& hex) {
  const std::vector<std::byte> expected = bytes_from_hex(hex);
  CHECK(encoded(datagram) == expected);
  Datagram read = Bye{9};
  REQUIRE(decode(expected, read) == DecodeError::none);
  CHECK(read.index() == datagram.index());
  CHECK(encoded(read) == expected);
}

// Doubles whose bytes are easy to write by hand.
const std::string kOne = "00 00 00 00 00 00 f0 3f ";
const std::string kTwo = "00 00 00 00 00 00 00 40 ";
const std::string kMinusOne = "00 00 00 00 00 00 f0 bf ";
const std::string kHalf = "00 00 00 00 00 00 e0 3f ";
const std::string kZero = "00 00 00 00 00 00 00 00 ";
const std::string kSession = "08 07 06 05 04 03 02 01 ";  // 0x0102030405060708
constexpr std::uint64_t kSessionValue = 0x0102030405060708;

}  // namespace

TEST_CASE("Hello is 34 bytes") {
  check_bytes(Hello{kSessionValue, 1.0, 0.5, true, false},
              "4b 4e 41 46 01 01 22 00 " + kSession + kOne + kHalf + "01 00");
}

TEST_CASE("Welcome is 33 bytes") {
  check_bytes(Welcome{kSessionValue, 2.0, 1.0, true}, "4b 4e 41 46 01 02 21 00 " + kSession + kTwo + kOne + "01");
}

TEST_CASE("Refused is 218 bytes: the reason, 200 characters padded with zeros, their count") {
  Refused refused{kSessionValue, RefusedReason::unknown_session, {}, 2};
  refused.text[0] = 'n';
  refused.text[1] = 'o';
  std::string padding;
  for (int i = 0; i < 198; ++i) padding += "00 ";
  check_bytes(refused, "4b 4e 41 46 01 03 da 00 " + kSession + "03 6e 6f " + padding + "02");
}

TEST_CASE("Command is 73 bytes") {
  check_bytes(Command{kSessionValue, 0x01020304, 7, kenaf::support::command_of({1.0, -1.0}, 0b0101, {0.5, 0, 2.0, 0})},
              "4b 4e 41 46 01 04 49 00 " + kSession + "04 03 02 01 07 00 00 00 " + kOne + kMinusOne + "05 " + kHalf +
                  kZero + kTwo + kZero);
}

TEST_CASE("State is 284 bytes") {
  State state{};
  state.session = kSessionValue;
  state.robot.frame = 1;
  state.acknowledged = 2;
  state.robot.late_commands = 3;
  state.robot.fields =
      kenaf::robot::kHasPosture | kenaf::robot::kHasGroundTruth | kenaf::robot::held(kenaf::robot::kHasPosture);
  state.world_paused = true;
  state.not_at_start = true;
  state.robot.robot_time_s = 1;
  state.robot.posture_rad = {2, 0, 0};
  state.robot.gyro_radps = {0, 2, 0};
  state.robot.acceleration_mps2 = {0, 0, 2};
  state.robot.track_m = {1, 2};
  state.robot.track_mps = {2, 1};
  state.robot.track_a = {0.5, 1};
  state.robot.flipper_rad = {1, 2, -1, 0.5};
  state.robot.flipper_a = {0.5, -1, 2, 1};
  state.robot.battery_v = 2;
  state.robot.p_WB_m = {1, -1, 0.5};
  state.robot.orientation_rad = {0.5, 1, -1};
  check_bytes(state, "4b 4e 41 46 01 05 1c 01 " + kSession +
                         "01 00 00 00 02 00 00 00 03 00 00 00 41 00 01 00 0c 00 00 00 " + kOne + kTwo + kZero + kZero +
                         kZero + kTwo + kZero + kZero + kZero + kTwo + kOne + kTwo + kTwo + kOne + kHalf + kOne + kOne +
                         kTwo + kMinusOne + kHalf + kHalf + kMinusOne + kTwo + kOne + kTwo + kOne + kMinusOne + kHalf +
                         kHalf + kOne + kMinusOne);
}

TEST_CASE("A flipper that the robot has not is an event bit, and comes back as none") {
  State state{};
  state.session = kSessionValue;
  state.robot.fields = kenaf::robot::kHasFlippers;
  state.robot.flipper_rad = {1, 2, kenaf::robot::kNoFlipper, kenaf::robot::kNoFlipper};
  const std::vector<std::byte> bytes = encoded(state);
  CHECK(bytes[32] == std::byte{0xc0});                                      // bits 6 and 7 of the events
  for (std::size_t i = 180; i < 196; ++i) CHECK(bytes[i] == std::byte{0});  // angles of flippers 2 and 3
  Datagram read = Bye{9};
  REQUIRE(decode(bytes, read) == DecodeError::none);
  const auto& angles = std::get<State>(read).robot.flipper_rad;
  CHECK(angles[0] == 1);
  CHECK(angles[1] == 2);
  CHECK(std::isnan(angles[2]));
  CHECK(std::isnan(angles[3]));

  // without any flipper there is none to miss
  state.robot.fields = 0;
  CHECK(encoded(state)[32] == std::byte{0});
}

TEST_CASE("An angle of a flipper that is not there, and a missing one of a robot without flippers, are no State") {
  State state{};
  state.session = kSessionValue;
  state.robot.fields = kenaf::robot::kHasFlippers;
  state.robot.flipper_rad = {1, 2, 3, kenaf::robot::kNoFlipper};
  const std::vector<std::byte> bytes = encoded(state);
  Datagram read = Bye{9};
  for (const std::byte last : {std::byte{0x80}, std::byte{0x3f}}) {  // of flipper 3's angle: -0, and one
    std::vector<std::byte> angle = bytes;
    angle[195] = last;
    CHECK(decode(angle, read) == DecodeError::bad_value);
  }
  std::vector<std::byte> none = bytes;
  none[28] = std::byte{0};  // bit 2 of the fields
  CHECK(decode(none, read) == DecodeError::bad_value);
  CHECK(decode(bytes, read) == DecodeError::none);
}

TEST_CASE("Bye is the header alone, Ping and Pong carry their number") {
  check_bytes(Bye{kSessionValue}, "4b 4e 41 46 01 06 10 00 " + kSession);
  check_bytes(Ping{kSessionValue, 5}, "4b 4e 41 46 01 07 14 00 " + kSession + "05 00 00 00");
  check_bytes(Pong{kSessionValue, 5}, "4b 4e 41 46 01 08 14 00 " + kSession + "05 00 00 00");
}

TEST_CASE("Every value comes back, -0 and the smallest double too") {
  Command command{~0ull, ~0u, ~0u,
                  kenaf::support::command_of({-0.0, 5e-324}, 0x0f, {-1.7976931348623157e308, 0.1, 1.0 / 3, -2.5})};
  Datagram read = Bye{9};
  REQUIRE(decode(encoded(command), read) == DecodeError::none);
  const Command& again = std::get<Command>(read);
  CHECK(again.session == command.session);
  CHECK(again.sequence == command.sequence);
  CHECK(again.frame == command.frame);
  CHECK(again.robot == command.robot);
  CHECK(std::signbit(again.robot.track_speed_mps[kenaf::robot::kLeft]));
}

TEST_CASE("A reason of full length and one that claims more than there is room for") {
  Refused refused{1, RefusedReason::busy, {}, kMaxReasonBytes};
  refused.text.fill('x');
  Datagram read = Bye{9};
  REQUIRE(decode(encoded(refused), read) == DecodeError::none);
  CHECK(std::get<Refused>(read).text == refused.text);
  CHECK(std::get<Refused>(read).text_length == kMaxReasonBytes);
  refused.text_length = 100000;
  REQUIRE(decode(encoded(refused), read) == DecodeError::none);
  CHECK(std::get<Refused>(read).text_length == kMaxReasonBytes);
}
