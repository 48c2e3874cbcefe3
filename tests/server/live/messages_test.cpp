// Messages of both directions, and the scene's bytes, as docs/live-view.md has them.
#include "server/live/messages.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "server/live/request.hpp"
#include "server/live/scene_bytes.hpp"
#include "server/world_server/manual_drive.hpp"
#include "tests/relayd/allocations.hpp"

namespace kenaf::live {

namespace {

using nlohmann::json;

world_server::Simulation make_simulation(const std::string& world = "flat") {
  world_server::ServerOptions options;
  options.world = world;
  options.speed = 0;
  return world_server::Simulation(options);
}

template <typename Kind>
Kind request(std::string_view text) {
  const auto parsed = parse_request(text);
  REQUIRE(std::holds_alternative<Request>(parsed));
  REQUIRE(std::holds_alternative<Kind>(std::get<Request>(parsed)));
  return std::get<Kind>(std::get<Request>(parsed));
}

}  // namespace

TEST_CASE("A drive is complete: what it does not name stands") {
  auto drive = request<DriveRequest>(R"({"type":"drive","robot":3,"left":0.2,"right":-0.1})");
  CHECK(drive.robot == 3);
  CHECK(drive.command.track_speed_mps == std::array{0.2, -0.1});
  for (const robot::JointCommand& joint : drive.command.flipper) CHECK(joint.mode == robot::JointMode::brake);
  drive = request<DriveRequest>(
      R"({"type":"drive","robot":3,"left":0,"right":0,"flipper_angle":[1,null,null,-1],"flipper_speed":[null,0.5,null,null]})");
  CHECK(drive.command.flipper[0].mode == robot::JointMode::angle);
  CHECK(drive.command.flipper[0].value == 1);
  CHECK(drive.command.flipper[1].mode == robot::JointMode::speed);
  CHECK(drive.command.flipper[1].value == 0.5);
  CHECK(drive.command.flipper[2].mode == robot::JointMode::brake);
  CHECK(drive.command.flipper[3].value == -1);
}

TEST_CASE("The other requests are read") {
  CHECK(request<PauseRequest>(R"({"type":"pause","on":true})").on);
  CHECK(request<StepRequest>(R"({"type":"step","time":0.1})").time_s == 0.1);
  CHECK(request<SpeedRequest>(R"({"type":"speed","value":0})").value == 0);
  const auto look = request<LookRequest>(R"({"type":"look","robot":2,"camera":"Camera","pan":-1,"fov":0.5})");
  CHECK(look.robot == 2);
  CHECK(look.camera == "Camera");
  CHECK(look.order.pan_rad == -1);
  CHECK_FALSE(look.order.tilt_rad);
  CHECK(look.order.field_of_view_rad == 0.5);
  request<ResetRequest>(R"({"type":"reset"})");
  CHECK_FALSE(request<PlaceRequest>(R"({"type":"place","more":1})").where);
  const auto where = request<PlaceRequest>(R"({"type":"place","p":[1,-2.5,0.2],"yaw":0.5})").where;
  REQUIRE(where);
  CHECK(where->p_W == Eigen::Vector3d(1, -2.5, 0.2));
  CHECK(where->yaw_rad == 0.5);
  CHECK(request<PlaceRequest>(R"({"type":"place","p":[1,2,3]})").where->yaw_rad == 0);
  CHECK(request<ShowRequest>(R"({"type":"show"})") == ShowRequest{});
  CHECK(request<ShowRequest>(R"({"type":"show","contacts":true,"sensors":3})") == ShowRequest{true, 3});
  CHECK(request<TakeRequest>(R"({"type":"take","robot":4294967295})").robot == 4294967295);
  CHECK(request<LetGoRequest>(R"({"type":"let-go","robot":1})").robot == 1);
  CHECK(request<RemoveRequest>(R"({"type":"remove","robot":1})").robot == 1);
  CHECK(request<PingRequest>(R"({"type":"ping","t":12.5})").t == 12.5);
}

TEST_CASE("What is no request is refused in words") {
  for (const char* wrong : {"",
                            "x",
                            "[]",
                            "1",
                            "null",
                            "{",
                            "{}",
                            R"({"type":1})",
                            R"({"type":"fly"})",
                            R"({"type":"pause"})",
                            R"({"type":"pause","on":1})",
                            R"({"type":"step","time":0})",
                            R"({"type":"step","time":1e9})",
                            R"({"type":"speed","value":-1})",
                            R"({"type":"speed","value":1e-9})",
                            R"({"type":"place","p":[1,2]})",
                            R"({"type":"place","p":[1,2,null]})",
                            R"({"type":"place","p":[1,2,1e5]})",
                            R"({"type":"place","p":[1,2,1e999]})",
                            R"({"type":"place","p":[1,2,3],"yaw":"north"})",
                            R"({"type":"show","contacts":1})",
                            R"({"type":"show","sensors":-1})",
                            R"({"type":"look","robot":1})",
                            R"({"type":"look","robot":1,"camera":"Camera","pan":1e999})",
                            R"({"type":"look","robot":1,"camera":"Camera","tilt":"up"})",
                            R"({"type":"take","robot":0})",
                            R"({"type":"take","robot":-1})",
                            R"({"type":"take","robot":4294967296})",
                            R"({"type":"take","robot":"1"})",
                            R"({"type":"drive","robot":1,"left":1e999,"right":0})",
                            R"({"type":"drive","robot":1,"left":1})",
                            R"({"type":"drive","robot":1,"left":0,"right":0,"flipper_angle":[1]})",
                            R"({"type":"drive","robot":1,"left":0,"right":0,"flipper_speed":[1,2,3,"4"]})",
                            R"({"type":"drive","robot":1,"left":0,"right":0,"flipper_speed":[1,2,3,1e999]})"}) {
    INFO(wrong);
    const auto parsed = parse_request(wrong);
    REQUIRE(std::holds_alternative<std::string>(parsed));
    CHECK_FALSE(std::get<std::string>(parsed).empty());
  }
  CHECK(std::holds_alternative<std::string>(parse_request(std::string(4000, '['))));
}

TEST_CASE("A state says how everything is, in numbers that JSON knows") {
  world_server::Simulation simulation = make_simulation("boxes");
  std::uint32_t id = 0;
  REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, id).empty());
  world_server::WorldState state;
  world_server::read_state(simulation, state);
  json message = json::parse(state_message(state, 12, 86400.123456, 0.98765, 3));
  CHECK(message["type"] == "state");
  CHECK(message["n"] == 12);
  CHECK(message["sent"] == 86400.123456);
  CHECK(message["reached"] == 0.988);
  CHECK(message["viewers"] == 3);
  CHECK(message["boxes"].size() == state.boxes.size());
  const json& robot = message["robots"][0];
  CHECK(robot["id"] == id);
  CHECK(robot["holder"] == 7);
  CHECK(robot["battery_s"] == 3600);  // share/robots/kenaf.toml
  CHECK(robot["flipper"].size() == 4);
  CHECK(robot["command"]["flipper"][0] == json::array({"brake", 0}));
  CHECK_FALSE(robot.contains("client"));
  CHECK_FALSE(robot.contains("fault"));

  state.robots[0].X_WB.p.x() = std::numeric_limits<double>::quiet_NaN();
  state.robots[0].fault = "it \"exploded\"\n\x80";
  state.robots[0].name = "</script>\"";
  message = json::parse(state_message(state, 1, 0, 0, 0));
  CHECK(message["robots"][0]["p"][0].is_null());
  CHECK(json::parse(inventory_message(state))["robots"][0]["name"] == "</script>\"");

  state.robots[0].flipper_rad[2] = std::numeric_limits<double>::quiet_NaN();
  state.robots[0].dimensions.has_flipper[2] = false;
  CHECK(json::parse(state_message(state, 1, 0, 0, 0))["robots"][0]["flipper"][2].is_null());
  CHECK(json::parse(inventory_message(state))["robots"][0]["flipper"]["has"] == json::array({true, true, false, true}));
}

TEST_CASE("Contacts and sensors are in a state only if they are shown, the latter of one robot") {
  world_server::Simulation simulation = make_simulation();
  std::uint32_t first = 0, second = 0;
  REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, first).empty());
  REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, second).empty());
  for (int i = 0; i < 1000; ++i) simulation.world.step();
  world_server::WorldState state;
  world_server::read_state(simulation, state, {true, {first, second}});
  const json plain = json::parse(state_message(state, 1, 1, 1, 1));
  for (const char* key : {"contacts", "scans", "imu"}) CHECK_FALSE(plain["robots"][0].contains(key));
  const json shown = json::parse(state_message(state, 1, 1, 1, 1, {}, {true, second}));
  double up_n = 0;
  for (const json& contact : shown["robots"][0]["contacts"]) {
    REQUIRE(contact.size() == 7);
    CHECK((contact[0] == 0 || contact[0] == 1));  // a track
    up_n += contact[6].get<double>();
  }
  CHECK(up_n == Approx(20 * 9.80665).epsilon(1e-3));
  CHECK_FALSE(shown["robots"][0].contains("scans"));
  // share/robots/kenaf.toml has a scanner and a sonar; nothing is within their range but perhaps the other robot
  const json& scans = shown["robots"][1]["scans"];
  REQUIRE(scans.size() == 2);
  CHECK(scans[0]["name"] == "Scanner1");
  CHECK(scans[0]["ranges"].size() == world_server::kMostScanRays);
  CHECK(scans[1]["sonar"] == true);
  CHECK(scans[1]["ranges"].size() == 1);
  CHECK(shown["robots"][1]["imu"]["a"][2].get<double>() == Approx(9.80665).epsilon(1e-3));
}

TEST_CASE("An inventory has the robot that can be placed") {
  world_server::Simulation simulation = make_simulation();
  world_server::WorldState state;
  world_server::read_state(simulation, state);
  CHECK_FALSE(json::parse(inventory_message(state)).contains("placeable"));
  const auto* robot = world_server::robot_to_place(simulation);
  REQUIRE(robot != nullptr);
  const json placeable = json::parse(inventory_message(state, physics::dimensions_of(*robot)))["placeable"];
  CHECK(placeable["tracks"][0]["length"] == 0.58);
  CHECK(placeable["ride_height"] == 0.09);
}

TEST_CASE("An inventory says what everything is, and is new when somebody comes or leaves") {
  world_server::Simulation simulation = make_simulation();
  std::uint32_t id = 0;
  REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, id).empty());
  world_server::WorldState one, two;
  world_server::read_state(simulation, one);
  const json robot = json::parse(inventory_message(one))["robots"][0];
  CHECK(robot["placed"] == true);
  CHECK(robot["class"] == "USARBot.Kenaf");
  CHECK(robot["tracks"][0]["length"] == 0.58);
  CHECK(robot["flipper"]["at"] == json::array({0.225, 0.17, -0.025}));
  CHECK(robot["flipper"]["has"] == json::array({true, true, true, true}));
  CHECK(robot["max_speed"] == 0.5);
  one.robots[0].robot = kenaf::physics::RobotId{31};
  CHECK(json::parse(inventory_message(one))["robots"][0]["view"] == "#31");
  two = one;
  two.robots[0].X_WB.p.x() = 1;
  CHECK(same_inventory(one, two));
  REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, id).empty());
  world_server::read_state(simulation, two);
  CHECK_FALSE(same_inventory(one, two));
}

TEST_CASE("A state that is filled again allocates nothing") {
  world_server::Simulation simulation = make_simulation("boxes");
  std::uint32_t id = 0;
  for (int i = 0; i < 3; ++i)
    REQUIRE(world_server::place_robot_by_hand(simulation, world_server::OperatorId{7}, id).empty());
  world_server::WorldState state;
  world_server::read_state(simulation, state);
  const std::uint64_t before = test::allocations();
  world_server::read_state(simulation, state);
  CHECK(test::allocations() == before);
}

TEST_CASE("The scene's bytes: a plane, then the box of step-200, numbers of 4 bytes") {
  const std::string bytes = scene_bytes(make_simulation("step-200").world.description());
  std::uint32_t header[4];
  REQUIRE(bytes.size() == sizeof header + 4 * (7 + 10));
  std::memcpy(header, bytes.data(), sizeof header);
  CHECK(header[0] == kSceneMagic);
  CHECK(header[1] == 1);
  CHECK(header[2] == 1);
  CHECK(header[3] == 0);
  float box[10];
  std::memcpy(box, bytes.data() + 16 + 4 * 7, sizeof box);
  CHECK(box[2] == Approx(0.2));  // its height
  CHECK(box[5] == Approx(0.1));  // its centre
  CHECK(box[6] == 1);            // not turned
}

TEST_CASE("A mesh in the scene's bytes has as many triangles as its file") {
  const physics::WorldDescription world = make_simulation("rubble-mesh").world.description();
  REQUIRE(world.meshes.size() == 1);
  const auto& mesh = world.meshes.front();
  const std::string bytes = scene_bytes(world);
  CHECK(bytes.size() == 16 + 28 * world.planes.size() + 8 + 12 * mesh.vertices_W.size() + 12 * mesh.triangles.size());
}

}  // namespace kenaf::live
