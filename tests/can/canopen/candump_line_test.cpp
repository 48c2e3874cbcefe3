// Lines of `candump -L`: those of can-utils' own documentation (lib.h), and what is none.
#include "can/canopen/candump_line.hpp"

#include <catch2/catch.hpp>

#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;
using namespace std::chrono_literals;

namespace {

CandumpLine parse(const std::string& frame) {
  return parse_candump_line("(1436509052.249713) vcan0 " + frame);
}

}  // namespace

TEST_CASE("A line of candump is a time, an interface and a frame") {
  const CandumpLine line = parse_candump_line("(1436509052.249713) vcan0 1A5#2C01");
  CHECK(line.at == 1436509052s + 249713us);
  CHECK(line.interface == "vcan0");
  CHECK(line.kind == CandumpKind::data);
  CHECK(line.frame == frame_of(0x1a5, {0x2c, 0x01}));
}

TEST_CASE("A data frame is written as candump writes it") {
  const std::string text = "(1436509052.249713) vcan0 1A5#2C01";
  const CandumpLine line = parse_candump_line(text);
  CHECK(candump_line(line.at, line.interface, line.frame) == text);
  CHECK(candump_line(1500ns, "can0", frame_of(0x80, {})) == "(0000000000.000001) can0 080#");
}

TEST_CASE("The other kinds of frame are distinguished") {
  CHECK(parse("123#").kind == CandumpKind::data);
  CHECK(parse("12345678#").kind == CandumpKind::extended);
  CHECK(parse("00000123#00").kind == CandumpKind::extended);
  CHECK(parse("123#R").kind == CandumpKind::remote);
  CHECK(parse("7A1#r").kind == CandumpKind::remote);
  CHECK(parse("12345678#R5").kind == CandumpKind::remote);
  CHECK(parse("123##0112233").kind == CandumpKind::fd);
  CHECK(parse("12345678##3").kind == CandumpKind::fd);
  CHECK(parse("123##1" + std::string(128, '0')).kind == CandumpKind::fd);
  CHECK(parse("20000004#000C000000000000").kind == CandumpKind::error);
  CHECK(parse("12345678#11").frame == Frame{});
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
}
