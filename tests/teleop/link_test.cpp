// The bytes of every kind of datagram are written by hand from the layout of teleop/link.hpp, and each must read back
// to the values that write the same bytes again. A datagram that is cut, prolonged or changed beyond its range is
// refused with its reason. Everything that is sent can be read: numbers beyond their limits are written as the limit,
// text as printable ASCII.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "teleop/link.hpp"

using kenaf::protocol::DecodeError;
using namespace kenaf::teleop;

namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_from_hex(std::string_view hex) {
  Bytes bytes;
  for (std::size_t i = 0; i < hex.size(); ++i) {
    if (hex[i] == ' ') continue;
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    ++i;
  }
  return bytes;
}

Bytes encoded(const Datagram& datagram) {
  Bytes out(kMaxDatagramBytes);
  out.resize(encode(datagram, out));
  return out;
}

DecodeError error_of(const Bytes& bytes) {
  Datagram out = Bye{9};
  const DecodeError error = decode(bytes, out);
  if (error != DecodeError::none) CHECK(std::get<Bye>(out).session == 9);  // unchanged
  return error;
}

void check_bytes(const Datagram& datagram, const std::string& hex) {
  const Bytes expected = bytes_from_hex(hex);
  CHECK(encoded(datagram) == expected);
  Datagram read = Bye{9};
  REQUIRE(decode(expected, read) == DecodeError::none);
  CHECK(read.index() == datagram.index());
  CHECK(encoded(read) == expected);
}

std::string zeros(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += "00 ";
  return out;
}

// Doubles whose bytes are easy to write by hand: 1 = 0x3ff0..., 2 = 0x4000..., 0.5 = 0x3fe0..., -1 = 0xbff0...
const std::string kOne = "00 00 00 00 00 00 f0 3f ";
const std::string kTwo = "00 00 00 00 00 00 00 40 ";
const std::string kHalf = "00 00 00 00 00 00 e0 3f ";
const std::string kMinusOne = "00 00 00 00 00 00 f0 bf ";
const std::string kSession = "08 07 06 05 04 03 02 01 ";
constexpr std::uint64_t kSessionValue = 0x0102030405060708;

Wish some_wish() {
  return {.session = kSessionValue,
          .sequence = 3,
          .newest_status = 2,
          .deadman = true,
          .emergency_stop = false,
          .release_emergency = false,
          .track_mmps = {1, -1},
          .flipper_order = 1,
          .flipper_deg = {0.5, 0, 2, 0}};
}

Status some_status() {
  Status status{};
  status.session = kSessionValue;
  status.sequence = 4;
  status.newest_wish = 3;
  status.wish_age_s = 0.5;
  status.wishes_received = 2;
  status.mode = Mode::driving;
  status.halt = Halt::silence;
  status.fields = kHasPose | kHasPosture;
  status.flags = kSimulated;
  status.robot_time_s = 2;
  status.posture_deg = {0, -1, 0};
  status.flippers_commanded = 0b1010;
  status.battery_v = 1;
  status.message = text_of("hi");
  return status;
}

// Where a field of the Wish lies: header 16, sequence 4, newest status 4, three flags, tracks 16, order 4, flippers.
constexpr std::size_t kDeadmanAt = 24, kLeftTrackAt = 27, kFlippersAt = 47;

Bytes with_number(Bytes bytes, std::size_t at, double value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

}  // namespace

TEST_CASE("Wish is 79 bytes") {
  check_bytes(some_wish(), "4b 4e 4f 50 01 01 4f 00 " + kSession + "03 00 00 00 02 00 00 00 01 00 00 " + kOne +
                               kMinusOne + "01 00 00 00 " + kHalf + zeros(8) + kTwo + zeros(8));
}

TEST_CASE("Status is 617 bytes") {
  const std::string texts = "02 68 69 " + zeros(158) + "00 " + zeros(160);
  check_bytes(some_status(), "4b 4e 4f 50 01 02 69 02 " + kSession + "04 00 00 00 03 00 00 00 " + kHalf +
                                 "02 00 00 00 05 02 " + "41 00 00 00 01 00 00 00 " + kTwo + zeros(8) + kMinusOne +
                                 zeros(8) + zeros(16 + 16 + 16 + 32) + "0a " + zeros(32 + 32) + zeros(4) + kOne +
                                 zeros(24 + 24 + 8) + zeros(4) + texts);
}

TEST_CASE("Taken is 177 bytes, Bye 16") {
  check_bytes(Taken{kSessionValue, text_of("ab")}, "4b 4e 4f 50 01 03 b1 00 " + kSession + "02 61 62 " + zeros(158));
  check_bytes(Bye{kSessionValue}, "4b 4e 4f 50 01 04 10 00 " + kSession);
}

TEST_CASE("Cut anywhere, or with a byte too many, it is refused") {
  for (const Datagram& datagram : {Datagram(some_wish()), Datagram(some_status())}) {
    Bytes whole = encoded(datagram);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      CHECK(error_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))) ==
            DecodeError::too_short);
    }
    whole.push_back(std::byte{0});
    CHECK(error_of(whole) == DecodeError::too_long);
    whole[6] = static_cast<std::byte>(whole.size() & 0xff);  // and says so itself
    whole[7] = static_cast<std::byte>(whole.size() >> 8);
    CHECK(error_of(whole) == DecodeError::too_long);
  }
}

TEST_CASE("A wrong header is refused by its reason") {
  const auto with_byte = [](std::size_t at, int value) {
    Bytes bytes = encoded(some_wish());
    bytes[at] = static_cast<std::byte>(value);
    return error_of(bytes);
  };
  CHECK(with_byte(0, 'X') == DecodeError::bad_magic);
  CHECK(with_byte(4, 2) == DecodeError::bad_version);
  CHECK(with_byte(5, 0) == DecodeError::bad_kind);
  CHECK(with_byte(5, 5) == DecodeError::bad_kind);
  CHECK(with_byte(5, 4) == DecodeError::too_long);  // a Bye of a Wish's length
  CHECK(error_of(encoded(Bye{0})) == DecodeError::bad_session);
  CHECK(with_byte(16, 0) == DecodeError::out_of_range);  // sequence 3 becomes 0
  CHECK(with_byte(kDeadmanAt, 2) == DecodeError::bad_value);
}

TEST_CASE("Numbers that no operator wishes are refused: NaN, infinity, beyond what hrt.h takes") {
  const Bytes wish = encoded(some_wish());
  CHECK(error_of(with_number(wish, kLeftTrackAt, std::nan(""))) == DecodeError::not_finite);
  CHECK(error_of(with_number(wish, kLeftTrackAt, -HUGE_VAL)) == DecodeError::not_finite);
  CHECK(error_of(with_number(wish, kLeftTrackAt, 2000)) == DecodeError::none);
  CHECK(error_of(with_number(wish, kLeftTrackAt, -2000.0001)) == DecodeError::out_of_range);
  CHECK(error_of(with_number(wish, kFlippersAt, 360)) == DecodeError::none);
  CHECK(error_of(with_number(wish, kFlippersAt, 361)) == DecodeError::out_of_range);
}

TEST_CASE("A mode, a halt, bits or a text that are none are refused") {
  const auto with_byte = [](std::size_t at, int value) {
    Bytes bytes = encoded(some_status());
    bytes[at] = static_cast<std::byte>(value);
    return error_of(bytes);
  };
  // header 16, sequence 4, newest wish 4, age 8, received 4: mode at 36, halt at 37, fields at 38, flags at 42
  CHECK(with_byte(36, 0) == DecodeError::bad_value);
  CHECK(with_byte(36, 6) == DecodeError::bad_value);
  CHECK(with_byte(37, 6) == DecodeError::bad_value);
  CHECK(with_byte(38, 0x80) == DecodeError::bad_value);
  CHECK(with_byte(42, 0x20) == DecodeError::bad_value);
  const std::size_t message_at = 617 - 2 * 161;
  CHECK(with_byte(message_at, 161) == DecodeError::bad_value);       // longer than it can be
  CHECK(with_byte(message_at, 1) == DecodeError::bad_value);         // shorter than what stands there
  CHECK(with_byte(message_at + 1, 0x1b) == DecodeError::bad_value);  // escape: would steer the terminal
}

TEST_CASE("What is sent can be read") {
  Wish wish = some_wish();
  wish.track_mmps = {std::nan(""), -1e9};
  wish.flipper_deg = {1e9, HUGE_VAL, 0, 0};
  Datagram read = Bye{9};
  REQUIRE(decode(encoded(wish), read) == DecodeError::none);
  CHECK(std::get<Wish>(read).track_mmps == std::array{0.0, -2000.0});
  CHECK(std::get<Wish>(read).flipper_deg == std::array{360.0, 360.0, 0.0, 0.0});

  CHECK(view(text_of("a\x1b[2J\xff\n")) == "a?[2J??");
  CHECK(text_of(std::string(500, 'x')).length == kMaxTextBytes);
}
