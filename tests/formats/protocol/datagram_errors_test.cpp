// Every way in which a datagram is refused; `out` is left alone each time.
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"
#include "tests/formats/protocol/encoded.hpp"
#include "tests/support/robot_command.hpp"

using kenaf::protocol::DecodeError;
using namespace kenaf::protocol::relay;

namespace {

std::vector<std::byte> with(std::vector<std::byte> bytes, std::size_t offset, int value) {
  bytes.at(offset) = static_cast<std::byte>(value);
  return bytes;
}

DecodeError error_of(const std::vector<std::byte>& bytes) {
  Datagram out = Ping{77, 88};
  const DecodeError error = decode(bytes, out);
  if (error != DecodeError::none) {
    REQUIRE(std::holds_alternative<Ping>(out));
    CHECK(std::get<Ping>(out).session == 77);
    CHECK(std::get<Ping>(out).id == 88);
  }
  return error;
}

const std::vector<Datagram> kOneOfEach{Hello{1, 0.01, 0.5, true, true},
                                       Welcome{1, 0, 0.01, true},
                                       Refused{1, RefusedReason::busy, {}, 0},
                                       Command{1, 1, 0, kenaf::support::command_of({}, 15)},
                                       empty_state(),
                                       Bye{1},
                                       Ping{1, 1},
                                       Pong{1, 1}};

}  // namespace

TEST_CASE("Cut short anywhere, every kind is too short") {
  for (const Datagram& datagram : kOneOfEach) {
    const std::vector<std::byte> whole = encoded(datagram);
    REQUIRE(error_of(whole) == DecodeError::none);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CHECK(error_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}) == DecodeError::too_short);
    }
  }
}

TEST_CASE("A length field that agrees with the bytes does not make a short payload whole") {
  std::vector<std::byte> bytes = encoded(Ping{1, 1});
  bytes.resize(18);
  CHECK(error_of(with(bytes, 6, 18)) == DecodeError::too_short);
}

TEST_CASE("Bytes after the last field are too long, whether the length field counts them or not") {
  for (const Datagram& datagram : kOneOfEach) {
    std::vector<std::byte> bytes = encoded(datagram);
    bytes.push_back(std::byte{0});
    CHECK(error_of(bytes) == DecodeError::too_long);
    bytes = with(bytes, 6, static_cast<int>(bytes.size() & 0xff));
    bytes = with(bytes, 7, static_cast<int>(bytes.size() >> 8));
    CHECK(error_of(bytes) == DecodeError::too_long);
  }
}

TEST_CASE("Magic, version, kind and session are checked") {
  const std::vector<std::byte> good = encoded(Bye{1});
  for (std::size_t i = 0; i < 4; ++i) CHECK(error_of(with(good, i, 0xff)) == DecodeError::bad_magic);
  CHECK(error_of(with(good, 4, 0)) == DecodeError::bad_version);
  CHECK(error_of(with(good, 4, 2)) == DecodeError::bad_version);
  CHECK(error_of(with(good, 5, 0)) == DecodeError::bad_kind);
  CHECK(error_of(with(good, 5, 9)) == DecodeError::bad_kind);
  CHECK(error_of(with(good, 5, 255)) == DecodeError::bad_kind);
  CHECK(error_of(with(good, 8, 0)) == DecodeError::bad_session);
}

TEST_CASE("NaN and infinity are refused in every number") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    CHECK(error_of(encoded(Hello{1, bad, 0.5, true, true})) == DecodeError::not_finite);
    CHECK(error_of(encoded(Hello{1, 0.5, bad, true, true})) == DecodeError::not_finite);
    CHECK(error_of(encoded(Welcome{1, bad, 0.5, true})) == DecodeError::not_finite);
    CHECK(error_of(encoded(Command{1, 1, 1, kenaf::support::command_of({0, bad})})) == DecodeError::not_finite);
    CHECK(error_of(encoded(Command{1, 1, 1, kenaf::support::command_of({}, 0, {0, 0, 0, bad})})) ==
          DecodeError::not_finite);
  }
  // A State has 31 numbers in its last 248 bytes; an exponent of all ones makes each of them infinite.
  const std::vector<std::byte> state = encoded(empty_state());
  for (std::size_t i = 0; i < 31; ++i) {
    const std::size_t number = state.size() - 8 * (i + 1);
    CHECK(error_of(with(with(state, number + 7, 0x7f), number + 6, 0xf0)) == DecodeError::not_finite);
  }
}

TEST_CASE("Flags, masks and enumerations out of their range are refused") {
  const std::vector<std::byte> hello = encoded(Hello{1, 0.01, 0.5, true, true});
  CHECK(error_of(with(hello, 32, 2)) == DecodeError::bad_value);
  CHECK(error_of(with(hello, 33, 255)) == DecodeError::bad_value);
  CHECK(error_of(with(encoded(Welcome{1, 0, 0.01, true}), 32, 2)) == DecodeError::bad_value);
  CHECK(error_of(with(encoded(Command{1, 1, 0, kenaf::support::command_of({})}), 40, 0x10)) == DecodeError::bad_value);
  const std::vector<std::byte> state = encoded(empty_state());
  CHECK(error_of(with(state, 28, 0x80)) == DecodeError::bad_value);  // a field bit that does not exist
  CHECK(error_of(with(state, 30, 0x80)) == DecodeError::bad_value);  // one that would be held
  CHECK(error_of(with(state, 33, 0x01)) == DecodeError::bad_value);  // an event bit that does not exist
  const std::vector<std::byte> refused = encoded(Refused{1, RefusedReason::busy, {}, 3});
  CHECK(error_of(with(refused, 16, 0)) == DecodeError::bad_value);
  CHECK(error_of(with(refused, 16, 5)) == DecodeError::bad_value);
  CHECK(error_of(with(refused, 217, 201)) == DecodeError::bad_value);     // longer than its room
  CHECK(error_of(with(refused, 17 + 3, 'x')) == DecodeError::bad_value);  // padding that is not zero
}
