// The moments that a page shows in 3D: which they are, what is drawn of robot and world, and how they are given on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "gap/diagnose/page/moment_view.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "tests/gap/diagnose/drawn_diagnosis.hpp"
#include "tests/gap/well_formed.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using namespace kenaf::test;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

Vector3d middle(const std::vector<Face>& faces) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const Face& face : faces)
    for (const Vector3d& corner : face.corners_m) sum += corner, ++count;
  return sum / count;
}

// Whether every face of a convex part has its corners counterclockwise seen from outside.
bool look_outwards(const std::vector<Face>& faces) {
  const Vector3d centre = middle(faces);
  return std::ranges::all_of(faces, [&](const Face& face) {
    const auto& c = face.corners_m;
    return (c[1] - c[0]).cross(c[2] - c[0]).dot(c[0] - centre) > 0;
  });
}

std::pair<Vector3d, Vector3d> bounds(const std::vector<Face>& faces) {
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (const Face& face : faces)
    for (const Vector3d& corner : face.corners_m) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  return {low, high};
}

}  // namespace

TEST_CASE("Moments are the worst of all and those of the phases with most of the gap, each once, worst first") {
  const Diagnosis d = drawn_diagnosis();
  const std::vector<Overlay> overlays = drawn_overlays(d);
  const std::vector<Moment> moments = moments_of(d, overlays);
  // 51 % of the whole gap is the climb's in the drive, 27 % the cruise's in the body, 22 % the cruise's in the drive;
  // a run has one worst moment in a phase, whatever the stage
  REQUIRE(moments.size() == 2);
  const Moment& climb = moments[0];
  CHECK(climb.stage == 0);
  CHECK(climb.group == 1);
  CHECK(climb.at_s == 1.375);  // the middle of the span in which the nominal robot is farthest off
  CHECK(climb.is_worst_of_run);
  // two of at most three samples in it: 0.25 m/s of 0.01 m/s by the root of 2 / 3
  const ChannelMoment& most = climb.gap.channels.front();
  CHECK(most.channel == channel("track_left_mps"));
  CHECK(most.measured == Approx(0.5));
  CHECK(most.simulated == Approx(0.75));
  CHECK(most.difference() == Approx(-0.25));
  CHECK(most.times_noise == Approx(25 * std::sqrt(2.0 / 3)));
  CHECK(climb.gap.times_noise > moments[1].gap.times_noise);
  CHECK(moments[1].stage == 1);
  CHECK(moments[1].group == 0);

  // 1.5 s around it, but no longer than the run of 2 s: 25 pictures a second
  REQUIRE(climb.times_s.size() == 51);
  CHECK(climb.times_s.back() == Approx(2));
  CHECK(climb.times_s[climb.now] == Approx(1.36));
  REQUIRE(climb.bodies.size() == 3);
  const RobotPose &real = *climb.bodies[0].poses[climb.now], &nominal = *climb.bodies[1].poses[climb.now];
  CHECK(real.p_WB_m.x() == Approx(0.68));  // at 0.5 m/s
  CHECK(nominal.p_WB_m.x() == Approx(0.78));
  CHECK(nominal.angles_rad.z() == 0.1);
  CHECK(climb.bodies[2].kind == "corrected");
  CHECK(climb.bodies[2].poses[climb.now]->p_WB_m.x() == Approx(0.69));

  // links: its own moment, one of another stage in the same phase, or else the run
  CHECK(link_to_phase(d, moments, 0, d.stages[0].where.phases[0]) == "#moment-1");
  CHECK(link_to_phase(d, moments, 1, d.stages[1].where.phases[0]) == "#moment-2");
  CHECK(link_to_phase(d, moments, 0, d.stages[0].where.phases[1]) == "#moment-2");
  CHECK(link_to_phase(d, std::span(moments).first(1), 0, d.stages[0].where.phases[1]) == "#run-1");
  CHECK(link_to_phase(d, {}, 0, d.stages[0].where.phases[0]) == "#run-2");
}

TEST_CASE("The worst moment of all is shown also where the phases with most of the gap are elsewhere") {
  Diagnosis d = drawn_diagnosis();
  // all of the gap is in the cruise of the other run, and nothing in the climb
  for (StageDiagnosis& stage : d.stages)
    std::erase_if(stage.where.phases, [](const PhaseGap& phase) { return phase.group == 1; });
  const std::vector<Moment> moments = moments_of(d, drawn_overlays(d));
  REQUIRE(moments.size() == 2);
  CHECK(moments[0].group == 1);
  CHECK(moments[0].at_s == 1.375);
  CHECK_FALSE(moments[0].phase);
  CHECK(fault_of_xml(diagnosis_page(d, drawn_overlays(d))).empty());
}

TEST_CASE("A moment tells what was measured and simulated in the channels that differ most, and by how much") {
  const Diagnosis d = drawn_diagnosis();
  const std::string page = diagnosis_page(d, drawn_overlays(d), "out");
  CHECK_THAT(page, Contains("<li>track_left_mps: measured 0.500 m/s, simulated 0.750 m/s, difference -0.250 m/s (20 "
                            "\u00d7 noise)</li>"));
  CHECK_THAT(page,
             Contains("of run-002.csv: ") && Contains("\u00d7 noise, rms of all channels, the worst moment of the "
                                                      "runs drawn here. The phase has 70 % of the gap from "
                                                      "command to drive"));
}

TEST_CASE("A run without a measured pose has no moment, and one without a gap neither") {
  Diagnosis d = drawn_diagnosis();
  for (Observation& run : d.observations.runs)
    std::ranges::replace(run.run.columns, std::string("yaw_rad"), std::string("heading"));
  const std::vector<Overlay> overlays = drawn_overlays(d);
  CHECK(moments_of(d, overlays).empty());
  CHECK_THAT(diagnosis_page(d, overlays), Contains("no measured pose") && Contains("href=\"#run-2\""));
  d = made_without_gap();
  CHECK(moments_of(d, drawn_overlays(d)).empty());
}

TEST_CASE("A time half way between two hundredths is rounded up, as in the playback") {
  CHECK(time_in_words(2.625) == "2.63 s");
  CHECK(time_in_words(5.375) == "5.38 s");
  CHECK(play_command(drawn_diagnosis(), "a.csv", 2.625, "").ends_with(" --at 2.63"));
}

TEST_CASE("The command for a whole run can be given to a shell as it is") {
  Diagnosis d = drawn_diagnosis();
  CHECK(play_command(d, "run-002.csv", 1.375, "out") ==
        "kenaf-gap play 'real runs' --report out --run run-002.csv --at 1.38");
  d.folder = "-x";
  d.options.robot = "it's.toml";
  CHECK(play_command(d, "a;b.csv", 0, "") == "kenaf-gap play ./-x --robot 'it'\\''s.toml' --run 'a;b.csv' --at 0.00");
}

TEST_CASE("A robot's faces look outwards, and its flippers turn tip up") {
  const physics::RobotDimensions kenaf = physics::dimensions_of(physics::load_robot("kenaf"));
  const RobotFaces robot = faces_of(kenaf);
  CHECK(look_outwards({robot.fixed.begin(), robot.fixed.begin() + 6}));  // the hull, a box
  CHECK(look_outwards(robot.flipper));
  const auto [low, high] = bounds({robot.fixed.begin(), robot.fixed.begin() + 6});
  CHECK((high - low - kenaf.body_size_m).norm() == Approx(0).margin(1e-12));

  // the front ones up, the rear ones straight back; level at 1 m and turned left by a quarter, so ahead is y
  const double reach_m = kenaf.flipper_length_m + kenaf.tip_radius_m;
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto [least, most] = bounds(faces_in_pose(robot, {0, 0, 1}, {0, 0, kQuarter}, {kQuarter, kQuarter, 0, 0}));
  CHECK(most.z() == Approx(1 + kenaf.p_BPivot_m.z() + reach_m));
  CHECK(least.y() == Approx(-kenaf.p_BPivot_m.x() - reach_m));
}

TEST_CASE("Of the world only what is near is drawn, and of a large mesh only the nearest") {
  physics::WorldDescription world;
  world.planes.push_back({});
  world.boxes.push_back({"step", {1, 1, 0.2}, {{1, 0, 0.1}, Eigen::Quaterniond::Identity()}});
  world.boxes.push_back({"far", {1, 1, 1}, {{9, 0, 0.5}, Eigen::Quaterniond::Identity()}});
  world.boxes.push_back({"pushed", {1, 1, 1}, {{0, 0, 0.5}, Eigen::Quaterniond::Identity()}, 1, 5});
  world.meshes.push_back({"sheet",
                          {{0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {50, 1, 0}, {51, 1, 0}, {50, 2, 0}, {0.5, 0, 0}},
                          {{0, 1, 2}, {3, 4, 5}, {0, 6, 1}}});
  const WorldFaces all = faces_near(world, {0, 0, 0}, 2.5, 10);
  CHECK(all.is_whole);
  CHECK(all.solids.size() == 6 + 2);
  CHECK(look_outwards({all.solids.begin(), all.solids.begin() + 6}));
  CHECK(all.ground.size() > 80);  // a disc of 2.5 m in squares of 0.5 m: 79 and those at its edge
  const WorldFaces nearest = faces_near(world, {0, 0, 0}, 2.5, 1);
  CHECK_FALSE(nearest.is_whole);
  REQUIRE(nearest.solids.size() == 7);
  CHECK(nearest.solids.back().corners_m[1].isApprox(Vector3d(0.5, 0, 0)));
}

TEST_CASE("A moment is a still picture, and data for the player") {
  const Diagnosis d = drawn_diagnosis();
  const std::vector<Overlay> overlays = drawn_overlays(d);
  const std::vector<Moment> moments = moments_of(d, overlays);
  const RobotFaces robot = faces_of(physics::dimensions_of(d.observations.robot));
  const std::string still = moment_still(moments[0], robot, {}, "up & <over>");
  CHECK(fault_of_xml(still) == "");
  CHECK_THAT(still, Contains("<g class=\"real\">") && Contains("<g class=\"nominal\">") &&
                        Contains("<g class=\"corrected\">") && Contains("up &amp; &lt;over&gt;"));

  const auto data = nlohmann::json::parse(moment_data(moments[0], robot, {}));
  CHECK(data["from"] == 0);
  CHECK(data["step"] == 0.04);
  CHECK(data["now"] == 34);
  REQUIRE(data["bodies"].size() == 3);
  // relative to the real robot at the moment: 0.1 m ahead in 0.1 mm, turned by 0.1 rad in 0.1 mrad
  CHECK(data["bodies"][0]["poses"][34] == nlohmann::json{0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  CHECK(data["bodies"][1]["poses"][34] == nlohmann::json{1000, 0, 0, 0, 0, 1000, 0, 0, 0, 0});
  const auto shape = nlohmann::json::parse(robot_data(robot));
  CHECK(shape["fixed"][0][0] == "hull");
  CHECK(shape["flipper"].size() > 10);

  const std::string page = diagnosis_page(d, overlays, "out");
  CHECK(fault_of_xml(page).empty());
  CHECK_THAT(page, Contains("<a href=\"#moment-1\">climb</a>") && Contains("id=\"moment-1\""));
  CHECK_THAT(page, Contains("<a href=\"#moment-1\"><circle"));
  CHECK_THAT(page, Contains("kenaf-gap play 'real runs' --report out --run run-002.csv --at 1.38"));
  CHECK_THAT(page, Contains("Nominal and real robot: 100 mm and 5.7 degrees apart; corrected and real robot: 10 mm and "
                            "0.0 degrees apart."));
}
