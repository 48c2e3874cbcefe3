// Answers as parsers of clients need them. Their rules: a group is a key, a blank and a value; a RES has Time, Type,
// Name and Status alone, each of one word.
#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

Conversation with_robot(const std::string& class_name, bool udk = false) {
  Conversation talk(fast(udk));
  talk.send("INIT {ClassName USARBot." + class_name + "} {Name R1} {Location 0,0,0}\r\n");
  REQUIRE(talk.session->robot);
  return talk;
}

// The texts between the braces, as by a parser that splits there and knows nothing else.
std::vector<std::string> groups_of(std::string_view line) {
  std::vector<std::string> groups;
  for (std::size_t open = line.find('{'); open != std::string_view::npos; open = line.find('{', open + 1)) {
    groups.emplace_back(line.substr(open + 1, line.find('}', open) - open - 1));
  }
  return groups;
}

void check_pairs(const std::string& line) {
  INFO(line);
  for (const std::string& group : groups_of(line)) {
    INFO(group);
    const std::size_t blank = group.find(' ');
    REQUIRE(blank != std::string::npos);
    CHECK(blank > 0);
    CHECK(blank + 1 < group.size());
  }
}

// None of these can be done by a P3AT, or by anything.
constexpr std::array kFailing = {"SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params 1}",
                                 "SET {Type Joint} {Opcode Angle} {Params 1}",
                                 "SET {Type Odometry} {Opcode DANCE}",
                                 "SET {Type Wings} {Name Left} {Opcode RESET}",
                                 "SET {Type} {Name}",
                                 "SET",
                                 "SET {Type Viewports} {Config SingleView} {Viewport1 Camera}",
                                 "CONTROL {Type Kill} {Name Nobody}",
                                 "CONTROL {Type Conveyor} {Name A}",
                                 "CONTROL {Type Create}",
                                 "CONTROL {Type Explode}",
                                 "CONTROL"};

}  // namespace

TEST_CASE("A failed RES has no group without a value, and none that USARSim did not have") {
  Conversation talk = with_robot("P3AT");
  for (const char* request : kFailing) {
    const std::string answer = talk.answer_to(std::string(request) + "\r\n");
    INFO(answer);
    CHECK(answer.starts_with("RES {Time 0.0000} "));
    CHECK(answer.ends_with(" {Status Failed}"));
    check_pairs(answer);
    for (const std::string& group : groups_of(answer)) {
      CHECK(std::ranges::count(group, ' ') == 1);
      const std::string key = group.substr(0, group.find(' '));
      CHECK((key == "Time" || key == "Type" || key == "Name" || key == "Status"));
    }
  }
}

TEST_CASE("A SET without a name is answered without one") {
  Conversation talk = with_robot("P3AT");
  CHECK(talk.answer_to("SET {Type Odometry} {Opcode RESET}\r\n") == "RES {Time 0.0000} {Type Odometry} {Status OK}");
  CHECK(talk.answer_to("SET {Type Wings}\r\n") == "RES {Time 0.0000} {Type Wings} {Status Failed}");
}

TEST_CASE("The reason that a plain client does not get is in the log") {
  Conversation talk = with_robot("P3AT");
  const WholeLog log;
  talk.send("SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params 1}\r\n");
  CHECK(log.has("this robot has no joints: \"Joint FRFlipper\""));
}

TEST_CASE("A client with a Session, and one that asks for an impossible one, get the reason") {
  Conversation talk = with_robot("P3AT");
  CHECK(talk.answer_to("CONTROL {Type Session} {Period 0}\r\n") ==
        "RES {Time 0.0000} {Type Control} {Name Session} {Status Failed} {Reason Period is not from 0.000001 to 10 s}");
  CHECK_FALSE(talk.session->extended);
  talk.send("CONTROL {Type Session}\r\n");
  CHECK(talk.answer_to("SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params 1}\r\n") ==
        "RES {Time 0.0000} {Type Joint} {Name FRFlipper} {Status Failed} {Reason this robot has no joints}");
}

TEST_CASE("No line to a plain client has a group without a value") {
  const bool udk = GENERATE(false, true);
  for (const char* class_name : {"P3AT", "Kenaf", "P2DX", "BasicSkidRobot"}) {
    Conversation talk = with_robot(class_name, udk);
    talk.send("GETSTARTPOSES\r\nPING\r\nCONTROL {Type GetSTA} {Name R1}\r\nCONTROL {Type GetSTA}\r\n");
    for (const std::string type :
         {"", "{Type Robot}", "{Type Sonar}", "{Type RangeScanner}", "{Type Encoder}", "{Type INS}", "{Type MisPkg}",
          "{Type Actuator}", "{Type Camera}", "{Type Joint}", "{Type Wings}", "{Type}", "{Type Wings} {Name}"}) {
      talk.send("GETGEO " + type + "\r\nGETCONF " + type + "\r\n");
    }
    for (const char* request : kFailing) talk.send(std::string(request) + "\r\n");
    REQUIRE(talk.run(1));
    const std::vector<std::string> lines = talk.lines();
    CHECK(lines.size() > 30);
    for (const std::string& line : lines) {
      check_pairs(line);
      for (const char* key : {"{Reason", "{Warning", "{Fault", "{Frame", "{Steps", "{Paused", "{Late", "{Silent"}) {
        CHECK(line.find(key) == std::string::npos);
      }
    }
  }
  Conversation nobody(fast(udk));
  CHECK(nobody.answer_to("GETGEO\r\n") == "GEO");
}

// UT2004's KRobot.uc: MisPkg, ParentLink, -1 is the vehicle, each link in its parent. A link turns about its z axis.
// In x forward, y right, z down the Kenaf's mount is at (0.2, 0, -0.09), and tilting up is a turn about y, to which a
// roll of -pi/2 brings z.
TEST_CASE("A mission package tells where its links are") {
  const bool udk = GENERATE(false, true);
  Conversation talk = with_robot("Kenaf", udk);
  const std::string roll = udk ? "-1.5707" : "-1.5708";
  CHECK(talk.answer_to("GETGEO {Type MisPkg} {Name CameraPanTilt}\r\n") ==
        "GEO {Type MisPkg} {Name CameraPanTilt} {Link 1} {ParentLink -1} {Location 0.2000,0.0000,-0.0900} {Orientation "
        "0.0000,0.0000,0.0000} {Link 2} {ParentLink 1} {Location 0.0000,0.0000,0.0000} {Orientation " +
            roll + ",0.0000,0.0000} {Tip 0.0000,0.0000,0.0000}");
  CHECK(talk.answer_to("GETCONF {Type MisPkg}\r\n").find("{MinRange ") != std::string::npos);
}

// UDK's Actuator.uc: the actuator has a mount, Parent 0 is its base.
TEST_CASE("An actuator tells its mount and its links") {
  const bool udk = GENERATE(false, true);
  Conversation talk = with_robot("Kenaf", udk);
  const std::string roll = udk ? "-1.5707" : "-1.5708";
  CHECK(talk.answer_to("GETGEO {Type Actuator}\r\n") ==
        "GEO {Type Actuator} {Name CameraPanTilt} {Location 0.2000,0.0000,-0.0900} {Orientation 0.0000,0.0000,0.0000} "
        "{Mount Kenaf} {Link 1} {Parent 0} {Location 0.0000,0.0000,0.0000} {Orientation 0.0000,0.0000,0.0000} {Link 2} "
        "{Parent 1} {Location 0.0000,0.0000,0.0000} {Orientation " +
            roll + ",0.0000,0.0000} {Tip 0.0000,0.0000,0.0000}");
  CHECK(talk.answer_to("GETCONF {Type Actuator}\r\n").find("{MinValue ") != std::string::npos);
}

}  // namespace kenaf::world_server
