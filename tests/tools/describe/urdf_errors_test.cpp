// What cannot be is named, with its link or joint: each case is the small URDF with one thing wrong.
#include <catch2/catch.hpp>

#include "formats/description/description_error.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/tools/describe/small_urdf.hpp"
#include "tools/describe/from_urdf.hpp"

using namespace kenaf;
using test::kSmallUrdf;
using test::replaced;
using test::with;

namespace {

std::string complaint_about(const std::string& urdf, const describe::FromUrdfOptions& options = {}) {
  try {
    describe::from_urdf(urdf, "robot.urdf", options);
  } catch (const description::DescriptionError& error) {
    return error.what();
  }
  return "none";
}

void check_complaint(const std::string& urdf, const std::vector<std::string>& words) {
  const std::string complaint = complaint_about(urdf);
  CHECK_THAT(complaint, Catch::StartsWith("robot.urdf:"));
  for (const std::string& word : words) CHECK_THAT(complaint, Catch::Contains(word));
}

const std::string kWheelInertia = R"(ixx="0.0014" ixy="0" ixz="0" iyy="0.0025" iyz="0" izz="0.0014")";
const std::string kWheelShape =
    "<collision><origin rpy='1.5707963267948966 0 0'/><geometry><cylinder radius='0.1' "
    "length='0.04'/></geometry></collision>";
const std::string kInertial =
    "<inertial><mass value='0.5'/><inertia ixx='0.0014' ixy='0' ixz='0' iyy='0.0025' iyz='0' izz='0.0014'/></inertial>";

std::string link(const std::string& name, const std::string& shapes = "") {
  return "<link name='" + name + "'>" + kInertial + shapes + "</link>";
}

std::string joint(const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
  return "<joint name='" + child + "_j' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
         "'/>" + more + "</joint>";
}

}  // namespace

TEST_CASE("The small URDF is right") {
  CHECK(complaint_about(kSmallUrdf) == "none");
}

TEST_CASE("Masses that cannot be") {
  check_complaint(replaced(kSmallUrdf, "mass value=\"0.5\"", "mass value=\"-0.5\""),
                  {"link \"left_wheel\"", "mass of -0.5 kg"});
  check_complaint(replaced(kSmallUrdf, "mass value=\"0.5\"", "mass value=\"0\""),
                  {"link \"left_wheel\"", "joint \"left_axle\"", "no mass", "add an <inertial>"});
  const std::string without =
      replaced(kSmallUrdf, "<inertial><mass value=\"0.5\"/><inertia " + kWheelInertia + "/></inertial>", "");
  check_complaint(without, {"link \"left_wheel\"", "no mass"});
  std::string nothing = replaced(kSmallUrdf, "mass value=\"4\"", "mass value=\"0\"");
  nothing = replaced(nothing, "type=\"continuous\"", "type=\"fixed\"");
  CHECK_THAT(complaint_about(nothing), !Catch::Contains("base_link\" moves"));  // a fixed link may be without
}

TEST_CASE("Inertias that no rigid body has") {
  check_complaint(
      replaced(kSmallUrdf, kWheelInertia, R"(ixx="0.001" ixy="0" ixz="0" iyy="0.0025" iyz="0" izz="0.001")"),
      {"link \"left_wheel\"", "no rigid body", "0.001, 0.001 and 0.0025", "sum of the two others"});
  check_complaint(
      replaced(kSmallUrdf, kWheelInertia, R"(ixx="0.001" ixy="0" ixz="0" iyy="-0.001" iyz="0" izz="0.001")"),
      {"link \"left_wheel\"", "0 or less"});
  check_complaint(
      replaced(kSmallUrdf, kWheelInertia, R"(ixx="0.001" ixy="0.002" ixz="0" iyy="0.001" iyz="0" izz="0.001")"),
      {"link \"left_wheel\"", "-0.001"});
}

TEST_CASE("Numbers that are none, with their line") {
  check_complaint(replaced(kSmallUrdf, "xyz=\"0.1 0.2 0\"", "xyz=\"0.1 nan 0\""),
                  {"robot.urdf:12: joint \"left_axle\"", "xyz=\"0.1 nan 0\"", "3 finite numbers"});
  check_complaint(replaced(kSmallUrdf, "xyz=\"0.1 0.2 0\"", "xyz=\"0.1 inf 0\""), {"joint \"left_axle\"", "finite"});
  check_complaint(replaced(kSmallUrdf, "xyz=\"0.1 0.2 0\"", "xyz=\"0.1 1e999 0\""), {"joint \"left_axle\"", "finite"});
  check_complaint(replaced(kSmallUrdf, "xyz=\"0.1 0.2 0\"", "xyz=\"0.1 1e99 0\""), {"joint \"left_axle\"", "metres"});
  check_complaint(replaced(kSmallUrdf, "xyz=\"0.1 0.2 0\"", "xyz=\"0.1 0.2\""),
                  {"joint \"left_axle\"", "3 finite numbers"});
  check_complaint(replaced(kSmallUrdf, "mass value=\"4\"", "mass value=\"four\""), {"link \"base_link\"", "four"});
  check_complaint(replaced(kSmallUrdf, "radius=\"0.1\"", "radius=\"0\""),
                  {"link \"left_wheel\"", "radius or length of 0"});
  check_complaint(replaced(kSmallUrdf, "axis xyz=\"0 1 0\"", "axis xyz=\"0 0 0\""),
                  {"joint \"left_axle\"", "axis of length 0"});
}

TEST_CASE("Links that are no tree") {
  check_complaint(replaced(kSmallUrdf, "parent link=\"base_link\"", "parent link=\"chassis\""),
                  {"joint \"left_axle\"", "parent \"chassis\" is no link", "<link name=\"chassis\"/>"});
  check_complaint(replaced(kSmallUrdf, "<child link=\"left_wheel\"/>", ""), {"joint \"left_axle\"", "no <child"});
  check_complaint(with(link("a") + link("b") + joint("fixed", "a", "b") + joint("fixed", "b", "a")),
                  {"loop of joints", "\"a_j\""});
  check_complaint(with("<joint name='second' type='fixed'><parent link='left_wheel'/><child link='ball'/></joint>"),
                  {"\"ball_joint\"", "\"second\"", "both lead to link \"ball\""});
  check_complaint(with("<link name='lost'/>"), {"without a parent", "\"base_link\", \"lost\""});
  check_complaint(with("<link name='ball'/>"), {"link \"ball\" was already on line"});
  check_complaint(with("<joint name='left_axle' type='fixed'/>"), {"joint \"left_axle\" was already on line"});
  check_complaint(with("<link/>"), {"a <link> has no name"});
  check_complaint("<robot name='r'/>", {"no link"});
  check_complaint(with(link("x") + joint("hinged", "base_link", "x")), {"x_j"});  // of liburdfdom
  check_complaint(with(link("x") + joint("revolute", "base_link", "x", "<axis xyz='0 1 0'/>")), {"x_j", "limits"});
}

TEST_CASE("Files that are no URDF") {
  check_complaint("", {"well-formed"});
  check_complaint("<robot", {"robot.urdf:1:", "well-formed"});
  check_complaint("<sdf version='1.6'/>", {"root is <sdf>"});
  check_complaint("<robot xmlns:xacro='x'><xacro:include filename='a'/></robot>", {"xacro", "run `xacro"});
  check_complaint("<!DOCTYPE robot [<!ENTITY a 'b'>]><robot/>", {"document type"});
  check_complaint("<?xml version='1.0' encoding='UTF-16'?><robot/>", {"encoding"});
  check_complaint(std::string("<robot>\0</robot>", 17), {"zero byte"});
  check_complaint(std::string(9 << 20, ' '), {"larger than"});
  std::string deep = "<robot>";
  for (int i = 0; i < 60; ++i) deep += "<a>";
  check_complaint(deep, {"nested more than 50 deep"});
  check_complaint(with("<link name='" + std::string(300, 'a') + "'/>"), {"longer than"});
}

TEST_CASE("Running gear that a description does not have") {
  // steering: a fork that turns about z above each wheel
  std::string steered =
      with(link("fork") + joint("revolute", "base_link", "fork",
                                "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>"));
  steered = replaced(steered, "parent link=\"base_link\"", "parent link=\"fork\"", "left_axle");
  check_complaint(steered, {"joint \"fork_j\" steers wheel \"left_wheel\"", "do not steer"});
  check_complaint(replaced(kSmallUrdf, "axis xyz=\"0 1 0\"", "axis xyz=\"0.7 0.7 0\""),
                  {"joint \"left_axle\"", "\"left_wheel\"", "(0.707 0.707 0)", "mecanum"});
  std::string mecanum = kSmallUrdf;
  for (int i = 0; i < 3; ++i)
    mecanum = replaced(mecanum, "</robot>",
                       link("roller" + std::to_string(i), kWheelShape) +
                           joint("continuous", "left_wheel", "roller" + std::to_string(i), "<axis xyz='1 1 0'/>") +
                           "</robot>");
  check_complaint(mecanum, {"wheel \"left_wheel\"", "3 links that turn on it"});
  check_complaint(
      with("<link name='left_track'><collision><geometry><box size='1 0.1 0.1'/></geometry></collision></link>" +
           joint("fixed", "base_link", "left_track")),
      {"tracks (\"left_track\") and wheels (\"left_wheel\")", "--tracks"});
  std::string neither = replaced(kSmallUrdf, "type=\"continuous\"", "type=\"fixed\"");
  check_complaint(replaced(neither, "type=\"continuous\"", "type=\"fixed\""),
                  {"neither wheels", "left_wheel, right_wheel", "--wheels"});
  check_complaint(replaced(kSmallUrdf, "rpy=\"1.5707963267948966 0 0\"", "rpy=\"0 0 0\""),
                  {"wheel \"left_wheel\"", "along the axle"});
  check_complaint(replaced(kSmallUrdf, "<box size=\"0.4 0.3 0.1\"/>", "<mesh filename=\"a.stl\"/>"),
                  {"base_link", "a.stl"});
  describe::FromUrdfOptions options;
  options.choice.wheels = "(";
  CHECK_THAT(complaint_about(kSmallUrdf, options), Catch::Contains("--wheels '(' is no regular expression"));
}

TEST_CASE("Sides that are no mirror images, and by how much") {
  check_complaint(replaced(kSmallUrdf, "0.1 -0.2 0", "0.11 -0.2 0"),
                  {"\"left_wheel\" and \"right_wheel\"", "x by 10 mm (0.1 and 0.11 m)", "--tolerance"});
  check_complaint(replaced(kSmallUrdf, "radius=\"0.1\"", "radius=\"0.12\""), {"radius by 20 mm"});
  check_complaint(with(link("third_wheel", kWheelShape) + joint("continuous", "base_link", "third_wheel",
                                                                "<origin xyz='-0.1 0.2 0'/><axis xyz='0 1 0'/>")),
                  {"2 wheels on the left and 1 on the right"});
  check_complaint(
      with(link("inner_left_wheel", kWheelShape) +
           joint("continuous", "base_link", "inner_left_wheel", "<origin xyz='0.1 0.1 0'/><axis xyz='0 1 0'/>") +
           link("inner_right_wheel", kWheelShape) +
           joint("continuous", "base_link", "inner_right_wheel", "<origin xyz='0.1 -0.1 0'/><axis xyz='0 1 0'/>")),
      {"side by side"});
}

TEST_CASE("Flippers that are not four, or not alike") {
  const std::string urdf = test::read_file(KENAF_SOURCE_DIR "/tests/tools/describe/urdf/flippers.urdf");
  check_complaint(replaced(replaced(urdf, "ctu/rear_right_flipper", "ctu/tail"), "ctu/rear_right_flipper", "ctu/tail"),
                  {"ctu/front_left_flipper", "has four"});
  check_complaint(replaced(urdf, "xyz=\"0.33 0 0\"", "xyz=\"0.35 0 0\""),
                  {"ctu/front_left_flipper", "length by 20 mm"});
  check_complaint(replaced(urdf, "lower=\"-1.5\"", "lower=\"-1.4\""), {"the upper limit by 0.1 rad"});
  check_complaint(replaced(urdf, "mass value=\"0.75\"", "mass value=\"0.85\""), {"mass by 0.1 kg"});
  check_complaint(replaced(urdf, "<axis xyz=\"0 1 0\"/>\n    <limit effort=\"50\"",
                           "<axis xyz=\"1 0 0\"/>\n    <limit effort=\"50\""),
                  {"front_left_flipper_j", "not about y"});
}
