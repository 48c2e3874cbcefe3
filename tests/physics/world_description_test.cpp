// SDF: what is read, what is listed as not simulated, and what is refused.
#include <catch2/catch.hpp>

#include "physics/world_description.hpp"

using namespace kenaf::physics;

namespace {

std::string sdf(const std::string& inside) {
  return "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\"><world name=\"w\">\n" + inside + "\n</world></sdf>\n";
}

std::string model(const std::string& geometry, const std::string& more = "<static>true</static>") {
  return "<model name=\"m\">" + more +
         "<pose>1 2 3 0 0 0.5</pose><link name=\"l\"><pose>0.1 0 0 0 0 0</pose><inertial><mass>4</mass></inertial>" +
         "<collision name=\"c\"><geometry>" + geometry +
         "</geometry><surface><friction><ode><mu>0.7</mu></ode></friction></surface></collision></link></model>";
}

std::string error_of(const std::string& text) {
  std::vector<std::string> unsupported;
  try {
    parse_world(text, "test.sdf", "", unsupported);
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Boxes: pose through model and link, friction, mass") {
  std::vector<std::string> unsupported;
  const WorldDescription fixed = parse_world(sdf(model("<box><size>1 2 3</size></box>")), "t", "", unsupported);
  REQUIRE(fixed.boxes.size() == 1);
  CHECK(fixed.boxes[0].mass_kg == 0);
  CHECK(fixed.boxes[0].friction == 0.7);
  CHECK(fixed.boxes[0].size_m == Eigen::Vector3d(1, 2, 3));
  // 0.1 m along the model's own x, which is turned by 0.5
  CHECK((fixed.boxes[0].X_WBox.p - Eigen::Vector3d(1 + 0.1 * std::cos(0.5), 2 + 0.1 * std::sin(0.5), 3)).norm() < 1e-9);
  const WorldDescription loose = parse_world(sdf(model("<box><size>1 2 3</size></box>", "")), "t", "", unsupported);
  CHECK(loose.boxes.at(0).mass_kg == 4);
  CHECK(unsupported.empty());
}

TEST_CASE("Start poses are the frames that begin with start") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(
      sdf("<frame name=\"start_a\"><pose>1 2 0 0 0 0.5</pose></frame><frame name=\"other\"/>"), "t", "", unsupported);
  REQUIRE(world.start_poses.size() == 1);
  CHECK(world.start_poses[0].name == "start_a");
  CHECK(roll_pitch_yaw(world.start_poses[0].X_WB.q).z() == Approx(0.5));
  CHECK(parse_world(sdf(""), "t", "", unsupported).start_poses.at(0).name == "PlayerStart_0");
}

TEST_CASE("Models within models stand where the outer one puts them, and are static with it") {
  std::vector<std::string> unsupported;
  const auto world =
      parse_world(sdf("<model name=\"outer\"><static>true</static><pose>1 0 0 0 0 1.5707963267948966</pose>"
                      "<model name=\"inner\"><pose>2 0 0 0 0 0</pose><link name=\"l\"><pose>0 0 3 0 0 0</pose>"
                      "<collision name=\"c\"><geometry><box><size>1 1 "
                      "1</size></box></geometry></collision></link></model></model>"),
                  "t", "", unsupported);
  CHECK(unsupported.empty());
  REQUIRE(world.boxes.size() == 1);
  CHECK(world.boxes[0].name == "outer/inner");
  CHECK((world.boxes[0].X_WBox.p - Eigen::Vector3d(1, 2, 3)).norm() < 1e-9);
  CHECK(world.boxes[0].mass_kg == 0);
}

TEST_CASE("What is not simulated is named with its line") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(sdf(model("<image><uri>a.png</uri></image>") +
                                     "\n<light name=\"sun\" type=\"directional\"/>\n<something>1</something>\n"
                                     "<include><uri>model://ground_plane</uri></include>"),
                                 "test.sdf", "", unsupported);
  CHECK(world.boxes.empty());
  REQUIRE(unsupported.size() == 4);
  CHECK(unsupported[0] == "test.sdf:6: <include> is not read; write the model itself into the world");
  CHECK(unsupported[1] == "test.sdf:3: <image> in <geometry> is not simulated");
  CHECK(unsupported[2] == "test.sdf:4: <light> in <world> is not simulated");
  CHECK(unsupported[3].find("<something> in <world>") != std::string::npos);
}

TEST_CASE("A loose model that is no box is left out, and said so") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(sdf(model("<sphere><radius>1</radius></sphere>", "")), "test.sdf", "", unsupported);
  CHECK(world.meshes.empty());
  REQUIRE(unsupported.size() == 1);
  CHECK(unsupported[0] == "test.sdf:3: a <sphere> of a model that is not <static> is not simulated");
}

TEST_CASE("A model of several loose bodies is left out, and said so") {
  std::vector<std::string> unsupported;
  const auto world =
      parse_world(sdf("<model name=\"arm\"><link name=\"a\"/><link name=\"b\"/>"
                      "<joint name=\"j\" type=\"fixed\"><parent>a</parent><child>b</child></joint></model>"),
                  "test.sdf", "", unsupported);
  CHECK(world.boxes.empty());
  CHECK(unsupported.size() == 2);  // the joint, and the model
}

TEST_CASE("What cannot be a world is refused with its place") {
  CHECK(error_of("not xml").find("test.sdf") == 0);
  CHECK(error_of(sdf("<gravity>0 1 -9.8</gravity>")).find("must point along -z") != std::string::npos);
  CHECK(error_of(sdf("<gravity>down</gravity>")).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 -2 3</size></box>"))).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 nan 3</size></box>"))).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 1 1</size></box><sphere><radius>1</radius></sphere>"))).find("one shape") !=
        std::string::npos);
  CHECK(error_of("<sdf version=\"1.9\"></sdf>").find("exactly one <world>") != std::string::npos);
  std::vector<std::string> unsupported;
  CHECK_THROWS_AS(load_world("no-such-world", unsupported), kenaf::description::DescriptionError);
}
