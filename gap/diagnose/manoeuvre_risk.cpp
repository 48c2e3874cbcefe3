#include "gap/diagnose/manoeuvre_risk.hpp"
#include "robot/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace kenaf::gap::diagnose {
namespace {

constexpr double kFallWithin_s = 0.5;
constexpr double kHalfImpact_s = 0.02;
constexpr double kLevel = 1e-9;  // of a plane's normal

// Number of rows in a time; rows of runs without noise are equidistant.
std::size_t rows_in(double time_s, std::span<const double> time) {
  if (time.size() < 2) return 1;
  return static_cast<std::size_t>(std::max(1.0, std::round(time_s / (time[1] - time[0]))));
}

double largest_tilt_of(std::span<const double> roll_rad, std::span<const double> pitch_rad) {
  double largest_rad = 0;
  for (std::size_t i = 0; i < roll_rad.size(); ++i)
    largest_rad =
        std::max(largest_rad, std::acos(std::clamp(std::cos(roll_rad[i]) * std::cos(pitch_rad[i]), -1.0, 1.0)));
  return largest_rad;
}

double fall_of(const runs::Run& run) {
  const auto x = run.column("x_m"), y = run.column("y_m"), z = run.column("z_m"), yaw = run.column("yaw_rad"),
             pitch = run.column("pitch_rad");
  // Height minus the part explained by driving along the body's x axis: what it fell or was lifted.
  std::vector<double> beyond(z.size(), 0.0);
  for (std::size_t i = 1; i < z.size(); ++i) {
    const double ahead_m = (x[i] - x[i - 1]) * std::cos(yaw[i]) + (y[i] - y[i - 1]) * std::sin(yaw[i]);
    const double slope = -std::tan(std::clamp(pitch[i], -1.3, 1.3));
    beyond[i] = beyond[i - 1] + (z[i] - z[i - 1]) - ahead_m * slope;
  }
  // A climb may lift the body less than its pitch suggests: only a loss of height is a fall.
  const std::size_t within = rows_in(kFallWithin_s, run.column("t_s"));
  double fall_m = 0;
  for (std::size_t i = 0; i < z.size(); ++i)
    for (std::size_t j = i + 1; j < std::min(z.size(), i + within + 1); ++j)
      fall_m = std::max(fall_m, std::min(z[i] - z[j], beyond[i] - beyond[j]));
  return fall_m;
}

double impact_of(std::span<const double> time, std::span<const double> z) {
  const std::size_t half = rows_in(kHalfImpact_s, time);
  double largest_mps2 = 0;
  for (std::size_t i = half; i + half < z.size(); ++i) {
    const double h_s = time[i + half] - time[i];
    largest_mps2 = std::max(largest_mps2, (z[i - half] - 2 * z[i] + z[i + half]) / (h_s * h_s));
  }
  return largest_mps2;
}

double current_share_of(const runs::Run& run, const physics::RobotDescription& nominal) {
  const double track_a = nominal.drive.amperes_per_newton * nominal.drive.max_force_n + nominal.drive.idle_amperes;
  const double flipper_a = nominal.servo.amperes_per_nm * nominal.servo.max_torque_nm;
  double share = 0;
  const auto add = [&](const std::string& column, double stalled_a) {
    for (const double current_a : run.column(column))
      if (stalled_a > 0 && current_a > share * stalled_a) share = current_a / stalled_a;
  };
  for (const char* column : {"track_left_a", "track_right_a"}) add(column, track_a);
  for (const std::string_view flipper : robot::kFlipperNames)
    add(std::string("flipper_").append(flipper).append("_a"), flipper_a);
  return share;
}

}  // namespace

Risk worst_of(const Risk& a, const Risk& b) {
  return {std::max(a.largest_tilt_rad, b.largest_tilt_rad),
          std::max(a.fall_m, b.fall_m),
          std::max(a.impact_mps2, b.impact_mps2),
          std::max(a.current_share, b.current_share),
          a.stuck || b.stuck,
          a.fails || b.fails};
}

physics::RobotDescription with_exact_sensors(physics::RobotDescription robot) {
  for (const physics::EffectInfo& effect : physics::effect_catalogue())
    if (effect.stage == physics::Stage::sensor)
      for (const physics::EffectParameter& parameter : effect.parameters)
        robot.effects.*parameter.value = parameter.neutral;
  using physics::SensorType;
  std::erase_if(robot.sensors, [](const physics::SensorDescription& sensor) {
    return sensor.type == SensorType::ins || sensor.type == SensorType::drives;
  });
  for (const SensorType type : {SensorType::ins, SensorType::drives}) {
    physics::SensorDescription exact{};
    exact.type = type;
    exact.name = std::string(physics::usarsim_type_name(type));
    robot.sensors.push_back(std::move(exact));
  }
  return robot;
}

Risk risk_of(const rollout::RollOut& roll_out, const rollout::Manoeuvre& manoeuvre,
             const physics::RobotDescription& nominal) {
  const runs::Run& run = roll_out.run;
  Risk risk{.largest_tilt_rad = largest_tilt_of(run.column("roll_rad"), run.column("pitch_rad")),
            .fall_m = fall_of(run),
            .impact_mps2 = impact_of(run.column("t_s"), run.column("z_m")),
            .current_share = current_share_of(run, nominal),
            .stuck = roll_out.gave_up || (manoeuvre.success && !roll_out.succeeded)};
  risk.fails = !roll_out.fault.empty() || risk.largest_tilt_rad > std::numbers::pi / 2;
  return risk;
}

bool is_level(const physics::WorldDescription& world) {
  return world.boxes.empty() && world.meshes.empty() &&
         std::ranges::all_of(world.planes, [](const physics::GroundPlane& plane) {
           return (plane.X_WP.q * Eigen::Vector3d::UnitZ()).z() > 1 - kLevel;
         });
}

bool moves_flippers(const rollout::Manoeuvre& manoeuvre) {
  if (manoeuvre.phases.empty()) return false;
  const auto& start = manoeuvre.phases.front().flipper_rad;
  return std::ranges::any_of(manoeuvre.phases, [&start](const rollout::Phase& phase) {
    return phase.flipper_rad && phase.flipper_rad != start;
  });
}

Gentleness gentleness(const rollout::Manoeuvre& manoeuvre, bool level_ground, const Risk& risk) {
  if (risk.fails) return Gentleness::fails;
  if (manoeuvre.start_lift_m > 0 || risk.largest_tilt_rad > kLargeTilt_rad || risk.fall_m > kFall_m ||
      risk.impact_mps2 > kImpact_mps2)
    return Gentleness::falls_or_tilts;
  if (!level_ground) return risk.stuck ? Gentleness::falls_or_tilts : Gentleness::low_obstacle;
  return moves_flippers(manoeuvre) ? Gentleness::flat_flippers : Gentleness::flat_driving;
}

}  // namespace kenaf::gap::diagnose
