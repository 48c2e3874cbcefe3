// What is guessed of names as loggers give them.
#include "gap/recordings/guess.hpp"

#include <catch2/catch.hpp>

#include "gap/recordings/mapping.hpp"
#include "gap/recordings/name_words.hpp"

using namespace kenaf::gap::recordings;

namespace guess_test {
namespace {

// The guess for a table with these columns.
Mapping guessed(const std::string& header, const std::string& row) {
  const Table table = parse_table(header + "\n" + row + "\n" + row + "\n", "t.csv");
  const Guess guess = guess_mapping(survey(table), {"t.csv", "", nullptr});
  INFO(guess.toml);
  return parse_mapping(guess.toml, "guessed");
}

std::string source_of(const Mapping& mapping, const std::string& column) {
  for (const ColumnMapping& entry : mapping.columns)
    if (entry.column == column) return entry.from;
  return "";
}

double factor_of(const Mapping& mapping, const std::string& column) {
  for (const ColumnMapping& entry : mapping.columns)
    if (entry.column == column) return entry.factor;
  return 0;
}

}  // namespace

TEST_CASE("Words, sides, corners and units in names") {
  CHECK(words_in("/joint_states/velocity[frontLeft2]") == Words{"joint", "states", "velocity", "front", "left2"});
  CHECK(side_in(words_in("left_track")) == Side::left);
  CHECK(side_in(words_in("track_r")) == Side::right);
  CHECK_FALSE(side_in(words_in("left_to_right")));
  CHECK(corner_in(words_in("flipper_front_left")) == "fl");
  CHECK(corner_in(words_in("rearRightFlipper")) == "rr");
  CHECK(corner_in(words_in("flipper_left")).empty());
  CHECK(unit_in("speed [km/h]") == "km/h");
  CHECK(unit_in("left_speed_rpm") == "rpm");
  CHECK(unit_in("left_speed").empty());
}

TEST_CASE("A logger's columns are guessed by side, quantity and unit") {
  const Mapping mapping = guessed(
      "time,left_speed_mmps,right_speed_mmps,left_cmd_speed_mmps,right_cmd_speed_mmps,left_current_ma,battery_voltage,"
      "flipper_front_left_angle_deg,gyro_z_dps,temperature",
      "0,100,100,110,110,900,25,45,3,20");
  CHECK(mapping.rows == "track_left_mps");
  CHECK(source_of(mapping, "track_left_mps") == "left_speed_mmps");
  CHECK(factor_of(mapping, "track_left_mps") == 1e-3);
  CHECK(source_of(mapping, "cmd_track_right_mps") == "right_cmd_speed_mmps");
  CHECK(factor_of(mapping, "track_left_a") == 1e-3);
  CHECK(source_of(mapping, "battery_v") == "battery_voltage");
  CHECK(factor_of(mapping, "flipper_fl_rad") == Approx(0.0174533).epsilon(1e-5));
  CHECK(factor_of(mapping, "gyro_z_radps") == Approx(0.0174533).epsilon(1e-5));
  CHECK(mapping.columns.size() == 8);
}

TEST_CASE("Topics of rostopic and PlotJuggler are guessed by their fields") {
  const Mapping rostopic = guessed(
      "%time,field.pose.position.x,field.pose.position.y,field.pose.position.z,"
      "field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w",
      "1600000000000000000,1,2,3,0,0,0,1");
  REQUIRE(rostopic.pose);
  CHECK(rostopic.pose->rotation.back() == "field.pose.orientation.w");
  CHECK(rostopic.rows == "pose");
  CHECK(rostopic.time_unit_s == 1e-9);

  const Mapping juggler = guessed(
      "__time,/nav/cmd_vel/linear/x,/nav/cmd_vel/angular/z,/odom/twist/twist/linear/x,/odom/twist/twist/angular/z",
      "1,0.1,0.2,0.3,0.4");
  REQUIRE(juggler.drives.size() == 2);
  CHECK(juggler.rows == "track_left_mps");
  for (const DriveMapping& drive : juggler.drives) CHECK(drive.commanded == (drive.v == "/nav/cmd_vel/linear/x"));
}

TEST_CASE("EuRoC's inertial sensor, and a list of two drivers") {
  const Mapping euroc =
      guessed("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],a_RS_S_z [m s^-2]", "1403636579758555392,1,2,3");
  CHECK(source_of(euroc, "gyro_y_radps") == "w_RS_S_y [rad s^-1]");
  CHECK(source_of(euroc, "acc_z_mps2") == "a_RS_S_z [m s^-2]");
  CHECK(euroc.time_unit_s == 1e-9);

  Survey survey{"MCAP", 10, {}, "", "", {}, {}};
  SurveyedTopic feedback;
  feedback.topic = {"/feedback", "clearpath_platform_msgs/msg/Feedback", "cdr", "ros2msg", "", 100};
  for (const char* path : {"drivers[0].current", "drivers[0].measured_velocity", "drivers[1].measured_velocity"})
    feedback.signals.push_back({std::string("/feedback/") + path, path, 0, 1});
  survey.topics.push_back(feedback);
  const Guess guess = guess_mapping(survey, {"a.mcap", "", nullptr});
  CHECK(guess.toml.find("from = \"/feedback/drivers[1].measured_velocity\"") != std::string::npos);
  CHECK(guess.toml.find("CHECK whether [0] is left") != std::string::npos);
  // Without a robot the radius is for a person to fill in.
  CHECK(guess.toml.find("#radius_m =  # CHECK") != std::string::npos);
}

TEST_CASE("Names that TOML has to quote, and topics that are not understood, keep the guess readable") {
  Survey survey{"MCAP", 10, {}, "", "", {}, {"a remark\nof two lines"}};
  SurveyedTopic odd;
  odd.topic = {"/a\"b\\\x01", "type\n", "cdr", "", "", 100};
  odd.signals.push_back({"/a\"b\\\x01/left_track_speed_mps", "left_track_speed_mps", 0, 1});
  SurveyedTopic idl;
  idl.topic = {"/idl", "pkg/msg/Idl", "cdr", "ros2idl", "", 7};
  idl.not_understood = "its definition is in IDL";
  survey.topics = {odd, idl};
  const Guess guess = guess_mapping(survey, {"a\nb", "", nullptr});
  INFO(guess.toml);
  const Mapping mapping = parse_mapping(guess.toml, "guessed");
  CHECK(source_of(mapping, "track_left_mps") == odd.signals[0].from);
  CHECK(guess.toml.find("#   /idl: 7 messages of pkg/msg/Idl: its definition is in IDL") != std::string::npos);
}

TEST_CASE("Nothing that is recognised is said, too") {
  const Table table = parse_table("a,b\n1,2\n", "t.csv");
  const Guess guess = guess_mapping(survey(table), {"t.csv", "", nullptr});
  CHECK(guess.entries == 0);
  CHECK(guess.toml.find("nothing was recognised") != std::string::npos);
  CHECK(guess.toml.find("#   a") != std::string::npos);
}

}  // namespace guess_test
