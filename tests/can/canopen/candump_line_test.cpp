// Lines of `candump -L`: those of can-utils' own documentation (lib.h), and what is none.
#include "can/canopen/candump_line.hpp"

#include <catch2/catch.hpp>

#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;
using namespace std::chrono_literals;

namespace {

RecordedFrame parse(const std::string& frame) {
  return parse_candump_line("(1436509052.249713) vcan0 " + frame);
}

}  // namespace

TEST_CASE("A line of candump is a time, an interface and a frame") {
  const RecordedFrame line = parse_candump_line("(1436509052.249713) vcan0 1A5#2C01");
  CHECK(line.at == 1436509052s + 249713us);
  CHECK(line.interface == "vcan0");
  CHECK(line.kind == FrameKind::data);
  CHECK(line.frame == frame_of(0x1a5, {0x2c, 0x01}));
}

TEST_CASE("A data frame is written as candump writes it") {
  const std::string text = "(1436509052.249713) vcan0 1A5#2C01";
  const RecordedFrame line = parse_candump_line(text);
  CHECK(candump_line(line.at, line.interface, line.frame) == text);
  CHECK(candump_line(1500ns, "can0", frame_of(0x80, {})) == "(0000000000.000001) can0 080#");
}

TEST_CASE("The other kinds of frame are distinguished") {
  CHECK(parse("123#").kind == FrameKind::data);
  CHECK(parse("12345678#").kind == FrameKind::extended);
  CHECK(parse("00000123#00").kind == FrameKind::extended);
  CHECK(parse("123#R").kind == FrameKind::remote);
  CHECK(parse("7A1#r").kind == FrameKind::remote);
  CHECK(parse("12345678#R5").kind == FrameKind::extended);
  CHECK(parse("123##0112233").kind == FrameKind::fd);
  CHECK(parse("12345678##3").kind == FrameKind::fd);
  CHECK(parse("123##1" + std::string(128, '0')).kind == FrameKind::fd);
  CHECK(parse("20000004#000C000000000000").kind == FrameKind::error);
  CHECK(parse("12345678#11").frame == Frame{});
  // a remote frame asks for bytes and has none; an error message has a class and bytes
  CHECK(parse("701#R1").frame == Frame{.id = 0x701, .length = 1});
  CHECK(parse("20000040#0000000000000102").error_class == 0x40);
  CHECK(parse("20000040#0000000000000102").frame == frame_of(0, {0, 0, 0, 0, 0, 0, 1, 2}));
}

TEST_CASE("Separators, small letters, raw length codes and directions may stand in a line") {
  CHECK(parse("123#11.22.33.44.55.66.77.88").frame.length == 8);
  CHECK(parse("123#11.2233.44556677.88").frame.data[7] == 0x88);
  CHECK(parse("1a5#2c").frame == frame_of(0x1a5, {0x2c}));
  CHECK(parse("123#1122334455667788_E").frame.length == 8);
  CHECK(parse("123#11 T").frame.length == 1);
  CHECK(parse("123#11 R\r").frame.length == 1);
  CHECK(parse_candump_line("  (5.5) can0 123#  ").at == 5500ms);
}

TEST_CASE("A line of candump without -L is the same frame") {
  const auto screen = [](const std::string& line) { return parse_candump_line(line); };
  const RecordedFrame heartbeat = screen(" (001.999987)  can0  719   [1]  7F                        '.'");
  CHECK(heartbeat.at == 1999987us);
  CHECK(heartbeat.interface == "can0");
  CHECK(heartbeat.frame == frame_of(0x719, {0x7f}));
  CHECK(heartbeat.stamp == Stamp::short_seconds);
  CHECK(screen("  can0  123   [0]").frame == frame_of(0x123, {}));
  CHECK(screen("  can0  123   [0]").stamp == Stamp::none);
  CHECK(screen("  can0  12345678   [2]  11 22").kind == FrameKind::extended);
  CHECK(screen("  can0  701   [1]  remote request").kind == FrameKind::remote);
  CHECK(screen("  can0  701   [1]  remote request").frame == Frame{.id = 0x701, .length = 1});
  CHECK(screen("  can0  20000040   [8]  00 00 00 00 00 00 00 00   ERRORFRAME").error_class == 0x40);
  CHECK(screen("  can0  RX - -  123   [2]  11 22").frame == frame_of(0x123, {0x11, 0x22}));
  CHECK(screen("  can0  TX B -  123  [12]  11 22 33 44 55 66 77 88 99 AA BB CC").kind == FrameKind::fd);
  CHECK(screen("  can0  123   [2]  00010001 11111110").frame == frame_of(0x123, {0x11, 0xfe}));
  CHECK(screen("  can0  123   {E}  11 22 33 44 55 66 77 88").frame.length == 8);
  CHECK(screen("\x1b[1m  can0  123   [1]  11\x1b[0m").frame == frame_of(0x123, {0x11}));
}

TEST_CASE("Times are of the calendar, since 1970, or of three digits") {
  const auto stamp = [](const std::string& time) { return parse_candump_line(time + " can0 080#"); };
  // 2020-12-04 is day 18600 since 1970: 50 years with 13 leap days (1972 to 2020) are 18263 days less Feb 29 of 2020,
  // then 335 days to December 1 in a leap year, and 3
  const RecordedFrame calendar = stamp("(2020-12-04 23:30:36.123456)");
  CHECK(calendar.at == 24h * 18600 + 23h + 30min + 36s + 123456us);
  CHECK(calendar.stamp == Stamp::time);
  CHECK(stamp("(1436509052.249713)").stamp == Stamp::time);
  CHECK(stamp("(0000000012.249713)").stamp == Stamp::time);
  CHECK(stamp("(0.249713)").stamp == Stamp::time);
  CHECK(stamp("(000.249713)").stamp == Stamp::short_seconds);
  CHECK(stamp("(1000.249713)").stamp == Stamp::short_seconds);
}

TEST_CASE("What is no line is refused in words that quote it") {
  const auto refuses = [](const std::string& line, const std::string& part) {
    CHECK_THROWS_WITH(parse_candump_line(line), Catch::Contains(part));
  };
  refuses("", "not a time");
  refuses("1436509052.249713 vcan0 123#", "not a time");
  refuses("(12) vcan0 123#", "not a time");
  refuses("(-1.5) vcan0 123#", "not a time");
  refuses("(99999999999.5) vcan0 123#", "not a time");
  refuses("(9999999999.5) vcan0 123#", "not a time");  // 64 bits of nanoseconds end in 2262
  refuses("(1.5)", "not the name of an interface");
  refuses("(1.5) vcan0", "not a frame");
  refuses("(1.5) vcan0 123", "not a frame");
  refuses("(1.5) vcan0 12#00", "\"12\" is not an identifier");
  refuses("(1.5) vcan0 800#00", "\"800\" is not an identifier");
  refuses("(1.5) vcan0 45678901#00", "not an identifier");
  refuses("(1.5) vcan0 123#1", "\"1\" is not frame data");
  refuses("(1.5) vcan0 123#11.", "not frame data");
  refuses("(1.5) vcan0 123#112233445566778899", "not frame data");
  refuses("(1.5) vcan0 123#R9", "not frame data");
  refuses("(1.5) vcan0 123##", "not frame data");
  refuses("(1.5) vcan0 123##1" + std::string(130, '0'), "not frame data");
  refuses("(1.5) vcan0 123#11_E", "not frame data");
  refuses("(1.5) vcan0 20000004#R", "not frame data");
  refuses("(1.5) vcan0 123#11 X", "follows the frame");
  refuses("(2020-13-04 23:30:36.123456) can0 080#", "not a time");
  refuses("(2020-12-04 24:30:36.123456) can0 080#", "not a time");
  refuses("(1.5 can0 080#", "not a time");
  refuses("can0  1234   [1]  11", "not an identifier");
  refuses("can0  123   [2]  11", "not byte 2 of 2");
  refuses("can0  123   [2]  11`22", "record without -S");
  refuses("can0  123   [2]  11 22 33", "follows the frame");
}
