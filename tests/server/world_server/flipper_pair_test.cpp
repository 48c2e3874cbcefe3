// A robot with its front pair of flippers alone: what STA, GETGEO and GETCONF tell of it, and which joints take
// commands.
#include "formats/description/description_file.hpp"
#include "server/world_server/manual_drive.hpp"
#include "server/world_server/world_state.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

struct FrontPair {
  test::TemporaryFolder folder;
  ServerOptions options = fast();

  FrontPair() {
    std::string text = description::read_description_file("robot", "kenaf", ".toml").text;
    const std::string table = "\n[flipper]\n";
    text.replace(text.find(table), table.size(), table + "pairs = \"front\"\n");
    test::write_file(folder / "front.toml", text);
    options.robot = (folder / "front.toml").string();
  }
};

constexpr const char* kPairPlace = "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n";

bool has(const std::string& text, std::string_view words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("STA, GETGEO and GETCONF name the joints that the robot has") {
  const FrontPair front;
  Conversation talk(front.options);
  talk.send(kPairPlace);
  REQUIRE(talk.run(0.5));
  const std::string status = talk.last("STA");
  CHECK(has(status, "{FRFlipper"));
  CHECK(has(status, "{FLFlipper"));
  CHECK_FALSE(has(status, "{RRFlipper"));
  CHECK_FALSE(has(status, "{RLFlipper"));
  for (const char* ask : {"GETGEO {Type Joint}\r\n", "GETCONF {Type Joint}\r\n"}) {
    const std::string answer = talk.answer_to(ask);
    CHECK(has(answer, "{Name FLFlipper}"));
    CHECK_FALSE(has(answer, "RLFlipper"));
  }
}

TEST_CASE("Joints that the robot has not are no joints: SET fails, DRIVE and MULTIDRIVE leave them") {
  const FrontPair front;
  Conversation talk(front.options);
  talk.send(std::string(kPairPlace) + "CONTROL {Type Session}\r\n");
  const robot::JointCommand rear = talk.command().flipper[robot::kRearLeft];
  CHECK(has(talk.answer_to("SET {Type Joint} {Name RLFlipper} {Opcode Angle} {Params 0.3}\r\n"),
            "no joint of that name"));
  CHECK(has(talk.answer_to("SET {Type Joint} {Name FLFlipper} {Opcode Angle} {Params -0.3}\r\n"), "{Status OK}"));
  CHECK(talk.command().flipper[robot::kFrontLeft].value == 0.3);
  talk.send("SET {Type Joint} {Name AllJoints} {Opcode Angle} {Params -0.4,-0.5,0.1,0.2}\r\n");
  CHECK(talk.command().flipper[robot::kFrontRight].value == 0.4);
  CHECK(talk.command().flipper[robot::kFrontLeft].value == 0.5);
  talk.send("MULTIDRIVE {FRFlipper -0.6} {RLFlipper 0.7}\r\n");
  CHECK(talk.command().flipper[robot::kFrontRight].value == 0.6);
  talk.send("DRIVE {Name RLFlipper} {Order 0} {Value 0.8}\r\n");
  CHECK(talk.command().flipper[robot::kRearLeft] == rear);
}

TEST_CASE("By hand, too, only the flippers that are there take an order, and the view is told which they are") {
  const FrontPair front;
  Conversation talk(front.options);
  std::uint32_t id = 0;
  REQUIRE(place_robot_by_hand(talk.simulation, OperatorId{7}, id).empty());
  robot::Command command;
  command.flipper.fill({robot::JointMode::angle, 0.5});
  REQUIRE(drive_by_hand(talk.simulation, id, OperatorId{7}, command).empty());
  WorldState state;
  read_state(talk.simulation, state);
  REQUIRE(state.robots.size() == 1);
  CHECK(state.robots[0].command.flipper[robot::kFrontLeft].mode == robot::JointMode::angle);
  CHECK(state.robots[0].command.flipper[robot::kRearLeft].mode == robot::JointMode::brake);
  CHECK(state.robots[0].flipper_rad[robot::kFrontRight] == Approx(1).margin(0.01));
  CHECK(std::isnan(state.robots[0].flipper_rad[robot::kRearRight]));
  CHECK(state.robots[0].dimensions.has_flipper == std::array{true, true, false, false});
}

}  // namespace kenaf::world_server
