// Every effect, half way to an end of its range, shows in what is recorded of some manoeuvre: in the channel that its
// physics says, beyond five times the noise of that channel. At its neutral value it changes no bit of any column.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "rollout/roll_out.hpp"

using namespace kenaf;
using namespace kenaf::rollout;

namespace {

enum Scene { turning, lifting, stepping, gripping, rolling, falling };

// Flippers as the robot carries them, or those of the front and the rear.
Phase phase(double left_mps, double right_mps, double time_s, double front_rad = 1, double rear_rad = 1) {
  return {.name = "",
          .track_mps = {left_mps, right_mps},
          .flipper_rad = std::array{front_rad, front_rad, rear_rad, rear_rad},
          .at_most_s = time_s,
          .end = {}};
}

Manoeuvre manoeuvre_of(Scene scene) {
  Manoeuvre manoeuvre;
  switch (scene) {
    case turning:
      manoeuvre.phases = {phase(0.4, 0.4, 0.5), phase(-0.3, 0.3, 1), phase(0.1, 0.4, 0.5)};
      break;
    case lifting:  // from where they are carried, front flippers lift the nose, then let it down again
      manoeuvre.phases = {phase(0, 0, 0.1), phase(0, 0, 1.8, -0.8), phase(0, 0, 0.7, 0)};
      break;
    case stepping:
    case gripping:
    case rolling:
      manoeuvre.phases = {phase(0.4, 0.4, 2.5)};
      break;
    case falling:
      manoeuvre.start_lift_m = 0.03;
      manoeuvre.phases = {phase(0, 0, 0.3)};
      break;
  }
  return manoeuvre;
}

physics::WorldDescription world_of(Scene scene) {
  physics::WorldDescription world;
  world.planes.push_back({});
  world.start_poses.push_back({"start", {}});
  const auto add = [&world](const Eigen::Vector3d& size_m, const Eigen::Vector3d& center_m) {
    world.boxes.push_back({"box", size_m, {center_m, Eigen::Quaterniond::Identity()}, 1, 0});
  };
  if (scene == stepping) add({2, 2, 0.06}, {1.4, 0, 0.03});       // both tracks
  if (scene == gripping) add({2, 2, 0.15}, {1.4, 0, 0.075});      // as high as the tracks, which have to hold its edge
  if (scene == rolling) add({0.1, 0.2, 0.04}, {0.5, 0.1, 0.02});  // the left track, which then falls off
  return world;
}

RollOut run_of(Scene scene, const physics::Effects& effects) {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.effects = effects;
  RollOutOptions options;
  options.physics.time_step_s = 0.005;
  options.noise_scale = 0;
  return roll_out(robot, world_of(scene), manoeuvre_of(scene), options);
}

const RollOut& nominal_run_of(Scene scene) {
  static const std::map<Scene, RollOut> runs = [] {
    std::map<Scene, RollOut> all;
    for (const Scene each : {turning, lifting, stepping, gripping, rolling, falling}) all[each] = run_of(each, {});
    return all;
  }();
  return runs.at(scene);
}

// A resolution of current, voltage and servo angle that any drive has: those columns have no noise.
double noise_of(const std::string& column) {
  static const auto noise = column_noise(physics::load_robot("kenaf"), {});
  if (const auto found = noise.find(column); found != noise.end()) return found->second;
  return column.ends_with("_rad") ? 0.001 : 0.02;
}

// The largest difference of a column, while both runs last.
double difference(const runs::Run& a, const runs::Run& b, const std::string& column) {
  const auto x = a.column(column), y = b.column(column);
  REQUIRE_FALSE(x.empty());
  double most = 0;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (!std::isnan(x[i] - y[i])) most = std::max(most, std::abs(x[i] - y[i]));
  return most;
}

struct Shows {
  Scene scene;
  std::string column;
};

const std::map<std::string_view, Shows> kShows{
    {"command_delay", {turning, "x_m"}},
    {"command_loss", {turning, "track_left_mps"}},
    {"command_gain", {turning, "x_m"}},
    {"command_gain_turn", {turning, "yaw_rad"}},
    {"command_limit_forward", {turning, "x_m"}},
    {"command_limit_turn", {turning, "yaw_rad"}},
    {"command_dead_band", {turning, "track_left_mps"}},
    {"command_slew", {turning, "x_m"}},
    {"command_slew_forward", {turning, "x_m"}},
    {"command_slew_turn", {turning, "yaw_rad"}},
    {"drive_lag", {turning, "track_left_mps"}},
    {"drive_asymmetry", {turning, "yaw_rad"}},
    {"drive_torque_limit", {turning, "track_left_a"}},
    {"drive_droop", {turning, "yaw_rad"}},
    {"drive_coulomb", {turning, "track_left_a"}},
    {"drive_coulomb_left", {turning, "track_left_a"}},
    {"drive_coulomb_right", {turning, "track_right_a"}},
    {"drive_viscous", {turning, "track_left_a"}},
    {"battery_sag", {turning, "battery_v"}},
    {"flipper_lag", {lifting, "flipper_fl_rad"}},
    {"flipper_backlash", {lifting, "pitch_rad"}},
    {"flipper_compliance", {lifting, "pitch_rad"}},
    {"flipper_torque_limit", {lifting, "flipper_fl_a"}},
    {"mass", {lifting, "flipper_fl_a"}},
    {"roll_inertia", {rolling, "gyro_x_radps"}},
    {"pitch_inertia", {stepping, "gyro_y_radps"}},
    {"yaw_inertia", {turning, "gyro_z_radps"}},
    {"com_forward", {lifting, "flipper_fl_a"}},
    {"com_left", {rolling, "roll_rad"}},
    {"com_up", {stepping, "pitch_rad"}},
    {"friction_along", {turning, "yaw_rad"}},
    {"friction_across", {turning, "yaw_rad"}},
    {"friction_asymmetry", {turning, "yaw_rad"}},
    {"slip_with_speed", {turning, "x_m"}},
    {"shear_deformation", {turning, "yaw_rad"}},
    {"rolling_resistance", {turning, "track_left_a"}},
    {"lug_height", {gripping, "pitch_rad"}},
    {"ground_compliance", {falling, "acc_z_mps2"}},
    {"ground_damping", {falling, "acc_z_mps2"}},
    {"obstacle_height", {stepping, "z_m"}},
    {"obstacle_position", {stepping, "z_m"}},
    {"ground_slope", {turning, "pitch_rad"}},
    {"ground_bank", {turning, "roll_rad"}},
    {"encoder_scale", {turning, "track_left_m"}},
    {"encoder_asymmetry", {turning, "track_left_m"}},
    {"gyro_bias", {turning, "gyro_z_radps"}},
    {"gyro_scale", {turning, "gyro_z_radps"}},
    {"gyro_delay", {turning, "gyro_z_radps"}},
    {"posture_bias", {turning, "pitch_rad"}},
    {"posture_scale", {lifting, "pitch_rad"}},
    {"posture_delay", {lifting, "pitch_rad"}},
    {"posture_mount", {lifting, "roll_rad"}},
    {"tracking_delay", {turning, "x_m"}},
    {"tracking_scale", {turning, "x_m"}},
    {"tracked_point_forward", {turning, "y_m"}},
    {"tracked_point_left", {turning, "x_m"}},
    {"tracking_turn", {turning, "y_m"}},
    {"clock_offset", {turning, "x_m"}},
};

}  // namespace

TEST_CASE("Every effect, half way to an end of its range, shows beyond five times the noise of its channel") {
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    const auto shows = kShows.find(effect.name);
    INFO(effect.name);
    REQUIRE(shows != kShows.end());
    const auto& [scene, column] = shows->second;
    for (const physics::EffectParameter& parameter : effect.parameters) {
      double most = 0;
      for (const double end : {parameter.min, parameter.max}) {
        physics::Effects effects;
        effects.*(parameter.value) = (parameter.neutral + end) / 2;
        most = std::max(most, difference(run_of(scene, effects).run, nominal_run_of(scene).run, column));
      }
      INFO(parameter.name << ": " << column << " differs by " << most << ", its noise is " << noise_of(column));
      CHECK(most > 5 * noise_of(column));
    }
  }
}

TEST_CASE("An effect that is switched on at its neutral value changes no bit of what is recorded") {
  const auto bits_alike = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    physics::Effects effects;
    for (const physics::EffectParameter& parameter : effect.parameters)
      physics::set_effect(effects, std::string(effect.name) + ":" + std::string(parameter.name) + "=" +
                                       std::to_string(parameter.neutral));
    const Scene scene = kShows.at(effect.name).scene;
    const runs::Run run = run_of(scene, effects).run, &nominal = nominal_run_of(scene).run;
    INFO(effect.name);
    REQUIRE(run.columns == nominal.columns);
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      CHECK(std::ranges::equal(run.values[c], nominal.values[c], bits_alike));
  }
}
