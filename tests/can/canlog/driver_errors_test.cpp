// Error messages of the CAN driver, by the bits of linux/can/error.h, and the layer setting services of CiA 305.
#include "can/canlog/driver_errors.hpp"

#include <catch2/catch.hpp>

#include "can/canlog/describe.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

TEST_CASE("Error messages are decoded") {
  CHECK(words_of_frame("20000040#0000000000000000") == "CAN controller: bus-off");
  CHECK(words_of_frame("20000100#0000000000000000") == "CAN controller: restarted after bus-off");
  // 0x0c: warnings of both counters, which are in the last two bytes: 0x6a = 106, 0x7f = 127
  CHECK(words_of_frame("20000004#000C000000006A7F") ==
        "CAN controller: error warning, receiving, error warning, sending; error counters 106 sending, 127 receiving");
  CHECK(words_of_frame("20000204#0020000000008000") ==
        "CAN controller: error passive, sending; error counters 128 sending, 0 receiving");
  CHECK(words_of_frame("20000002#0B00000000000000") == "CAN controller: arbitration lost at bit 11");
  // class 0x88: protocol and bus error; 0x04 a stuff error, 0x80 while sending; place 0x08, the CRC
  CHECK(words_of_frame("20000088#0000840800000000") ==
        "CAN controller: protocol error (stuff, while sending) in the CRC; bus error");
  CHECK(words_of_frame("20000020#0000000000000000") == "CAN controller: no acknowledgement");
  CHECK(words_of_frame("20000001#0000000000000000") == "CAN controller: sending timed out");
}

TEST_CASE("Bus-off is a finding, other messages of the driver are none") {
  CHECK(broken({{0, "20000004#000C000000006A7F"}, {1, "20000040#0000000000000000"}}) == Broken{"2: bus-off"});
}

TEST_CASE("Layer setting services are named, and are no findings") {
  CHECK(words_of_frame("7E5#0401000000000000") == "LSS switch state global: configuration");
  CHECK(words_of_frame("7E5#1105000000000000") == "LSS configure node id: 5");
  CHECK(words_of_frame("7E4#1100000000000000") == "LSS answer: configure node id: 0");
  CHECK(words_of_frame("7E5#1300020000000000") == "LSS configure bit timing: table 0, entry 2");
  CHECK(words_of_frame("7E5#15E8030000000000") == "LSS activate bit timing, after: 1000 ms");
  CHECK(words_of_frame("7E5#4078563412000000") == "LSS switch state selective, vendor: 0x12345678");
  CHECK(words_of_frame("7E4#5E05000000000000") == "LSS answer: inquire node id: 5");
  CHECK(words_of_frame("7E4#4F00000000000000") == "LSS answer: identify slave");
  CHECK(words_of_frame("7E5#FF00000000000000") == "LSS 0xff, which CiA 305 does not define");
  CHECK(words_of_frame("7E5#04") == "LSS malformed: 1 bytes 04");
  CHECK(broken({{0, "7E5#0401000000000000"}, {1, "7E4#0400000000000000"}}).empty());
  CHECK(broken({{0, "7E5#04"}}) == Broken{"1: length"});
}
