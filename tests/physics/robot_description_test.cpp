// The shipped robots are what their files say, and what is wrong in a file is said with its place.
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "physics/pose.hpp"
#include "physics/robot_description.hpp"

using namespace kenaf::physics;

namespace {

std::string kenaf_text() {
  std::ifstream in(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The error of kenaf.toml with `from` replaced.
std::string error_with(const std::string& from, const std::string& to) {
  std::string text = kenaf_text();
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  try {
    parse_robot(text, "test.toml");
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Kenaf is what is known of it") {
  const RobotDescription robot = load_robot("kenaf");
  CHECK(robot.name == "kenaf");
  CHECK(robot.usarsim_class == "USARBot.Kenaf");
  CHECK(robot.total_mass_kg() == Approx(20));
  CHECK(robot.track.front().friction_along == 1.3);
  CHECK(robot.track_gauge_m() == Approx(0.2));
  // the whole robot's centre of mass, flippers straight out: 50 mm below its centre. An arm's own centre lies on its
  // axis.
  const double z = (robot.body.mass_kg * robot.body.p_BBcm_m.z() + 5.0 * robot.flipper.front().p_BPivot_m.z()) / 20;
  CHECK(z == Approx(-0.05).margin(1e-4));
  // the envelope: 0.6 x 0.4 x 0.18 m with the flippers folded over the body
  const auto& f = robot.flipper.front();
  CHECK(robot.track.front().length_m <= 0.6);
  CHECK(f.p_BPivot_m.x() + f.pivot_radius_m <= 0.3);
  CHECK(2 * (f.p_BPivot_m.y() + f.width_m / 2) <= 0.4);
  CHECK(robot.body.size_m.z() / 2 + robot.track.front().end_radius_m - robot.track.front().p_BT_m.z() <= 0.18);
  CHECK(f.length_m + f.tip_radius_m <= f.p_BPivot_m.x());  // front and rear do not meet when folded
}

TEST_CASE("All shipped robots load, by class too") {
  for (const char* name : {"kenaf", "marmotte", "maxxii"}) CHECK_FALSE(load_robot(name).has_wheels());
  for (const char* name : {"p2dx", "p2at", "p3at", "basicskidrobot", "husky", "jackal", "warthog"}) {
    CHECK(load_robot(name).name == name);
    CHECK(load_robot(name).has_wheels());
  }
  CHECK(robot_name_for_class("USARBot.Kenaf") == "kenaf");
  CHECK(robot_name_for_class("usarbot.kenaf") == "kenaf");
  CHECK(robot_name_for_class("P2AT") == "p2at");
  CHECK(robot_name_for_class("USARBot.Nobody").empty());
  CHECK(robot_name_for_class("USARBot.../robots/kenaf").empty());
  CHECK(robot_name_for_class("").empty());
}

TEST_CASE("What is wrong is said with file, line and column") {
  CHECK(error_with("mass_kg = 15.0", "mass = 15.0").find("body.mass_kg is missing") != std::string::npos);
  CHECK(
      error_with("mass_kg = 15.0", "mass_kg = 15.0\nmasse = 1").find("test.toml:12:1: body.masse is not a known key") ==
      0);
  CHECK(error_with("mass_kg = 15.0", "mass_kg = \"heavy\"").find("test.toml:11:11: body.mass_kg must be a number") ==
        0);
  CHECK(error_with("mass_kg = 15.0", "mass_kg = -1").find("body.mass_kg is -1, but must be more than 0") !=
        std::string::npos);
  CHECK(error_with("mass_kg = 15.0", "mass_kg = nan").find("must be") != std::string::npos);
  CHECK(error_with("[0.44, 0.10, 0.16]", "[0.44, 0.10]").find("list of 3 numbers") != std::string::npos);
  CHECK(error_with("[0.13, 0.44, 0.52]", "[0.13, 0.44, 5.2]").find("no rigid body") != std::string::npos);
  CHECK(error_with("pieces = 6", "pieces = 6.5").find("whole number") != std::string::npos);
  CHECK(error_with("belt_driven = true", "belt_driven = 1").find("true or false") != std::string::npos);
  // the drums' radii, 0.055 and 0.04, differ by 0.015: at that length the small one touches the large one from within
  CHECK(error_with("length_m = 0.145", "length_m = 0.01").find("flipper.length_m must be more than the difference") !=
        std::string::npos);
  CHECK(error_with("length_m = 0.145", "length_m = 0.016").empty());
  // 3.14159265 / 0.00076718 = 4094.99: 4095 angles between 4096 rays. / 0.000767 = 4095.95: one more
  CHECK(error_with("resolution_rad = 0.01745329", "resolution_rad = 0.00076718").empty());
  CHECK(error_with("resolution_rad = 0.01745329", "resolution_rad = 0.000767").find("more than 4096 rays") !=
        std::string::npos);
  CHECK(error_with("type = \"GPS\"", "type = \"gps\"").find("must be one of GroundTruth") != std::string::npos);
  CHECK(error_with("name = \"GPS\"", "name = \"INS\"").find("name of another sensor") != std::string::npos);
  CHECK(error_with("[servo]", "[servo").find("test.toml:") == 0);
  CHECK(error_with("start_angle_rad = 1.0", "start_angle_rad = 4.0").find("between min_angle_rad") !=
        std::string::npos);
  CHECK(error_with("belt_driven = true", "belt_driven = true\npairs = \"both\"").empty());
  CHECK(error_with("belt_driven = true", "belt_driven = true\npairs = \"front\"").empty());
  CHECK(error_with("belt_driven = true", "belt_driven = true\npairs = \"left\"")
            .find("flipper.pairs is \"left\", but must be") != std::string::npos);
  CHECK_THROWS_AS(load_robot("no-such-robot"), kenaf::description::DescriptionError);
  CHECK_THROWS_AS(load_robot("./no-such-file.toml"), kenaf::description::DescriptionError);
}

TEST_CASE("A robot drives on tracks or on wheels") {
  const std::string wheel =
      "[[wheel]]\nleft_center_m = [0.2, 0.3, 0]\nradius_m = 0.1\nwidth_m = 0.04\nfriction_along = 1\n"
      "friction_across = 1\n";
  const auto with = [](const std::string& more) { return error_with("[drive]", more + "[drive]"); };
  CHECK(with(wheel).find("wheel and [track] exclude each other") != std::string::npos);
  CHECK(with("[[caster]]\ncenter_m = [0, 0, 0]\n").find("caster is for robots with [[wheel]]") != std::string::npos);

  // Kenaf's file without its track, or with wheels in its place
  std::string text = kenaf_text();
  const std::size_t track = text.find("[track]");
  text.erase(track, text.find("[drive]") - track);
  const auto error = [&](const std::string& in_place) {
    try {
      parse_robot(std::string(text).insert(track, in_place), "test.toml");
    } catch (const kenaf::description::DescriptionError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(error("").find("track is missing") != std::string::npos);
  CHECK(error(wheel).find("wheel and [flipper] exclude each other") != std::string::npos);
  text.erase(text.find("[flipper]"), text.find("[battery]") - text.find("[flipper]"));
  CHECK(error(wheel).empty());
  CHECK_THROWS_WITH(parse_robot("wheel = []\n" + text, "test.toml"), Catch::Contains("wheel is empty"));
  CHECK(error(wheel + wheel).find("wheel[1].left_center_m must have a smaller x than the wheel before") !=
        std::string::npos);
  const auto changed = [&](const std::string& was, const std::string& is) {
    std::string other = wheel;
    return error(other.replace(other.find(was), was.size(), is));
  };
  CHECK(changed("[0.2, 0.3, 0]", "[0.2, 0.02, 0]").find("must have a y of more than half of width_m") !=
        std::string::npos);
  CHECK(changed("radius_m = 0.1", "radius_m = 0").find("wheel[0].radius_m is 0, but must be more than 0") !=
        std::string::npos);
  CHECK(changed("radius_m = 0.1", "radius_m = 0.1\nsteering = true").find("steering is not a known key") !=
        std::string::npos);
}

TEST_CASE("Effects, lugs and a servo's encoder stand in the description, or stay neutral") {
  const RobotDescription nominal = load_robot("kenaf");
  CHECK(nominal.effects == Effects{});
  const RobotDescription robot =
      parse_robot(kenaf_text() +
                      "\n[effects.command_delay]\ndelay_s = 0.08\n[effects.pitch_inertia]\nscale = 1.42\n"
                      "[effects.com_up]\n",
                  "test.toml");
  CHECK(robot.effects == Effects{.command_delay_s = 0.08, .pitch_inertia_scale = 1.42});
  CHECK(error_with("lug_height_m = 0.0005", "lug_height_m = 0.06").find("track.lug_height_m is 0.06, but must be") !=
        std::string::npos);
  CHECK(error_with("amperes_per_nm = 0.25", "amperes_per_nm = 0.25\nresolution_rad = 2").find("servo.resolution_rad") !=
        std::string::npos);
}

TEST_CASE("What is wrong with an effect is said with file, line and column") {
  const auto error = [](const std::string& effects) {
    return error_with("usarsim_class = \"USARBot.Kenaf\"\n", "usarsim_class = \"USARBot.Kenaf\"\n" + effects);
  };
  CHECK(error("[effects.comand_delay]\ndelay_s = 0.1\n")
            .find("test.toml:9:10: effects.comand_delay is not a known key") == 0);
  CHECK(error("[effects.command_delay]\ndelay = 0.1\n")
            .find("test.toml:10:1: effects.command_delay.delay is not a known key") == 0);
  CHECK(error("[effects.command_delay]\ndelay_s = 3\n")
            .find("test.toml:10:11: effects.command_delay.delay_s is 3, but must be from 0 to 1") == 0);
  CHECK(error("[effects.command_delay]\ndelay_s = \"long\"\n")
            .find("test.toml:10:11: effects.command_delay.delay_s must be a number") == 0);
  CHECK(error("[effects]\ncommand_delay = 0.1\n").find("test.toml:10:17: effects.command_delay must be a table") == 0);
  CHECK(error("effects = 3\n").find("test.toml:9:11: effects must be a table") == 0);
}

TEST_CASE("Angles: z-y-x, pitch positive nose down") {
  // nose down: the body's x axis points below the horizon
  CHECK((rotation_from({0, 0.3, 0}) * Eigen::Vector3d::UnitX()).z() == Approx(-std::sin(0.3)));
  // yaw to the left, roll right side down
  CHECK((rotation_from({0, 0, 0.3}) * Eigen::Vector3d::UnitX()).y() == Approx(std::sin(0.3)));
  CHECK((rotation_from({0.3, 0, 0}) * Eigen::Vector3d::UnitY()).z() == Approx(std::sin(0.3)));
  const Eigen::Vector3d angles(0.4, -0.7, 2.5);
  CHECK((roll_pitch_yaw(rotation_from(angles)) - angles).norm() < 1e-12);
  const Pose X{{1, 2, 3}, rotation_from(angles)};
  CHECK(compose(X, inverse(X)).p.norm() < 1e-12);
}
