// What is written: recorded server lines are reproduced to the byte, numbers as each historic server wrote them.
#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "formats/protocol/usarsim_message.hpp"

using namespace kenaf::protocol::usarsim;

namespace {

constexpr NumberFormat kFourRounded{4, false};
constexpr NumberFormat kTwoRounded{2, false};
constexpr NumberFormat kFourCut{4, true};

std::string written(double value, NumberFormat format) {
  std::string out;
  append_number(out, value, format);
  return out;
}

}  // namespace

TEST_CASE("UT2004 rounds, UDK cuts off") {
  CHECK(written(1.23456, {4, false}) == "1.2346");
  CHECK(written(1.23456, {4, true}) == "1.2345");
  CHECK(written(-1.23456, {4, false}) == "-1.2346");
  CHECK(written(-1.23456, {4, true}) == "-1.2345");
  CHECK(written(1.9999, {2, false}) == "2.00");
  CHECK(written(1.9999, {2, true}) == "1.99");
}

TEST_CASE("Cutting off cuts the decimal number that was meant") {
  CHECK(written(0.29, {2, true}) == "0.29");  // the nearest double lies below 0.29
  CHECK(written(1.3, {4, true}) == "1.3000");
  CHECK(written(7, {3, true}) == "7.000");
}

TEST_CASE("No minus before zero, whichever way it became zero") {
  CHECK(written(-0.0, kTwoRounded) == "0.00");
  CHECK(written(-0.001, kTwoRounded) == "0.00");
  CHECK(written(-0.009, {2, true}) == "0.00");
  CHECK(written(-0.4, {0, false}) == "0");
  CHECK(written(-0.9, {0, true}) == "0");
  CHECK(written(-0.01, kTwoRounded) == "-0.01");
}

TEST_CASE("No exponent, no fraction where none is asked for, 0 for what is no number") {
  CHECK(written(1e20, {1, false}) == "100000000000000000000.0");
  CHECK(written(1e20, {1, true}) == "100000000000000000000.0");
  CHECK(written(1e-7, kFourRounded) == "0.0000");
  CHECK(written(2.5e-308, kFourCut) == "0.0000");
  CHECK(written(1e-7, {9, false}) == "0.000000100");
  CHECK(written(12.7, {0, true}) == "12");
  CHECK(written(12.7, {0, false}) == "13");
  CHECK(written(12.7, {-3, false}) == "13");
  CHECK(written(std::numeric_limits<double>::max(), kFourRounded).size() == 309 + 5);
  CHECK(written(std::numeric_limits<double>::quiet_NaN(), kTwoRounded) == "0.00");
  CHECK(written(-std::numeric_limits<double>::infinity(), kFourCut) == "0.0000");
}

TEST_CASE("17 digits read back as the same double") {
  for (const double value : {0.1, 1.0 / 3, 3.141592653589793, -0.7071067811865476}) {
    CHECK(parse_number(written(value, {17, false})) == value);
  }
}

TEST_CASE("A recorded UT2004 status line") {
  std::string out;
  MessageWriter(out)
      .begin("STA")
      .text("Type", "GroundVehicle")
      .number("Time", 48.2204, kTwoRounded)
      .number("FrontSteer", 0, kFourRounded)
      .number("RearSteer", -0.0, kFourRounded)
      .number("FRFlipper", -0.0006, kFourRounded)
      .boolean("LightToggle", false)
      .integer("LightIntensity", 0)
      .integer("Battery", 1196)
      .integer("View", -1)
      .end();
  CHECK(out ==
        "STA {Type GroundVehicle} {Time 48.22} {FrontSteer 0.0000} {RearSteer 0.0000} {FRFlipper -0.0006} "
        "{LightToggle False} {LightIntensity 0} {Battery 1196} {View -1}\r\n");
}

TEST_CASE("Recorded sensor lines, with vectors and with groups of several pairs") {
  std::string out;
  const std::array<double, 3> location{4.5, 1.9, 1.85};
  const std::array<double, 3> orientation{0, 6.28, 6.28};
  MessageWriter(out)
      .begin("SEN")
      .number("Time", 3104.5749, kFourRounded)
      .text("Type", "GroundTruth")
      .text("Name", "GroundTruth")
      .numbers("Location", location, kTwoRounded)
      .numbers("Orientation", orientation, kTwoRounded)
      .end();
  CHECK(out ==
        "SEN {Time 3104.5749} {Type GroundTruth} {Name GroundTruth} {Location 4.50,1.90,1.85} "
        "{Orientation 0.00,6.28,6.28}\r\n");

  out.clear();
  MessageWriter writer(out);
  writer.begin("SEN").text("Type", "Encoder");
  writer.open_group("Name", "ECLeft").add_integer("Tick", 0).close_group();
  writer.open_group("Name", "ECRight").add_integer("Tick", -7).close_group();
  writer.open_group("Name", "F1").add_number("Range", 4.5523, kFourRounded).close_group();
  writer.open_group("Name", "INS")
      .add_numbers("Location", location, kTwoRounded)
      .add_text("Mount", "HARD")
      .close_group();
  writer.end();
  CHECK(out ==
        "SEN {Type Encoder} {Name ECLeft Tick 0} {Name ECRight Tick -7} {Name F1 Range 4.5523} "
        "{Name INS Location 4.50,1.90,1.85 Mount HARD}\r\n");
}

TEST_CASE("What is written is read back") {
  std::string out;
  MessageWriter(out).begin("RES").text("Status", "Failed").text("Reason", "no such robot").end();
  MessageView view;
  REQUIRE(parse_message(std::string_view(out).substr(0, out.size() - 2), view) == ParseError::none);
  CHECK(view.find("Reason") == "no such robot");
}

TEST_CASE("A text without a character writes no group") {
  std::string out;
  MessageWriter(out).begin("RES").text("Name", "").text("Status", "Failed").text("Reason", "").end();
  CHECK(out == "RES {Status Failed}\r\n");
}

TEST_CASE("Text from elsewhere cannot end its group or its line") {
  std::string out;
  MessageWriter(out).begin("RES").text("Name", "a} {Status OK}\r\nDRIVE {Left 9").end();
  CHECK(out == "RES {Name a_ _Status OK___DRIVE _Left 9}\r\n");
}
