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
  CHECK(unsupported[0] == "test.sdf:3: <image> in <geometry> is not simulated");
  CHECK(unsupported[1] == "test.sdf:4: <light> in <world> is not simulated");
  CHECK(unsupported[2] == "test.sdf:5: <something> in <world> is not simulated");
  CHECK_THAT(unsupported[3], Catch::StartsWith("test.sdf:6: <include> of \"model://ground_plane\" is left out"));
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

// Visuals, sensors, plugins and the rest may say what they like.
TEST_CASE("What has no effect here never refuses a world") {
  const std::string box = "<collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry>";
  for (const std::string& inside :
       {"<visual name=\"v\"><material><script><name>Grey</name></script></material></visual>" + box + "</collision>",
        "<visual name=\"v\"/><visual name=\"v\"><pose>1 2 3</pose></visual>" + box + "</collision>",
        "<sensor name=\"s\" type=\"smell\"><update_rate>often</update_rate></sensor>" + box + "</collision>",
        "<inertial auto=\"true\"><mass>0</mass><inertia><ixx>-1</ixx></inertia></inertial>" + box + "</collision>",
        box + "<surface><contact><ode><kp>stiff</kp></ode></contact><bounce/></surface></collision>",
        box + "<laser_retro>x</laser_retro></collision><light name=\"l\" type=\"\"/>",
        "<gravity>0</gravity><battery/><unknown a=\"1\"/>" + box + "</collision>"}) {
    INFO(inside);
    std::vector<std::string> unsupported;
    const WorldDescription world =
        parse_world(sdf("<physics type=\"none\"><real_time_factor>fast</real_time_factor></physics>"
                        "<scene><ambient>red</ambient></scene><atmosphere/><state world_name=\"other\"/>"
                        "<model name=\"m\"><static>1</static><link name=\"l\">" +
                        inside + "</link><plugin/><joint name=\"j\" type=\"odd\"/></model>"),
                    "t", "", unsupported);
    CHECK(world.boxes.size() == 1);
    CHECK(unsupported.size() >= 7);
  }
}

TEST_CASE("A model without a link has no effect") {
  std::vector<std::string> unsupported;
  CHECK(parse_world(sdf("<model name=\"empty\"/>"), "t", "", unsupported).boxes.empty());
}

TEST_CASE("Friction beyond 10 is simulated as 10, and said so with its line") {
  const auto friction_of = [](const std::string& mu, std::vector<std::string>& unsupported) {
    const std::string text =
        sdf("<model name=\"m\"><static>1</static><link name=\"l\"><collision name=\"c\"><geometry>"
            "<plane/></geometry>\n<surface><friction><ode><mu>" +
            mu + "</mu></ode></friction></surface></collision></link></model>");
    return parse_world(text, "t.sdf", "", unsupported).planes.at(0).friction;
  };
  std::vector<std::string> unsupported;
  CHECK(friction_of("10", unsupported) == 10);
  CHECK(unsupported.empty());
  CHECK(friction_of("100", unsupported) == 10);
  CHECK(unsupported == std::vector<std::string>{"t.sdf:4: <mu> of 100 is simulated as 10, the most"});
  CHECK_THROWS_AS(friction_of("-1", unsupported), kenaf::description::DescriptionError);
  CHECK_THROWS_AS(friction_of("nan", unsupported), kenaf::description::DescriptionError);
}

// 1 m x 2 m x 0.5 m = 1 m3
TEST_CASE("The mass of a loose box is as given, or with auto by its density") {
  const auto mass_of = [](const std::string& inertial, const std::string& density = "") {
    std::vector<std::string> unsupported;
    return parse_world(sdf("<model name=\"m\"><link name=\"l\">" + inertial + "<collision name=\"c\">" + density +
                           "<geometry><box><size>1 2 0.5</size></box></geometry></collision></link></model>"),
                       "t", "", unsupported)
        .boxes.at(0)
        .mass_kg;
  };
  CHECK(mass_of("<inertial><mass>3</mass></inertial>") == 3);
  CHECK(mass_of("") == 1);  // SDF's default
  CHECK(mass_of("<inertial auto=\"true\"/>") == 1000);
  CHECK(mass_of("<inertial auto=\"true\"/>", "<density>600</density>") == 600);
  CHECK(mass_of("<inertial auto=\"true\"><density>20</density></inertial>") == 20);
  CHECK(mass_of("<inertial auto=\"true\"><mass>3</mass></inertial>") == 3);
  CHECK_THROWS_AS(mass_of("<inertial><mass>0</mass></inertial>"), kenaf::description::DescriptionError);
}

TEST_CASE("Gravity is as the file says, in any direction") {
  std::vector<std::string> unsupported;
  const auto gravity = [&](const std::string& text) { return parse_world(text, "t", "", unsupported).gravity_W_mps2; };
  CHECK(gravity(sdf("<gravity>-1 0.5 -9.5</gravity>")) == Eigen::Vector3d(-1, 0.5, -9.5));
  CHECK(gravity(sdf("<gravity>0 0 0</gravity>")) == Eigen::Vector3d(0, 0, 0));
  CHECK(gravity(sdf("")) == Eigen::Vector3d(0, 0, -9.8));  // SDF's default
  // up to SDF 1.5 it belongs to the physics engine
  CHECK(gravity("<sdf version=\"1.4\"><world name=\"w\"><physics type=\"ode\"><gravity>0 0 -1.62</gravity></physics>"
                "</world></sdf>") == Eigen::Vector3d(0, 0, -1.62));
}

// The model stands at (1, 2, 0), turned by 90 degrees; its own x is the world's y.
TEST_CASE("A pose's frame: an empty one is the parent's, SDF 1.6 says frame where later ones say relative_to") {
  const auto place_of = [](const std::string& version, const std::string& attribute) {
    std::vector<std::string> unsupported;
    const std::string text =
        "<sdf version=\"" + version +
        "\"><world name=\"w\"><model name=\"m\"><static>1</static><pose>1 2 0 0 0 1.5707963267948966</pose>"
        "<frame name=\"f\"><pose>0 0 5 0 0 0</pose></frame><link name=\"l\"><pose " +
        attribute +
        ">1 0 0 0 0 0</pose><collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>"
        "</link></model></world></sdf>";
    const Eigen::Vector3d place = parse_world(text, "t", "", unsupported).boxes.at(0).X_WBox.p;
    CHECK(unsupported.size() == (attribute == "frame=\"f\"" && version == "1.7" ? 1 : 0));
    return place;
  };
  const Eigen::Vector3d in_model(1, 3, 0), in_frame(1, 3, 5);
  for (const char* version : {"1.4", "1.6", "1.7", "1.9"})
    CHECK((place_of(version, "frame=\"\"") - in_model).norm() < 1e-9);
  CHECK((place_of("1.6", "frame=\"f\"") - in_frame).norm() < 1e-9);
  CHECK((place_of("1.7", "relative_to=\"f\"") - in_frame).norm() < 1e-9);
  CHECK((place_of("1.7", "frame=\"f\"") - in_model).norm() < 1e-9);  // not a name of that version: noted
}

TEST_CASE("Before SDF 1.8, :: in a name is like any other sign") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(
      "<sdf version=\"1.6\"><world name=\"w\"><model name=\"m\"><static>1</static><link name=\"a::l\"><pose>1 0 0 0 0 "
      "0</pose><collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision></link>"
      "<link name=\"b::l\"><pose frame=\"a::l\">1 0 0 0 0 0</pose><collision name=\"c\"><geometry><box><size>1 1 "
      "1</size></box></geometry></collision></link></model></world></sdf>",
      "t", "", unsupported);
  REQUIRE(world.boxes.size() == 2);
  CHECK(world.boxes[1].X_WBox.p.x() == Approx(2));
}

TEST_CASE("A pose may be given in the frame of a joint") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(
      sdf("<model name=\"m\"><static>1</static><link name=\"a\"><pose>1 0 0 0 0 0</pose></link>"
          "<link name=\"b\"><pose relative_to=\"j\">0 3 0 0 0 0</pose><collision name=\"c\"><geometry><box><size>1 1 "
          "1</size></box></geometry></collision></link>"
          "<joint name=\"j\" type=\"fixed\"><parent>world</parent><child>a</child><pose>0 0 2 0 0 "
          "0</pose></joint></model>"),
      "t", "", unsupported);
  REQUIRE(world.boxes.size() == 1);
  CHECK((world.boxes[0].X_WBox.p - Eigen::Vector3d(1, 3, 2)).norm() < 1e-9);
  CHECK(unsupported.size() == 1);  // the joint
}

TEST_CASE("A newer version of SDF is read as 1.9, and said so") {
  std::vector<std::string> unsupported;
  parse_world("<sdf version=\"1.12\"><world name=\"w\"/></sdf>", "t.sdf", "", unsupported);
  CHECK(unsupported == std::vector<std::string>{"t.sdf:1: SDF 1.12 is read as SDF 1.9"});
  for (const char* version : {"", "2.0", "1", "1.x", "next"})
    CHECK(error_of("<sdf version=\"" + std::string(version) + "\"><world name=\"w\"/></sdf>").find("test.sdf:1: ") ==
          0);
}

TEST_CASE("What cannot be a world is refused with its place") {
  CHECK(error_of("not xml").find("test.sdf") == 0);
  CHECK(error_of(sdf("<gravity>0 600 -900</gravity>")).find("test.sdf:3: <gravity> must be at most 1000") == 0);
  CHECK(error_of(sdf("<gravity>0 0 nan</gravity>")).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 1 1</size></box>", "<static>maybe</static>"))).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf("<gravity>down</gravity>")).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 -2 3</size></box>"))).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 nan 3</size></box>"))).find("test.sdf:3: ") == 0);
  CHECK(error_of(sdf(model("<box><size>1 1 1</size></box><sphere><radius>1</radius></sphere>"))).find("one shape") !=
        std::string::npos);
  CHECK(error_of("<sdf version=\"1.9\"></sdf>").find("exactly one <world>") != std::string::npos);
  std::vector<std::string> unsupported;
  CHECK_THROWS_AS(load_world("no-such-world", unsupported), kenaf::description::DescriptionError);
}

// The model is at (1, 0, 0), its link 2 further along x; the frame 5 above the model's origin. So the box in the frame
// is at (1, 0, 5) in the world, whatever its link's place.
TEST_CASE("A collision may be placed in a frame of its model") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(
      sdf("<model name=\"m\"><static>1</static><pose>1 0 0 0 0 0</pose><frame name=\"f\"><pose>0 0 5 0 0 0</pose>"
          "</frame><link name=\"l\"><pose>2 0 0 0 0 1.5</pose><collision name=\"c\"><pose relative_to=\"f\"/>"
          "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model>"),
      "t", "", unsupported);
  REQUIRE(world.boxes.size() == 1);
  CHECK((world.boxes[0].X_WBox.p - Eigen::Vector3d(1, 0, 5)).norm() < 1e-9);
}

// The part is turned by 90 degrees and stands at (0, 3, 0); "part::l" is 1 along the part's x, which points along y.
TEST_CASE("A pose may be given in a frame of a model within a model") {
  const std::string part =
      "<model name=\"part\"><static>1</static><pose>0 3 0 0 0 1.5707963267948966</pose>"
      "<link name=\"l\"><pose>1 0 0 0 0 0</pose></link></model>";
  std::vector<std::string> unsupported;
  const auto at = [&](const std::string& name) {
    return parse_world(
               sdf(part + "<frame name=\"start\"><pose relative_to=\"" + name + "\">0 0 1 0 0 0</pose></frame>"), "t",
               "", unsupported)
        .start_poses.at(0)
        .X_WB.p;
  };
  CHECK((at("part::l") - Eigen::Vector3d(0, 4, 1)).norm() < 1e-9);
  CHECK((at("part::__model__") - Eigen::Vector3d(0, 3, 1)).norm() < 1e-9);
  CHECK((at("world") - Eigen::Vector3d(0, 0, 1)).norm() < 1e-9);
  CHECK_THROWS_AS(at("part::gone"), kenaf::description::DescriptionError);
  CHECK_THROWS_AS(at("part::l::gone"), kenaf::description::DescriptionError);
  CHECK_THROWS_AS(at("__model__"), kenaf::description::DescriptionError);
}

TEST_CASE("A rotation is given as angles, in degrees, or as a quaternion") {
  const auto yaw_of = [](const std::string& pose) {
    std::vector<std::string> unsupported;
    const auto world = parse_world(sdf("<frame name=\"start\">" + pose + "</frame>"), "t", "", unsupported);
    return roll_pitch_yaw(world.start_poses.at(0).X_WB.q).z();
  };
  CHECK(yaw_of("<pose>0 0 0 0 0 0.5</pose>") == Approx(0.5));
  CHECK(yaw_of("<pose degrees=\"true\">0 0 0 0 0 90</pose>") == Approx(1.5707963267948966));
  CHECK(yaw_of("<pose rotation_format=\"quat_xyzw\">0 0 0 0 0 1 1</pose>") == Approx(1.5707963267948966));
  CHECK(yaw_of("<pose>\n  0 0\t0 0 0 +5e-1 </pose>") == Approx(0.5));
  for (const char* pose : {"<pose>0 0 0 0 0</pose>", "<pose>0 0 0 0 0 0 1</pose>", "<pose>0 0 0 0 0 a</pose>",
                           "<pose>0 0 0 0 0 nan</pose>", "<pose rotation_format=\"quat_xyzw\">0 0 0 0 0 0 0</pose>",
                           "<pose rotation_format=\"matrix\">0 0 0 0 0 0</pose>",
                           "<pose degrees=\"often\">0 0 0 0 0 0</pose>", "<pose>0 0 1e6 0 0 0</pose>"}) {
    INFO(pose);
    CHECK(error_of(sdf("<frame name=\"start\">" + std::string(pose) + "</frame>")).find("test.sdf:3: ") == 0);
  }
}

// As libsdformat renames it; the model keeps the name for itself.
TEST_CASE("A frame that has a model's name is renamed, and said so") {
  std::vector<std::string> unsupported;
  const auto world = parse_world(
      sdf("<model name=\"a\"><pose>1 0 0 0 0 0</pose></model><frame name=\"a\"><pose>0 2 0 0 0 0</pose></frame>"
          "<frame name=\"start_1\"><pose relative_to=\"a\"/></frame><frame name=\"start_2\"><pose "
          "relative_to=\"a_frame\"/></frame>"),
      "t.sdf", "", unsupported);
  REQUIRE(world.start_poses.size() == 2);
  CHECK(world.start_poses[0].X_WB.p == Eigen::Vector3d(1, 0, 0));
  CHECK(world.start_poses[1].X_WB.p == Eigen::Vector3d(0, 2, 0));
  CHECK(unsupported ==
        std::vector<std::string>{"t.sdf:3: the <frame> \"a\" has another element's name: it is called \"a_frame\""});
}

TEST_CASE("Names are given, not reserved, and not twice") {
  const std::string frame = "<frame name=\"a\"/>";
  CHECK(error_of(sdf("<frame/>")).find("test.sdf:3: a <frame> needs a name") == 0);
  CHECK(error_of(sdf("<frame name=\"world\"/>")).find("reserved") != std::string::npos);
  CHECK(error_of(sdf("<frame name=\"__root__\"/>")).find("reserved") != std::string::npos);
  CHECK(error_of(sdf(frame + "\n" + frame)) == "test.sdf:4: <frame> has the name \"a\" of the <frame> at test.sdf:3");
}
