// Frames in words, each worked out by hand from the standards' tables.
#include "can/canlog/describe.hpp"

#include <catch2/catch.hpp>

#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

TEST_CASE("NMT, SYNC, heartbeats and emergencies are put in words") {
  CHECK(words_of_frame("000#0103") == "NMT start: flipper front left");
  CHECK(words_of_frame("000#8200") == "NMT reset communication: all nodes");
  CHECK(words_of_frame("000#0109") == "NMT start: node 9");
  CHECK(words_of_frame("080#") == "SYNC");
  CHECK(words_of_frame("080#07") == "SYNC 7");
  CHECK(words_of_frame("703#05") == "flipper front left: heartbeat, operational");
  CHECK(words_of_frame("703#00") == "flipper front left: boot-up");
  CHECK(words_of_frame("77F#05") == "master: heartbeat, operational");
  CHECK(words_of_frame("082#1023030000000000") ==
        "track right: EMCY 0x2310 continuous over current (error register 0x03: generic, current; manufacturer 00 00 "
        "00 00 00)");
}

TEST_CASE("SDO frames are put in words") {
  CHECK(words_of_frame("601#4041600000000000") == "SDO read 0x6041:00 (statusword) from track left");
  // command specifier 2 (upload answer), expedited, two of four bytes without data: 010 0 10 1 1
  CHECK(words_of_frame("581#4B41600037060000") == "SDO answer of track left: 0x6041:00 (statusword) = 0x0637");
  CHECK(words_of_frame("602#2F60600003000000") == "SDO write 0x6060:00 (mode of operation) of track right = 0x03");
  CHECK(words_of_frame("582#6060600000000000") == "SDO answer of track right: 0x6060:00 (mode of operation) written");
  CHECK(words_of_frame("582#8060600000000906") ==
        "SDO answer of track right: it aborts 0x6060:00 (mode of operation): 0x06090000 unknown abort code");
  CHECK(words_of_frame("587#8018100511000906") ==
        "SDO answer of inclinometer: it aborts 0x1018:05 (identity, 5): 0x06090011 sub-index does not exist");
  CHECK(words_of_frame("581#4108100006000000") ==
        "SDO answer of track left: 0x1008:00 (device name) = 6 bytes in segments");
  CHECK(words_of_frame("601#6000000000000000") == "SDO next segment from track left");
  // no more segments, one of seven bytes without data
  CHECK(words_of_frame("581#0344726976657200") == "SDO segment of track left: \"Driver\", the last");
  CHECK(words_of_frame("601#2300180181010080") == "SDO write 0x1800:01 (TPDO1 identifier) of track left = 0x80000181");
  CHECK(words_of_frame("601#23001A0110004160") ==
        "SDO write 0x1a00:01 (TPDO1 mapping, entry 1) of track left = 0x60410010");
}

TEST_CASE("Process data are put in words, in the robot's units") {
  // statusword 0x0637: operation enabled, bit 10 target reached; position 1234: 0.1234 m
  CHECK(words_of_frame("181#3706D2040000") ==
        "track left: operation enabled, target reached, position 1234 counts (0.1234 m)");
  // the right track's direction is -1
  CHECK(words_of_frame("182#3702D2040000") == "track right: operation enabled, position 1234 counts (-0.1234 m)");
  // 1745 counts: 0.1745 rad, 10.00 degrees
  CHECK(words_of_frame("183#3702D1060000") ==
        "flipper front left: operation enabled, position 1745 counts (10.00 deg)");
  CHECK(words_of_frame("201#0F00D0070000") == "command track left: enable, 0.2 m/s");
  CHECK(words_of_frame("202#020000000000") == "command track right: quick stop, 0 m/s");
  CHECK(words_of_frame("203#3F00D1060000") ==
        "command flipper front left: enable, new set-point, to 1745 counts (10.00 deg)");
  CHECK(words_of_frame("281#D0070000F4FF") == "track left: speed 0.2 m/s, current -1.2 % of rated");
  CHECK(words_of_frame("381#2C650000") == "track left: supply 25.9 V");
  CHECK(words_of_frame("187#0A00F6FF") == "inclinometer: slope longitudinal 10, lateral -10");
  CHECK(words_of_frame("188#0000F401") == "gyro: yaw rate 500 units (0.5000 rad/s)");
}

TEST_CASE("What is not what it should be is said to be so") {
  CHECK(words_of_frame("181#370600") == "track left, malformed: 3 bytes 37 06 00");
  CHECK(words_of_frame("401#0102") == "command track left: RPDO3, not one of this robot's: 01 02");
  CHECK(words_of_frame("780#00") == "identifier 0x780, which CANopen does not assign: 00");
  CHECK(words_of_frame("000#01") == "NMT, malformed: 1 bytes 01");
  CHECK(words_of_frame("12345678#00") == "a frame with an identifier of 29 bits");
  CHECK(words_of_frame("20000004#000C000000000000") ==
        "CAN controller: error warning, receiving, error warning, sending");
}
