#include "server/image_server/view_name.hpp"

#include <catch2/catch.hpp>

#include "tests/camera/scenes.hpp"

namespace kenaf::image_server {

namespace {

camera::RobotSnapshot robot(std::uint32_t id, const std::string& name, const std::string& description) {
  camera::RobotSnapshot out = camera::kenaf_at(camera::pose(0, 0, 0));
  out.id = physics::RobotId{id};
  out.name = name;
  out.description = std::make_shared<const physics::RobotDescription>(physics::load_robot(description));
  return out;
}

}  // namespace

TEST_CASE("A view is a camera of a robot, of the one placed last that has it where none is named") {
  const std::vector<camera::RobotSnapshot> robots{robot(1, "R1", "kenaf"), robot(4, "a/b", "kenaf"),
                                                  robot(9, "Bus", "p2at")};
  using physics::RobotId;
  CHECK(find_view(robots, "") == CameraId{RobotId{4}, 0});
  CHECK(find_view(robots, "BirdsEye") == CameraId{RobotId{4}, 1});
  CHECK(find_view(robots, "r1/birdseye") == CameraId{RobotId{1}, 1});
  CHECK(find_view(robots, "a/b/Camera") == CameraId{RobotId{4}, 0});
  for (const char* none : {"R1", "R1/", "/Camera", "Bus/Camera", "R2/Camera", "R1/Camera/", " Camera"}) {
    INFO(none);
    CHECK(find_view(robots, none) == std::nullopt);
  }
}

TEST_CASE("A robot is meant by its id where others have its name") {
  const std::vector<camera::RobotSnapshot> robots{robot(1, "Kenaf", "kenaf"), robot(12, "Kenaf", "kenaf"),
                                                  robot(13, "#1", "kenaf")};
  using physics::RobotId;
  CHECK(view_of(RobotId{12}) == "#12");
  CHECK(find_view(robots, "Kenaf/Camera") == CameraId{RobotId{12}, 0});
  CHECK(find_view(robots, "#1/Camera") == CameraId{RobotId{1}, 0});  // not the robot that is called so
  CHECK(find_view(robots, "#12/birdseye") == CameraId{RobotId{12}, 1});
  for (const char* none : {"#2/Camera", "#/Camera", "#01/Camera", "#1", "#1/Third", "#-1/Camera"}) {
    INFO(none);
    CHECK(find_view(robots, none) == std::nullopt);
  }
}

TEST_CASE("Where there is none, words say what there is instead") {
  const std::vector<camera::RobotSnapshot> kenaf{robot(1, "R1", "kenaf")}, bus{robot(1, "Bus", "p2at")};
  CHECK(no_such_view(kenaf, "x\n\"") == "there is no camera \"x?\"\"; there is R1/Camera, R1/BirdsEye");
  CHECK(no_such_view(bus, "") == "no robot in the world has a camera");
  CHECK(no_such_view({}, "") == "there is no robot in the world, hence no camera");
  const std::vector<camera::RobotSnapshot> many(64, kenaf.front());
  CHECK(no_such_view(many, std::string(255, '\x01')).size() < 1000);
  CHECK(no_such_view(many, "x").ends_with(" and 112 more"));
}

}  // namespace kenaf::image_server
