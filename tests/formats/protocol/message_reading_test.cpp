// Lenient reading of what real servers and clients send. Names in brackets say which client or server a line is from.
#include <catch2/catch.hpp>
#include <string>

#include "formats/protocol/usarsim_message.hpp"

using namespace kenaf::protocol::usarsim;

namespace {

MessageView parsed(std::string_view line) {
  MessageView view;
  const ParseError error = parse_message(line, view);
  INFO(line);
  REQUIRE(describe(error) == describe(ParseError::none));
  return view;
}

std::array<double, 3> three_numbers(std::string_view text) {
  std::array<double, 3> out{};
  INFO(text);
  REQUIRE(parse_numbers(text, out));
  return out;
}

using Three = std::array<double, 3>;

}  // namespace

TEST_CASE("Types and keys compare without case, blanks are optional") {
  for (const char* line : {"DRIVE {Left 1.5} {Right -2}", "drive {left 1.5} {right -2}", "Drive{Left 1.5}{RIGHT -2}",
                           "  DRIVE   {  Left   1.5  }   { Right\t-2 }   ", "DRIVE {Right -2} {Left 1.5}"}) {
    const MessageView view = parsed(line);
    CHECK(view.is("DRIVE"));
    CHECK(view.find("Left") == "1.5");
    CHECK(view.find("RIGHT") == "-2");
    CHECK_FALSE(view.find("Lef"));
    CHECK_FALSE(view.is("DRIV"));
  }
  CHECK(parsed("Com1{BasMan Rulez}").find("basman") == "Rulez");
}

TEST_CASE("Requests without a group, empty groups and groups without a value") {
  CHECK(parsed("GETSTARTPOSES").type == "GETSTARTPOSES");
  CHECK(parsed("GETSTARTPOSES").all().empty());
  const MessageView view = parsed("GETCONF {} {Type}");
  REQUIRE(view.all().size() == 2);
  CHECK(view.all()[0].key.empty());
  CHECK(view.all()[1].key == "Type");
  CHECK(view.all()[1].value.empty());
}

TEST_CASE("A byte order mark before the first line and a NUL after a line are blanks") {
  CHECK(parsed("\xEF\xBB\xBFINIT {ClassName USARBot.Kenaf}").is("INIT"));
  CHECK(parsed(std::string_view("\0DRIVE {Left 1}\0", 16)).is("DRIVE"));
}

TEST_CASE("Repeated keys keep their order, find() gives the first") {
  const MessageView view = parsed("MISPKG {Name CameraPanTilt} {Link 1} {Value 0.5} {Order 0} {Link 2} {Value -0.25}");
  REQUIRE(view.all().size() == 6);
  CHECK(view.all()[1].value == "1");
  CHECK(view.all()[4].key == "Link");
  CHECK(view.all()[4].value == "2");
  CHECK(view.all()[5].value == "-0.25");
  CHECK(view.find("Link") == "1");
}

TEST_CASE("MultiDrive with double blanks and a stray Normalized [MRL]") {
  const MessageView view = parsed("MultiDrive {FRFlipper -0.5} {RLFlipper  0.5} {Normalized False}");
  CHECK(view.is("MULTIDRIVE"));
  CHECK(parse_number(*view.find("RLFlipper")) == 0.5);
  CHECK(parse_bool(*view.find("Normalized")) == false);
}

TEST_CASE("Poses in every form that clients send") {
  CHECK(three_numbers("4.5,1.9,1.8") == Three{4.5, 1.9, 1.8});
  CHECK(three_numbers("1.0 2.0 3.0") == Three{1, 2, 3});        // MALDO, US_BOT
  CHECK(three_numbers(".4, .4, 1.8") == Three{0.4, 0.4, 1.8});  // MAK
  CHECK(three_numbers(" 1 , 2\t,3 ") == Three{1, 2, 3});
  CHECK(three_numbers("+1,-2.,3e-1") == Three{1, -2, 0.3});
  CHECK(three_numbers("4,5 1,9 1,8") == Three{4.5, 1.9, 1.8});    // decimal commas: the blanks separate
  CHECK(three_numbers("4,5,1,9,-1,8") == Three{4.5, 1.9, -1.8});  // decimal commas: six whole numbers for three
  CHECK(three_numbers("0,0000,0,0000,0,0000") == Three{0, 0, 0});
}

TEST_CASE("What is not the asked count of numbers is refused") {
  std::array<double, 3> out{};
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,x", "1,,2", ",1,2", "1,2,3,", "1 2", "nan,1,2", "inf 1 2",
                           "1;2;3", "1.5,2.5,3.5,4.5,5.5,6.5", "1,2,3,4,5,-6", "0x10,1,2", "1e999,0,0"}) {
    INFO(text);
    CHECK_FALSE(parse_numbers(text, out));
  }
}

TEST_CASE("A list of any length") {
  std::array<double, 2> out{};
  CHECK(parse_number_list("0.5", out) == 1u);
  CHECK(out[0] == 0.5);
  CHECK(parse_number_list("0.5,1", out) == 2u);  // {Params value,steer}
  CHECK(parse_number_list("1 2 3", out) == 3u);  // counted, the third not stored
  CHECK(out == std::array<double, 2>{1, 2});
  CHECK(parse_number_list("  ", out) == 0u);
  CHECK_FALSE(parse_number_list("1,two", out));
}

TEST_CASE("Single numbers: decimal comma, signs, and what is none") {
  CHECK(parse_number("0,0000") == 0.0);
  CHECK(parse_number("1,00") == 1.0);
  CHECK(parse_number("-1,5") == -1.5);
  CHECK(parse_number(" +.5 ") == 0.5);
  CHECK(parse_number("5.") == 5.0);
  CHECK(parse_number("1e3") == 1000.0);
  for (const char* text :
       {"", " ", "+", "-", ".", "+-1", "--1", "1,2,3", "1.000,5", "1 2", "1m", "nan", "-inf", "1e400", "0x1p3", ","}) {
    INFO(text);
    CHECK_FALSE(parse_number(text));
  }
}

TEST_CASE("Numbers that end like a literal of C# or Java") {
  CHECK(parse_number("1.0f") == 1.0);
  CHECK(parse_number("-2.5F") == -2.5);
  CHECK(parse_number("3d") == 3.0);
  CHECK(parse_number("1e3D") == 1000.0);
  CHECK(three_numbers("1.0f,2.5f,-3f") == Three{1, 2.5, -3});
  for (const char* text : {"f", "1.0ff", "1.0 f", "1.0fd", "0xf", "1.0x"}) {
    INFO(text);
    CHECK_FALSE(parse_number(text));
  }
}

TEST_CASE("Truth in every form") {
  for (const char* text : {"true", "True", "TRUE", "t", "T", "1", "yes", "y", " on "}) CHECK(parse_bool(text) == true);
  for (const char* text : {"false", "False", "f", "0", "no", "n", "off"}) CHECK(parse_bool(text) == false);
  for (const char* text : {"", "maybe", "2", "tru"}) CHECK_FALSE(parse_bool(text));
}

TEST_CASE("Lines of recorded servers") {
  const MessageView ut = parsed(
      "STA {Type GroundVehicle} {Time 48.22} {FrontSteer 0.0000} {RearSteer 0.0000} {FRFlipper -0.0006} "
      "{FLFlipper -0.0005} {RRFlipper 0.0005} {RLFlipper 0.0006} {LightToggle False} {LightIntensity 0} {Battery 1196} "
      "{View -1}");
  CHECK(ut.all().size() == 12);
  CHECK(parse_number(*ut.find("FRFlipper")) == -0.0006);
  CHECK(ut.find("View") == "-1");

  const MessageView truth = parsed(
      "SEN {Time 3104.5749} {Type GroundTruth} {Name GroundTruth} {Location 4.50,1.90,1.85} {Orientation "
      "0.00,6.28,6.28}");
  CHECK(three_numbers(*truth.find("Location")) == Three{4.5, 1.9, 1.85});

  // The UDK server's GEO has two blanks after its type and none between the last two groups.
  const MessageView geo = parsed("GEO  {Name n} {Location 0,0,0} {Orientation 0,0,0}{Mount P3AT}");
  CHECK(geo.find("Mount") == "P3AT");
  CHECK(parsed("SEN {Time 3.2} {Type Camera} ").find("Type") == "Camera");
}

TEST_CASE("UT2004's groups of several pairs are read word by word") {
  const MessageView view = parsed("SEN {Type Encoder} {Name ECLeft Tick 0} {Name ECRight Tick -12}");
  REQUIRE(view.all().size() == 3);
  std::string_view rest = view.all()[2].value;
  CHECK(next_word(rest) == "ECRight");
  CHECK(next_word(rest) == "Tick");
  CHECK(next_word(rest) == "-12");
  CHECK(next_word(rest).empty());
  std::string_view poses = parsed("NFO {StartPoses 1} {PlayerStart_0 4.5,1.9,1.8 0,0,0}").all()[1].value;
  CHECK(three_numbers(next_word(poses)) == Three{4.5, 1.9, 1.8});
}

TEST_CASE("A line without a type has no message") {
  for (const char* line : {"", " \t ", "{Left 1}", "}", "{", "{}{}"}) {
    INFO(line);
    MessageView view = parsed("DRIVE {Left 1}");
    const ParseError error = parse_message(line, view);
    CHECK(is_readable(error) == (view.type == "}"));  // the server knows no such verb
    CHECK(view.all().empty());
    CHECK(describe(error).size() > 5);
  }
}

TEST_CASE("A line with an odd group keeps the others, and the first oddity is told") {
  struct Case {
    const char* line;
    ParseError error;
    const char* left;
    const char* right;
  };
  for (const Case& c : {Case{"DRIVE {Left 1} {Right 2", ParseError::unclosed_group, "1", "2"},
                        Case{"DRIVE {Left 1 {Right 2}", ParseError::unclosed_group, "1", "2"},
                        Case{"DRIVE {Left 1} {Right 2} {", ParseError::unclosed_group, "1", "2"},
                        Case{"DRIVE {{Left 1} {Right 2}", ParseError::unclosed_group, "1", "2"},
                        Case{"DRIVE {Left 1}, {Right 2};", ParseError::text_between, "1", "2"},
                        Case{"DRIVE {Left 1} and {Right 2}", ParseError::text_between, "1", "2"},
                        Case{"DRIVE {Left 1}} {Right 2}", ParseError::text_between, "1", "2"},
                        Case{"DRIVE {Left 1} x {Right 2", ParseError::text_between, "1", "2"},
                        Case{"DRIVE {Left 1 {Right 2}}", ParseError::unclosed_group, "1", "2"}}) {
    MessageView view;
    INFO(c.line);
    CHECK(parse_message(c.line, view) == c.error);
    CHECK(is_readable(c.error));
    CHECK(view.is("DRIVE"));
    CHECK(view.all().size() == 2);
    CHECK(view.find("Left") == c.left);
    CHECK(view.find("Right") == c.right);
    CHECK(describe(c.error).size() > 5);
  }
}

TEST_CASE("A line has as many groups as its 64 KiB hold") {
  for (const std::size_t count : {64u, 65u, 16000u}) {
    std::string line = "X";
    for (std::size_t i = 0; i < count; ++i) line += "{k}";
    line += "{last 1}";
    MessageView view;
    CHECK(parse_message(line, view) == ParseError::none);
    REQUIRE(view.all().size() == count + 1);
    CHECK(view.all().back().key == "last");
    CHECK(view.find("last") == "1");
    CHECK(parse_message("X {k 1}", view) == ParseError::none);
    CHECK(view.all().size() == 1);
  }
}

TEST_CASE("Quotes around a value are not part of it") {
  CHECK(parsed(R"(DRIVE {Normalized "true"})").find("Normalized") == "true");
  CHECK(parsed(R"(INIT {Name ' R 1 '})").find("Name") == "R 1");
  CHECK(parsed(R"(INIT {Name ""R1""})").find("Name") == "R1");
  CHECK(parsed(R"(INIT {Name ""})").find("Name") == "");
  for (const char* kept : {R"(6" gun)", R"("a' )", R"(")"}) {
    INFO(kept);
    std::string trimmed = kept;
    while (trimmed.ends_with(' ')) trimmed.pop_back();
    CHECK(parsed("INIT {Name " + std::string(kept) + "}").find("Name") == trimmed);
  }
}
