#include <catch2/catch.hpp>

#include "can/canopen/emergency.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;

TEST_CASE("An emergency message: code, error register, five bytes of the manufacturer") {
  const Emergency emergency{
      .node = 3, .error_code = 0x2310, .error_register = 0x03, .manufacturer_bytes = {1, 2, 3, 4, 5}};
  const Frame frame = frame_of(0x083, {0x10, 0x23, 0x03, 0x01, 0x02, 0x03, 0x04, 0x05});
  CHECK(encode(emergency) == frame);
  const auto read = emergency_from(frame);
  REQUIRE(read);
  CHECK(read->node == 3);
  CHECK(read->error_code == 0x2310);
  CHECK(read->error_register == 0x03);
  CHECK(read->manufacturer_bytes == std::array<std::uint8_t, 5>{1, 2, 3, 4, 5});
}

TEST_CASE("What is no emergency message is none") {
  CHECK(emergency_from(frame_of(0x0ff, {0, 0, 0, 0, 0, 0, 0, 0})));
  CHECK_FALSE(emergency_from(frame_of(0x080, {0, 0, 0, 0, 0, 0, 0, 0})));  // SYNC's identifier
  CHECK_FALSE(emergency_from(frame_of(0x100, {0, 0, 0, 0, 0, 0, 0, 0})));  // TIME's
  CHECK_FALSE(emergency_from(frame_of(0x083, {0, 0, 0, 0, 0, 0, 0})));
}

TEST_CASE("An emergency message is put in words") {
  CHECK(describe(Emergency{3, 0x2310, 0x03, {1, 0, 0, 0, 0xfe}}) ==
        "0x2310 continuous over current (error register 0x03: generic, current; manufacturer 01 00 00 00 fe)");
  CHECK(describe(Emergency{3, 0x0000, 0x00, {}}) ==
        "0x0000 no error (error register 0x00; manufacturer 00 00 00 00 00)");
  // CiA 301, 7.5.2.2: bit 2 voltage, 3 temperature, 4 communication, 5 device profile, 7 manufacturer
  CHECK(
      describe(Emergency{3, 0x8130, 0xbd, {}}) ==
      "0x8130 life guard error or heartbeat error (error register 0xbd: generic, voltage, temperature, communication, "
      "device profile, manufacturer; manufacturer 00 00 00 00 00)");
}

TEST_CASE("Words of codes that CiA 301 and CiA 402 name") {
  CHECK(error_code_words(0x1000) == "generic error");
  CHECK(error_code_words(0x2320) == "short circuit or earth leakage, motor side");
  CHECK(error_code_words(0x3210) == "DC link over-voltage");
  CHECK(error_code_words(0x3220) == "DC link under-voltage");
  CHECK(error_code_words(0x4310) == "drive temperature too high");
  CHECK(error_code_words(0x5530) == "EEPROM");
  CHECK(error_code_words(0x7121) == "motor blocked");
  CHECK(error_code_words(0x7305) == "incremental sensor 1 fault");
  CHECK(error_code_words(0x8120) == "CAN in error passive mode");
  CHECK(error_code_words(0x8140) == "recovered from bus off");
  CHECK(error_code_words(0x8210) == "PDO not processed due to length error");
  CHECK(error_code_words(0x8240) == "unexpected SYNC data length");
  CHECK(error_code_words(0x8611) == "following error");
}

TEST_CASE("Words of other codes are those of their group or class") {
  CHECK(error_code_words(0x0000) == "no error");
  CHECK(error_code_words(0x00ff) == "no error");                     // 0x00xx
  CHECK(error_code_words(0x231f) == "continuous over current");      // 0x231x
  CHECK(error_code_words(0x23f0) == "current, device output side");  // 0x23xx
  CHECK(error_code_words(0x2f00) == "current");                      // 0x2xxx
  CHECK(error_code_words(0x6305) == "data set");                     // no. 5 of 15
  CHECK(error_code_words(0x1234) == "generic error");
  CHECK(error_code_words(0xff12) == "device specific");
  CHECK(error_code_words(0xf123) == "additional functions");
  CHECK(error_code_words(0x0100) == "unknown error");
  CHECK(error_code_words(0xa000) == "unknown error");
}

TEST_CASE("No code is without words") {
  for (std::uint32_t code = 0; code <= 0xffff; ++code)
    if (error_code_words(static_cast<std::uint16_t>(code)).empty()) FAIL(code);
}
