#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "can/canopen/frame.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;

TEST_CASE("A frame has its bytes and zeros behind them") {
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  const Frame frame = make_frame(0x181, bytes);
  CHECK(frame.id == 0x181);
  CHECK(frame.length == 3);
  CHECK(frame.data == std::array<std::uint8_t, 8>{1, 2, 3, 0, 0, 0, 0, 0});
  CHECK(make_frame(0x80, {}).length == 0);
}

TEST_CASE("A frame takes eight bytes and no ninth") {
  CHECK(make_frame(1, std::vector<std::uint8_t>(8)).length == 8);
  CHECK_THROWS_AS(make_frame(1, std::vector<std::uint8_t>(9)), std::length_error);
}

TEST_CASE("Numbers in a frame are little-endian, and negative ones two's complement") {
  // CiA 301, 7.1.4.6: the byte of the lowest weight comes first.
  const std::vector<std::uint8_t> data{0xaa, 0x78, 0x56, 0x34, 0xf2};
  CHECK(get_unsigned(data, 1, 1) == 0x78);
  CHECK(get_unsigned(data, 1, 2) == 0x5678);
  CHECK(get_unsigned(data, 1, 3) == 0x345678);
  CHECK(get_unsigned(data, 1, 4) == 0xf2345678);
  CHECK(get_signed(data, 0, 1) == -86);    // 0xaa - 0x100
  CHECK(get_signed(data, 1, 1) == 0x78);   // bit 7 is clear
  CHECK(get_signed(data, 3, 2) == -3532);  // 0xf234 - 0x10000
  CHECK(get_signed(data, 2, 3) == 0xf23456 - 0x1000000);
  CHECK(get_signed(data, 1, 4) == -231451016);  // 0xf2345678 - 2^32
}

TEST_CASE("Numbers are put where they belong and nowhere else") {
  std::vector<std::uint8_t> data(6, 0x11);
  put(data, 1, 2, 0xabcd);
  CHECK(data == std::vector<std::uint8_t>{0x11, 0xcd, 0xab, 0x11, 0x11, 0x11});
  put(data, 2, 4, static_cast<std::uint32_t>(-2));
  CHECK(data == std::vector<std::uint8_t>{0x11, 0xcd, 0xfe, 0xff, 0xff, 0xff});
  put(data, 0, 1, 0x1234);  // cut off
  CHECK(data[0] == 0x34);
}

TEST_CASE("Bits on the wire with every stuff bit there can be") {
  // Stuffed are SOF 1, identifier 11, RTR 1, IDE 1, r0 1, DLC 4 and CRC 15: 34, and the data. Of g bits the first five
  // alike ask for a stuff bit, and then every four more: (g - 1) / 4. Never stuffed: CRC delimiter 1, acknowledgement
  // slot and delimiter 2, end of frame 7, and the space of 3 after it: 13.
  CHECK(worst_case_bits(frame_of(0x080, {})) == 34 + 8 + 13);                         // 33 / 4 = 8
  CHECK(worst_case_bits(frame_of(0x701, {0x05})) == 42 + 10 + 13);                    // 41 / 4 = 10
  CHECK(worst_case_bits(frame_of(0x181, {0, 0, 0, 0, 0, 0, 0, 0})) == 98 + 24 + 13);  // 97 / 4 = 24
  CHECK(worst_case_bits(frame_of(0x181, {0, 0, 0, 0, 0, 0, 0, 0})) == 135);
  CHECK(worst_case_bits(frame_of(0x080, {})) == 55);
}

TEST_CASE("A number of any bits anywhere in a frame") {
  const Frame f = frame_of(0x188, {0xa5, 0xc3, 0x7e, 0x01, 0, 0, 0, 0x80});
  CHECK(bits_of(f, 0, 8) == -91);   // 0xa5 as a signed byte
  CHECK(bits_of(f, 4, 8) == 0x3a);  // the nibbles a and 3
  CHECK(bits_of(f, 8, 16) == 0x7ec3);
  CHECK(bits_of(f, 32, 32) == INT32_MIN);
  CHECK(bits_of(f, 62, 2) == -2);  // 0b10
  CHECK_FALSE(bits_of(frame_of(0x188, {1, 2}), 8, 9));
}
