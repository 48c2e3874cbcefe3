// The fields that datagrams are made of, with a protocol of the test's own; the real ones are in datagram_layout_test,
// datagram_errors_test and tests/teleop/link_test.
#include "formats/protocol/datagram_codec.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace kenaf::protocol::codec_test {
namespace {

enum class Colour : std::uint8_t { red = 1, green = 2 };

struct Fields {
  std::uint64_t session;
  std::uint32_t counter;
  double limited;
  std::uint8_t bits;
  Colour colour;
  std::array<char, 4> last_length, first_length;
  std::size_t last, first;
};
struct Empty {
  std::uint64_t session;
};
using Datagram = std::variant<Fields, Empty>;

constexpr DatagramProtocol kTest{0x01020304, 7};
constexpr auto kWalk = [](auto& io, auto& m) {
  if constexpr (requires { m.counter; }) {
    io.counter(m.counter);
    io.number(m.limited, 10);
    io.bits(m.bits, std::uint8_t{0b011});
    io.choice(m.colour, Colour::green);
    io.text_and_length(m.last_length, m.last);
    io.length_and_text(m.first, m.first_length);
    io.check(m.bits != 3);
  }
};

std::vector<std::byte> encoded(const Datagram& datagram) {
  std::vector<std::byte> out(100);
  out.resize(encode_datagram(kTest, datagram, out, kWalk));
  return out;
}

Fields some() {
  return {5, 1, -2.5, 0b010, Colour::green, {'a', 'b'}, {'x', 'y', 'z', 'w'}, 2, 4};
}

DecodeError error_of(const std::vector<std::byte>& bytes, const DatagramProtocol& protocol = kTest) {
  Datagram out = Empty{9};
  const DecodeError error = decode_datagram(protocol, bytes, out, kWalk);
  if (error != DecodeError::none) {
    REQUIRE(std::holds_alternative<Empty>(out));
    CHECK(std::get<Empty>(out).session == 9);
  }
  return error;
}

}  // namespace

TEST_CASE("A datagram of two kinds reads back field by field") {
  Datagram out = Empty{9};
  const std::vector<std::byte> bytes = encoded(some());
  CHECK(bytes.size() == 16 + 4 + 8 + 1 + 1 + 5 + 5);
  CHECK(std::to_integer<int>(bytes[6]) == 40);
  REQUIRE(decode_datagram(kTest, bytes, out, kWalk) == DecodeError::none);
  const Fields& read = std::get<Fields>(out);
  CHECK(read.session == 5);
  CHECK(read.counter == 1);
  CHECK(read.limited == -2.5);
  CHECK(read.bits == 0b010);
  CHECK(read.colour == Colour::green);
  CHECK(read.last_length == some().last_length);
  CHECK(read.first_length == some().first_length);
  CHECK(read.last == 2);
  CHECK(read.first == 4);
  REQUIRE(decode_datagram(kTest, encoded(Empty{6}), out, kWalk) == DecodeError::none);
  CHECK(std::get<Empty>(out).session == 6);
}

TEST_CASE("What is beyond its range is written so that it can be read") {
  Fields wild = some();
  wild.limited = std::numeric_limits<double>::quiet_NaN();
  wild.bits = 0xfe;
  wild.last = 1;  // 'b' is behind it
  wild.first = 1000;
  Datagram out = Empty{9};
  REQUIRE(decode_datagram(kTest, encoded(wild), out, kWalk) == DecodeError::none);
  CHECK(std::get<Fields>(out).limited == 0);
  CHECK(std::get<Fields>(out).bits == 0b010);
  CHECK(std::get<Fields>(out).last_length == std::array<char, 4>{'a'});
  CHECK(std::get<Fields>(out).first == 4);
  wild.limited = -HUGE_VAL;
  REQUIRE(decode_datagram(kTest, encoded(wild), out, kWalk) == DecodeError::none);
  CHECK(std::get<Fields>(out).limited == -10);
}

TEST_CASE("Every field is refused by its reason") {
  const auto with = [](std::size_t at, int value) {
    std::vector<std::byte> bytes = encoded(some());
    bytes.at(at) = static_cast<std::byte>(value);
    return error_of(bytes);
  };
  CHECK(with(16, 0) == DecodeError::out_of_range);  // the counter
  CHECK(with(27, 0x7f) == DecodeError::out_of_range);
  CHECK(with(28, 0b110) == DecodeError::bad_value);
  CHECK(with(28, 0b011) == DecodeError::bad_value);  // the protocol's own check
  CHECK(with(29, 0) == DecodeError::bad_value);
  CHECK(with(29, 3) == DecodeError::bad_value);
  CHECK(with(33, 'c') == DecodeError::bad_value);  // behind the text
  CHECK(with(34, 5) == DecodeError::bad_value);
  CHECK(with(35, 5) == DecodeError::bad_value);
  CHECK(with(35, 3) == DecodeError::bad_value);
}

TEST_CASE("Another protocol and another version are distinguished, and the first that is wrong counts") {
  CHECK(error_of(encoded(Empty{1}), {kTest.magic + 1, kTest.version + 1}) == DecodeError::bad_magic);
  CHECK(error_of(encoded(Empty{1}), {kTest.magic, kTest.version + 1}) == DecodeError::bad_version);
  CHECK(error_of(encoded(Empty{0})) == DecodeError::bad_session);
  std::vector<std::byte> bytes = encoded(some());
  bytes[16] = std::byte{0};  // counter 0, and colour 9
  bytes[29] = std::byte{9};
  CHECK(error_of(bytes) == DecodeError::out_of_range);
}

TEST_CASE("Every error has words of its own") {
  std::vector<std::string_view> seen;
  for (int code = 0; code <= static_cast<int>(DecodeError::bad_value); ++code) {
    const std::string_view words = describe(static_cast<DecodeError>(code));
    CHECK(words.size() > 10);
    CHECK(std::find(seen.begin(), seen.end(), words) == seen.end());
    seen.push_back(words);
  }
}

}  // namespace kenaf::protocol::codec_test
