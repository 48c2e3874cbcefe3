#include <array>
#include <span>
#include <string_view>

#include "gap/diagnose/left_over_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

using R = Regressor;

// Causes of a dependence on `on`, padded with empty names.
struct Cause {
  Regressor on;
  std::array<std::string_view, 6> look_at;
};

constexpr Cause kOfTracks[] = {
    {R::simulated,
     {"command_gain", "encoder_scale", "drive.sprocket_radius_m", "drive.max_speed_mps", "encoder_asymmetry"}},
    {R::delay, {"command_delay", "drive_lag", "command_slew", "clock_offset"}},
    {R::lag, {"drive_lag", "drive.time_constant_s", "command_slew", "command_delay"}},
    {R::ramp, {"command_slew", "command_slew_forward", "command_slew_turn", "drive.max_force_n", "drive_torque_limit"}},
    {R::constant, {"drive_asymmetry", "encoder_asymmetry"}},
    {R::direction, {"command_dead_band", "drive_coulomb", "drive_droop"}},
    {R::command, {"command_gain", "drive.max_speed_mps", "command_limit_forward", "drive_viscous"}},
    {R::turn, {"command_gain_turn", "command_limit_turn", "drive_asymmetry", "encoder_asymmetry", "friction_across"}},
    {R::turn_size, {"command_limit_turn", "drive_droop", "friction_across", "drive.max_force_n", "drive_torque_limit"}},
    {R::load, {"drive_droop", "battery_sag", "battery.internal_resistance_ohm", "drive.max_force_n"}},
    {R::pitch, {"drive_droop", "mass", "body.mass_kg", "drive.max_force_n"}},
    {R::time, {"battery_sag"}}};

constexpr Cause kOfCurrent[] = {
    {R::simulated, {"drive.amperes_per_newton", "friction_across", "mass", "body.mass_kg"}},
    {R::delay, {"drive_lag", "command_delay"}},
    {R::lag, {"drive_lag", "drive.time_constant_s"}},
    {R::constant, {"drive.idle_amperes"}},
    {R::direction, {"drive.idle_amperes", "drive_coulomb", "rolling_resistance"}},
    {R::speed, {"drive_asymmetry", "rolling_resistance"}},
    {R::turn, {"friction_asymmetry", "com_left", "ground_bank"}},
    {R::turn_size,
     {"friction_across", "track.friction_across", "track.contact_length_m", "wheel.friction_across", "wheel.base_m"}},
    {R::acceleration, {"mass", "body.mass_kg", "drive.moving_mass_kg"}},
    {R::pitch, {"mass", "body.mass_kg"}},
    {R::time, {"drive_coulomb"}}};

constexpr Cause kOfBattery[] = {{R::constant, {"battery.open_circuit_v"}},
                                {R::load, {"battery.internal_resistance_ohm", "battery_sag"}},
                                {R::speed, {"battery_sag", "drive_viscous"}},
                                {R::turn_size, {"battery_sag", "friction_across"}},
                                {R::acceleration, {"battery_sag", "drive.amperes_per_newton"}},
                                {R::time, {"battery.open_circuit_v"}}};

constexpr Cause kOfForward[] = {
    {R::simulated, {"drive.sprocket_radius_m", "encoder_scale", "slip_with_speed", "tracking_scale"}},
    {R::delay, {"tracking_delay", "clock_offset", "command_delay", "drive_lag"}},
    {R::lag, {"tracking_delay", "drive_lag", "friction_along"}},
    {R::constant, {"ground_slope"}},
    {R::direction, {"rolling_resistance", "friction_along"}},
    {R::turn, {"tracked_point_left", "com_left", "ground_bank"}},
    {R::turn_size, {"friction_along", "friction_across", "com_forward"}},
    {R::acceleration, {"tracking_delay", "clock_offset", "friction_along"}},
    {R::load, {"friction_along", "rolling_resistance", "shear_deformation"}},
    {R::pitch, {"friction_along", "ground_slope"}}};

constexpr Cause kOfSideways[] = {{R::simulated, {"friction_across", "com_forward"}},
                                 {R::constant, {"ground_bank"}},
                                 {R::direction, {"friction_across", "ground_bank"}},
                                 {R::speed, {"tracking_turn"}},
                                 {R::turn, {"tracked_point_forward", "com_forward", "friction_across"}},
                                 {R::delay, {"tracking_delay", "clock_offset"}},
                                 {R::lag, {"tracking_delay", "friction_across"}}};

constexpr Cause kOfYawRate[] = {
    {R::simulated,
     {"track.separation_m", "track.contact_length_m", "wheel.separation_m", "wheel.base_m", "friction_across"}},
    {R::delay, {"tracking_delay", "clock_offset", "command_delay", "drive_lag"}},
    {R::lag, {"tracking_delay", "drive_lag", "yaw_inertia", "friction_across"}},
    {R::constant, {"drive_asymmetry", "friction_asymmetry", "ground_bank"}},
    {R::direction, {"friction_across"}},
    {R::speed, {"drive_asymmetry", "friction_asymmetry", "com_left"}},
    {R::turn_size, {"drive_asymmetry", "friction_asymmetry", "com_left"}},
    {R::acceleration, {"com_left", "friction_asymmetry"}},
    {R::load, {"friction_asymmetry", "com_left"}}};

// A gyro has its own errors; otherwise as the pose.
constexpr Cause kOfGyro[] = {{R::simulated,
                              {"track.separation_m", "track.contact_length_m", "wheel.separation_m", "wheel.base_m",
                               "friction_across", "gyro_scale"}},
                             {R::delay, {"gyro_delay", "clock_offset", "command_delay", "drive_lag"}},
                             {R::lag, {"drive_lag", "yaw_inertia", "friction_across", "gyro_delay"}},
                             {R::constant, {"gyro_bias", "drive_asymmetry", "friction_asymmetry", "ground_bank"}}};

constexpr Cause kOfPitch[] = {{R::simulated, {"posture_scale"}},
                              {R::delay, {"posture_delay"}},
                              {R::lag, {"posture_delay", "pitch_inertia"}},
                              {R::constant, {"posture_bias", "com_forward", "ground_slope"}},
                              {R::speed, {"com_forward", "ground_compliance"}},
                              {R::acceleration, {"com_up", "com_forward", "ground_compliance"}},
                              {R::place_x, {"ground_slope", "obstacle_position"}}};

constexpr Cause kOfRoll[] = {{R::simulated, {"posture_scale"}},
                             {R::delay, {"posture_delay"}},
                             {R::lag, {"posture_delay", "roll_inertia"}},
                             {R::constant, {"ground_bank", "com_left"}},
                             {R::pitch, {"posture_mount"}},
                             {R::turn, {"com_up", "ground_compliance"}},
                             {R::place_y, {"ground_bank"}}};

constexpr Cause kOfHeight[] = {
    {R::constant, {"obstacle_height", "ground_compliance", "track.end_radius_m", "wheel.radius_m"}},
    {R::pitch, {"obstacle_height", "obstacle_position"}},
    {R::place_x, {"ground_slope", "obstacle_position"}},
    {R::place_y, {"ground_bank"}},
    {R::speed, {"ground_compliance"}}};

struct Causes {
  std::span<const Cause> of_term;
  std::array<std::string_view, 5> of_runs;  // causes that differ from run to run
};

Causes causes_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::current:
      return {kOfCurrent, {"friction_across", "drive_coulomb"}};
    case Quantity::battery:
      return {kOfBattery, {"battery.open_circuit_v"}};
    case Quantity::forward:
      return {kOfForward, {"friction_along", "ground_slope"}};
    case Quantity::sideways:
      return {kOfSideways, {"ground_bank", "tracking_turn"}};
    case Quantity::yaw_rate:
      return {kOfYawRate, {"friction_across", "ground_bank"}};
    case Quantity::gyro:
      return {kOfGyro, {"friction_across", "gyro_bias"}};
    case Quantity::pitch:
      return {kOfPitch, {"ground_slope", "posture_bias"}};
    case Quantity::roll:
      return {kOfRoll, {"ground_bank"}};
    case Quantity::height:
      return {kOfHeight, {"ground_slope"}};
    default:
      return {kOfTracks, {"drive_torque_limit", "battery.open_circuit_v"}};
  }
}

std::vector<std::string> named(std::span<const std::string_view> names) {
  std::vector<std::string> result;
  for (const std::string_view name : names)
    if (!name.empty()) result.emplace_back(name);
  return result;
}

}  // namespace

std::vector<std::string> look_at(Quantity quantity, Regressor on) {
  for (const Cause& cause : causes_of(quantity).of_term)
    if (cause.on == on) return named(cause.look_at);
  return quantity == Quantity::gyro ? look_at(Quantity::yaw_rate, on) : std::vector<std::string>{};
}

std::vector<std::string> look_at_for_runs(Quantity quantity) {
  return named(causes_of(quantity).of_runs);
}

}  // namespace kenaf::gap::diagnose
