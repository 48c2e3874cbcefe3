// Which numbers may be the cause of a gap, how far each may go, and what it changes.
#include <catch2/catch.hpp>
#include <set>

#include "gap/candidates/robot_numbers.hpp"
#include "tests/gap/candidates/robots.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using physics::RobotDescription;
using test::find_candidate;
using test::robot_of;
using test::with;

namespace {

constexpr const char* kRobots[] = {"kenaf", "marmotte", "p2at", "p2dx"};

double max_in_catalogue(std::string_view effect) {
  return physics::find_effect(effect)->parameters.front().max;
}

// The largest value of an effect that is searched for a robot of that name.
double max_for(const std::string& robot, std::string_view effect) {
  return find_candidate(catalogue_candidates(robot_of(robot), true), effect)->max;
}

}  // namespace

TEST_CASE(
    "Every candidate has a name of its own, a range around its present value, and leaves the robot as it is there") {
  for (const char* name : kRobots) {
    const RobotDescription robot = robot_of(name);
    std::set<std::string> names;
    for (const Candidate& candidate : test::all_candidates(robot)) {
      CAPTURE(name, candidate.name);
      CHECK(names.insert(candidate.name).second);
      CHECK(candidate.min < candidate.max);
      CHECK((candidate.min <= candidate.neutral && candidate.neutral <= candidate.max));
      CHECK((candidate.min <= candidate.present && candidate.present <= candidate.max));
      CHECK_FALSE(candidate.unit.empty());
      CHECK_FALSE(candidate.summary.empty());
      CHECK_FALSE(candidate.keys.empty());
      CHECK(test::same_bits(with(robot, candidate, candidate.present), robot));
    }
  }
}

TEST_CASE("At both ends of every range there is such a robot, and it is another one") {
  for (const char* name : kRobots) {
    const RobotDescription robot = robot_of(name);
    for (const Candidate& candidate : test::all_candidates(robot))
      for (const double end : {candidate.min, candidate.max}) {
        CAPTURE(name, candidate.name, end);
        const RobotDescription varied = with(robot, candidate, end);
        CHECK(why_impossible(varied) == "");
        CHECK(test::same_bits(varied, robot) == (end == candidate.present));
      }
  }
}

TEST_CASE("Belts keep a straight run, and tracks stay apart, when all of their numbers are at their far ends at once") {
  const std::string short_ends[] = {"track.length_m", "track.separation_m", "flipper.length_m", "flipper.tip_radius_m"};
  const std::string long_ends[] = {"track.end_radius_m", "track.width_m", "flipper.pivot_radius_m"};
  for (const char* name : kRobots) {
    RobotDescription robot = robot_of(name);
    const std::vector<Candidate> candidates = description_candidates(robot);
    for (const std::string& key : short_ends)
      if (const Candidate* candidate = find_candidate(candidates, key)) candidate->set(robot, candidate->min);
    for (const std::string& key : long_ends)
      if (const Candidate* candidate = find_candidate(candidates, key)) candidate->set(robot, candidate->max);
    CAPTURE(name);
    CHECK(why_impossible(robot) == "");
  }
}

TEST_CASE("Forces, lags and lengths are searched as far as they make sense for a robot of this size") {
  // Kenaf: 20 kg, 0.58 m, 0.5 m/s. 5 N and 10 N s/m for a kilogram, 5 s from rest to full speed, 0.15 of the length
  CHECK(max_for("kenaf", "drive_coulomb") == Approx(100));
  CHECK(max_for("kenaf", "drive_viscous") == Approx(200));
  CHECK(max_for("kenaf", "command_slew") == Approx(10));
  CHECK(max_for("kenaf", "com_forward") == Approx(0.087));
  // Marmotte: 52 kg, 0.62 m, 2 m/s
  CHECK(max_for("marmotte", "drive_coulomb") == Approx(std::min(260.0, max_in_catalogue("drive_coulomb"))));
  CHECK(max_for("marmotte", "com_forward") == Approx(std::min(0.093, max_in_catalogue("com_forward"))));
  CHECK(max_for("marmotte", "command_slew") == Approx(2.5));
  CHECK(max_for("marmotte", "command_delay") == Approx(std::min(0.6, max_in_catalogue("command_delay"))));
  CHECK(max_for("marmotte", "drive_lag") == Approx(std::min(2.0, max_in_catalogue("drive_lag"))));
  for (const char* name : kRobots)
    for (const Candidate& candidate : catalogue_candidates(robot_of(name), true)) {
      const physics::EffectParameter* parameter =
          physics::find_parameter(*physics::find_effect(candidate.effect), candidate.parameter);
      CAPTURE(candidate.name);
      CHECK((candidate.min >= parameter->min && candidate.max <= parameter->max));
    }
}

TEST_CASE("Only effects that the robot can show are candidates, and none that is chance") {
  const auto has = [](const RobotDescription& robot, bool has_obstacles, std::string_view name) {
    return find_candidate(catalogue_candidates(robot, has_obstacles), name) != nullptr;
  };
  const RobotDescription kenaf = robot_of("kenaf"), marmotte = robot_of("marmotte");
  CHECK_FALSE(has(kenaf, true, "command_loss"));
  CHECK(has(kenaf, true, "flipper_lag"));
  CHECK_FALSE(has(marmotte, true, "flipper_lag"));
  CHECK(has(kenaf, true, "lug_height"));
  CHECK_FALSE(has(marmotte, true, "lug_height"));  // described without lugs
  CHECK(has(marmotte, true, "shear_deformation"));
  CHECK_FALSE(has(robot_of("husky"), true, "shear_deformation"));  // wheels have no known length of contact
  CHECK(has(marmotte, true, "obstacle_height"));
  CHECK_FALSE(has(marmotte, false, "obstacle_height"));
  RobotDescription blind = marmotte;
  blind.sensors.clear();
  CHECK(has(marmotte, false, "posture_delay"));
  CHECK_FALSE(has(blind, false, "posture_delay"));
  CHECK_FALSE(has(blind, false, "encoder_scale"));
}

TEST_CASE("An effect that is switched on in the description is there at present, and may go back to neutral") {
  RobotDescription robot = robot_of("marmotte");
  robot.effects.command_slew_s2pm = 8;  // beyond what is searched for it
  const std::vector<Candidate> candidates = catalogue_candidates(robot, false);
  const Candidate* slew = find_candidate(candidates, "command_slew");
  REQUIRE(slew);
  CHECK(slew->present == 8);
  CHECK(slew->neutral == 0);
  CHECK(slew->max == 8);
  CHECK(test::same_bits(with(robot, *slew, 0), robot_of("marmotte")));
}

TEST_CASE("The tracks' separation moves the planes of both tracks") {
  // Kenaf's are 0.2 m apart, the left one 0.1 m left
  const RobotDescription robot = robot_of("kenaf");
  const std::vector<Candidate> candidates = description_candidates(robot);
  const Candidate* separation = find_candidate(candidates, "track.separation_m");
  REQUIRE(separation);
  CHECK(separation->present == Approx(0.2));
  CHECK(separation->parameter == "separation_m");
  CHECK(separation->keys == std::vector<std::string>{"track.left_center_m[1]"});
  const RobotDescription wider = with(robot, *separation, 0.3);
  CHECK(wider.track.front().p_BT_m.y() == 0.15);
  CHECK(wider.track_gauge_m() == 0.3);
  CHECK(wider.track.front().p_BT_m.x() == robot.track.front().p_BT_m.x());
}

TEST_CASE("The belly gets shorter with the track, whose ends keep their radius") {
  // Kenaf: 0.58 m over ends of 0.065 m, so 0.45 m flat
  const RobotDescription robot = robot_of("kenaf");
  const std::vector<Candidate> candidates = description_candidates(robot);
  const Candidate* belly = find_candidate(candidates, "track.contact_length_m");
  REQUIRE(belly);
  CHECK(belly->present == Approx(0.45));
  CHECK(belly->same_as == "track.length_m");
  const RobotDescription shorter = with(robot, *belly, 0.35);
  CHECK(shorter.track.front().length_m == Approx(0.48));
  CHECK(shorter.track.front().end_radius_m == robot.track.front().end_radius_m);
}

TEST_CASE("The belly as it is described leaves the track as it is, though its length is not the sum of its parts") {
  RobotDescription robot = robot_of("kenaf");
  robot.track.front().length_m = 0.9;
  robot.track.front().end_radius_m = 0.1;
  const double flat_m = robot.track.front().length_m - 2 * robot.track.front().end_radius_m;
  REQUIRE(flat_m + 2 * robot.track.front().end_radius_m != robot.track.front().length_m);  // in floating point
  const std::vector<Candidate> candidates = description_candidates(robot);
  CHECK(test::same_bits(with(robot, *find_candidate(candidates, "track.contact_length_m"), flat_m), robot));
}

TEST_CASE("A moment of inertia is searched as far as a rigid body can have it") {
  // Kenaf: 0.13, 0.44, 0.52. About z at most 0.13 + 0.44, at least 0.44 - 0.13; about x half of 0.13 would be less than
  // 0.52 - 0.44
  const std::vector<Candidate> candidates = description_candidates(robot_of("kenaf"));
  CHECK(find_candidate(candidates, "body.inertia_kgm2[2]")->max == Approx(0.57));
  CHECK(find_candidate(candidates, "body.inertia_kgm2[2]")->min == Approx(0.31));
  CHECK(find_candidate(candidates, "body.inertia_kgm2[0]")->min == Approx(0.08));
  CHECK(find_candidate(candidates, "body.inertia_kgm2[0]")->max == Approx(0.26));
}

TEST_CASE("A number of the description names the effect that does the same, where that moves nothing else") {
  const std::vector<Candidate> kenaf = description_candidates(robot_of("kenaf"));
  const std::vector<Candidate> marmotte = description_candidates(robot_of("marmotte"));
  CHECK(find_candidate(kenaf, "body.mass_kg")->same_as == "mass");
  CHECK(find_candidate(kenaf, "drive.max_force_n")->same_as == "drive_torque_limit");
  CHECK(find_candidate(kenaf, "sensor[INS].delay_s")->same_as == "posture_delay");
  CHECK(find_candidate(kenaf, "track.separation_m")->same_as == "");
  // friction_along is of all belts: Kenaf's flippers have some of their own
  CHECK(find_candidate(kenaf, "track.friction_along")->same_as == "");
  CHECK(find_candidate(kenaf, "track.friction_along")->part_of == "friction_along");
  CHECK(find_candidate(marmotte, "track.friction_along")->part_of == "");
  CHECK(find_candidate(marmotte, "track.friction_along")->same_as == "friction_along");
  // there are no lugs that an effect could multiply
  CHECK(find_candidate(kenaf, "track.lug_height_m")->same_as == "lug_height");
  CHECK(find_candidate(marmotte, "track.lug_height_m")->same_as == "");
  // of flippers' belts too, like the effect
  CHECK(find_candidate(kenaf, "track.shear_deformation_m")->same_as == "shear_deformation");
}

TEST_CASE("An effect that is kept in a number's place says by how much it is off where the number is") {
  const RobotDescription robot = robot_of("kenaf");
  const std::vector<Candidate> kept = leave_out(all_candidates(robot, true), {});
  const auto whole = [&](std::string_view name) { return find_candidate(kept, name)->whole; };
  CHECK(whole("mass") == 1);                                               // a ratio
  CHECK(whole("battery.open_circuit_v") == robot.battery.open_circuit_v);  // the number itself
  CHECK(whole("gyro_delay") == 0.2);                                       // 0 s now
  CHECK(whole("com_forward") > 0.1);                                       // 0 m now, searched that far
  CHECK(whole("command_slew") == 0);                                       // no number of the description
  CHECK(find_candidate(kept, "body.mass_kg") == nullptr);
}

TEST_CASE("Numbers are those of what the robot has, and of the sensors that are recorded") {
  RobotDescription robot = robot_of("marmotte");
  physics::SensorDescription second{};
  second.type = physics::SensorType::imu;
  second.name = "IMU2";
  robot.sensors.push_back(second);
  const std::vector<Candidate> candidates = description_candidates(robot);
  CHECK(find_candidate(candidates, "sensor[IMU].delay_s"));
  CHECK_FALSE(find_candidate(candidates, "sensor[IMU2].delay_s"));
  CHECK_FALSE(find_candidate(candidates, "sensor[GroundTruth].delay_s"));
  CHECK_FALSE(find_candidate(candidates, "flipper.mass_kg"));
  CHECK_FALSE(find_candidate(candidates, "servo.max_torque_nm"));
  // a simulated robot may have fewer sensors than the described one
  robot.sensors.clear();
  find_candidate(candidates, "sensor[IMU].delay_s")->set(robot, 0.1);
  CHECK(robot.sensors.empty());
}

TEST_CASE("What multiplies a number that is 0 is no candidate") {
  RobotDescription robot = robot_of("marmotte");
  robot.drive.amperes_per_newton = 0;
  CHECK_FALSE(find_candidate(description_candidates(robot), "drive.amperes_per_newton"));
}
