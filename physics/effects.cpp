#include "physics/effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "formats/settings/nearest_word.hpp"

namespace kenaf::physics {
namespace {

using P = EffectParameter;
using E = Effects;

constexpr P kCommandDelay[] = {{"delay_s", "s", 0, 0, 1, &E::command_delay_s}};
constexpr P kCommandLoss[] = {{"probability", "1", 0, 0, 0.9, &E::command_loss}};
constexpr P kCommandGain[] = {{"gain", "1", 1, 0.5, 1.5, &E::command_gain}};
constexpr P kCommandGainTurn[] = {{"gain", "1", 1, 0.5, 1.5, &E::command_gain_turn}};
constexpr P kCommandLimitForward[] = {{"slowness_spm", "s/m", 0, 0, 100, &E::command_limit_forward_spm}};
constexpr P kCommandLimitTurn[] = {{"slowness_sprad", "s/rad", 0, 0, 100, &E::command_limit_turn_sprad}};
constexpr P kCommandDeadBand[] = {{"speed_mps", "m/s", 0, 0, 0.3, &E::command_dead_band_mps}};
constexpr P kCommandSlew[] = {{"slowness_s2pm", "s^2/m", 0, 0, 10, &E::command_slew_s2pm}};
constexpr P kCommandSlewForward[] = {{"slowness_s2pm", "s^2/m", 0, 0, 10, &E::command_slew_forward_s2pm}};
constexpr P kCommandSlewTurn[] = {{"slowness_s2prad", "s^2/rad", 0, 0, 10, &E::command_slew_turn_s2prad}};
constexpr P kDriveLag[] = {{"lag_s", "s", 0, 0, 3, &E::drive_lag_s}};
constexpr P kDriveAsymmetry[] = {{"ratio", "1", 0, -0.5, 0.5, &E::drive_asymmetry}};
constexpr P kDriveTorque[] = {{"scale", "1", 1, 0.02, 1.5, &E::drive_torque_scale}};
constexpr P kDriveDroop[] = {{"droop_mpspn", "m/(s N)", 0, 0, 0.005, &E::drive_droop_mpspn}};
constexpr P kDriveCoulomb[] = {{"force_n", "N", 0, 0, 1000, &E::drive_coulomb_n}};
constexpr P kDriveCoulombLeft[] = {{"force_n", "N", 0, 0, 1000, &E::drive_coulomb_left_n}};
constexpr P kDriveCoulombRight[] = {{"force_n", "N", 0, 0, 1000, &E::drive_coulomb_right_n}};
constexpr P kDriveViscous[] = {{"damping_nspm", "N s/m", 0, 0, 2000, &E::drive_viscous_nspm}};
constexpr P kBatterySag[] = {{"resistance_ohm", "ohm", 0, 0, 5, &E::battery_resistance_ohm}};
constexpr P kFlipperLag[] = {{"lag_s", "s", 0, 0, 3, &E::flipper_lag_s}};
constexpr P kFlipperBacklash[] = {{"angle_rad", "rad", 0, 0, 0.3, &E::flipper_backlash_rad}};
constexpr P kFlipperCompliance[] = {{"compliance_radpnm", "rad/(N m)", 0, 0, 0.05, &E::flipper_compliance_radpnm}};
constexpr P kFlipperTorque[] = {{"scale", "1", 1, 0.05, 1.5, &E::flipper_torque_scale}};
constexpr P kMass[] = {{"scale", "1", 1, 0.5, 2, &E::mass_scale}};
constexpr P kRollInertia[] = {{"scale", "1", 1, 0.3, 4, &E::roll_inertia_scale}};
constexpr P kPitchInertia[] = {{"scale", "1", 1, 0.3, 4, &E::pitch_inertia_scale}};
constexpr P kYawInertia[] = {{"scale", "1", 1, 0.3, 4, &E::yaw_inertia_scale}};
constexpr P kComForward[] = {{"offset_m", "m", 0, -0.3, 0.3, &E::com_forward_m}};
constexpr P kComLeft[] = {{"offset_m", "m", 0, -0.2, 0.2, &E::com_left_m}};
constexpr P kComUp[] = {{"offset_m", "m", 0, -0.2, 0.3, &E::com_up_m}};
constexpr P kFrictionAlong[] = {{"scale", "1", 1, 0.3, 1.5, &E::friction_along_scale}};
constexpr P kFrictionAcross[] = {{"scale", "1", 1, 0.2, 2, &E::friction_across_scale}};
constexpr P kFrictionAsymmetry[] = {{"ratio", "1", 0, -1, 1, &E::friction_asymmetry}};
constexpr P kSlipWithSpeed[] = {{"slip_spm", "s/m", 0, 0, 1, &E::slip_with_speed_spm}};
constexpr P kShearDeformation[] = {{"modulus_m", "m", 0, 0, 0.1, &E::shear_deformation_m}};
constexpr P kRollingResistance[] = {{"coefficient", "1", 0, 0, 0.2, &E::rolling_resistance}};
constexpr P kLugHeight[] = {{"scale", "1", 1, 0, 3, &E::lug_height_scale}};
constexpr P kGroundCompliance[] = {{"scale", "1", 1, 0.2, 50, &E::ground_compliance_scale}};
constexpr P kGroundDamping[] = {{"scale", "1", 1, 0.1, 20, &E::ground_damping_scale}};
constexpr P kObstacleHeight[] = {{"offset_m", "m", 0, -0.05, 0.05, &E::obstacle_height_m}};
constexpr P kObstaclePosition[] = {{"offset_m", "m", 0, -0.1, 0.1, &E::obstacle_position_m}};
constexpr P kGroundSlope[] = {{"pitch_rad", "rad", 0, -0.2, 0.2, &E::ground_slope_rad}};
constexpr P kGroundBank[] = {{"roll_rad", "rad", 0, -0.2, 0.2, &E::ground_bank_rad}};
constexpr P kEncoderScale[] = {{"scale", "1", 1, 0.8, 1.2, &E::encoder_scale}};
constexpr P kEncoderAsymmetry[] = {{"ratio", "1", 0, -0.2, 0.2, &E::encoder_asymmetry}};
constexpr P kGyroBias[] = {{"z_radps", "rad/s", 0, -0.1, 0.1, &E::gyro_bias_z_radps}};
constexpr P kGyroScale[] = {{"scale", "1", 1, 0.7, 1.3, &E::gyro_scale}};
constexpr P kGyroDelay[] = {{"delay_s", "s", 0, 0, 1, &E::gyro_delay_s}};
constexpr P kPostureBias[] = {{"pitch_rad", "rad", 0, -0.1, 0.1, &E::posture_bias_rad}};
constexpr P kPostureScale[] = {{"scale", "1", 1, 0.7, 1.3, &E::posture_scale}};
constexpr P kPostureDelay[] = {{"delay_s", "s", 0, 0, 1, &E::posture_delay_s}};
constexpr P kPostureMount[] = {{"yaw_rad", "rad", 0, -0.3, 0.3, &E::posture_mount_rad}};
constexpr P kTrackingDelay[] = {{"delay_s", "s", 0, 0, 1, &E::tracking_delay_s}};
constexpr P kTrackingScale[] = {{"scale", "1", 1, 0.8, 1.2, &E::tracking_scale}};
constexpr P kTrackedPointForward[] = {{"offset_m", "m", 0, -0.5, 0.5, &E::tracked_point_forward_m}};
constexpr P kTrackedPointLeft[] = {{"offset_m", "m", 0, -0.5, 0.5, &E::tracked_point_left_m}};
constexpr P kTrackingTurn[] = {{"yaw_rad", "rad", 0, -0.3, 0.3, &E::tracking_turn_rad}};
constexpr P kClockOffset[] = {{"offset_s", "s", 0, -1, 1, &E::clock_offset_s}};

constexpr EffectInfo kCatalogue[] = {
    {"command_delay", Stage::command, "commands reach the drives late", kCommandDelay},
    {"command_loss", Stage::command, "a share of the commands never arrives; the one before holds", kCommandLoss},
    {"command_gain", Stage::command, "track speeds arrive multiplied", kCommandGain},
    {"command_gain_turn", Stage::command, "the turn rate arrives multiplied", kCommandGainTurn},
    {"command_limit_forward", Stage::command, "the forward speed is at most 1 / slowness", kCommandLimitForward},
    {"command_limit_turn", Stage::command, "the turn rate is at most 1 / slowness", kCommandLimitTurn},
    {"command_dead_band", Stage::command, "track commands that are slower than this do not move a track",
     kCommandDeadBand},
    {"command_slew", Stage::command, "track speeds change by at most 1 / slowness", kCommandSlew},
    {"command_slew_forward", Stage::command, "the forward speed changes by at most 1 / slowness", kCommandSlewForward},
    {"command_slew_turn", Stage::command, "the turn rate changes by at most 1 / slowness", kCommandSlewTurn},
    {"drive_lag", Stage::drive, "a second first-order lag in the track's speed loop", kDriveLag},
    {"drive_asymmetry", Stage::drive, "the left track runs faster than the right one by this share", kDriveAsymmetry},
    {"drive_torque_limit", Stage::drive, "the track motors' force at standstill, multiplied", kDriveTorque},
    {"drive_droop", Stage::drive, "a track runs slower by this for each newton of its motor", kDriveDroop},
    {"drive_coulomb", Stage::drive, "dry friction of the running gear, felt at the belt", kDriveCoulomb},
    {"drive_coulomb_left", Stage::drive, "dry friction of the left running gear, added to that of both",
     kDriveCoulombLeft},
    {"drive_coulomb_right", Stage::drive, "dry friction of the right running gear, added to that of both",
     kDriveCoulombRight},
    {"drive_viscous", Stage::drive, "friction of the running gear that grows with speed", kDriveViscous},
    {"battery_sag", Stage::drive, "more internal resistance: current lowers voltage, voltage lowers force and speed",
     kBatterySag},
    {"flipper_lag", Stage::drive, "a first-order lag before the angle that the servo follows", kFlipperLag},
    {"flipper_backlash", Stage::drive, "free play between servo and arm", kFlipperBacklash},
    {"flipper_compliance", Stage::drive, "the arm gives way by this angle for each newton metre", kFlipperCompliance},
    {"flipper_torque_limit", Stage::drive, "the flipper servos' torque, multiplied", kFlipperTorque},
    {"mass", Stage::body, "mass of the body, and its inertia with it, multiplied", kMass},
    {"roll_inertia", Stage::body, "moment of inertia of the body about x, multiplied", kRollInertia},
    {"pitch_inertia", Stage::body, "moment of inertia of the body about y, multiplied", kPitchInertia},
    {"yaw_inertia", Stage::body, "moment of inertia of the body about z, multiplied", kYawInertia},
    {"com_forward", Stage::body, "the body's centre of mass lies further ahead", kComForward},
    {"com_left", Stage::body, "the body's centre of mass lies further left", kComLeft},
    {"com_up", Stage::body, "the body's centre of mass lies higher", kComUp},
    {"friction_along", Stage::contact, "friction of the belts in rolling direction, multiplied", kFrictionAlong},
    {"friction_across", Stage::contact, "friction of the belts across, multiplied", kFrictionAcross},
    {"friction_asymmetry", Stage::contact, "the left belts have more friction than the right ones by this share",
     kFrictionAsymmetry},
    {"slip_with_speed", Stage::contact, "a belt at speed u carries the robot with u (1 - slip |u|)", kSlipWithSpeed},
    {"shear_deformation", Stage::contact, "friction of the belts builds up as they slip, over this shear displacement",
     kShearDeformation},
    {"rolling_resistance", Stage::contact, "belts are braked by this share of what presses on them",
     kRollingResistance},
    {"lug_height", Stage::contact, "height of the lugs that catch at an edge, multiplied", kLugHeight},
    {"ground_compliance", Stage::terrain, "give of the ground under a load, multiplied", kGroundCompliance},
    {"ground_damping", Stage::terrain, "damping of the ground under an impact, multiplied", kGroundDamping},
    {"obstacle_height", Stage::terrain, "obstacles are higher than thought", kObstacleHeight},
    {"obstacle_position", Stage::terrain, "obstacles are further ahead than thought", kObstaclePosition},
    {"ground_slope", Stage::terrain, "the world is tilted, down ahead", kGroundSlope},
    {"ground_bank", Stage::terrain, "the world is tilted, down to the right", kGroundBank},
    {"encoder_scale", Stage::sensor, "encoders report track travel and speed multiplied", kEncoderScale},
    {"encoder_asymmetry", Stage::sensor, "the left encoder reports more than the right one by this share",
     kEncoderAsymmetry},
    {"gyro_bias", Stage::sensor, "the gyro's rate about z has an offset", kGyroBias},
    {"gyro_scale", Stage::sensor, "the gyro's rates are multiplied", kGyroScale},
    {"gyro_delay", Stage::sensor, "the gyro reports late", kGyroDelay},
    {"posture_bias", Stage::sensor, "the orientation sensor's pitch has an offset", kPostureBias},
    {"posture_scale", Stage::sensor, "the orientation sensor's roll and pitch are multiplied", kPostureScale},
    {"posture_delay", Stage::sensor, "the orientation sensor reports late", kPostureDelay},
    {"posture_mount", Stage::sensor, "the orientation sensor is mounted turned about the vertical", kPostureMount},
    {"tracking_delay", Stage::sensor, "motion capture or lidar reports the pose late", kTrackingDelay},
    {"tracking_scale", Stage::sensor, "motion capture or lidar reports distances multiplied", kTrackingScale},
    {"tracked_point_forward", Stage::sensor, "the point that is tracked lies ahead of the body's centre",
     kTrackedPointForward},
    {"tracked_point_left", Stage::sensor, "the point that is tracked lies left of the body's centre",
     kTrackedPointLeft},
    {"tracking_turn", Stage::sensor, "the tracked heading is turned to the left of the body's", kTrackingTurn},
    {"clock_offset", Stage::sensor, "the clock of motion capture or lidar is off; below 0 the pose comes early",
     kClockOffset},
};

// "lag_s, scale; did you mean scale?"
template <typename Range>
std::string alternatives(const Range& range, std::string_view to) {
  std::vector<std::string> names;
  for (const auto& item : range) names.emplace_back(item.name);
  return fmt::format("{}{}", fmt::join(names, ", "), settings::did_you_mean(to, names));
}

}  // namespace

std::string_view stage_name(Stage stage) {
  constexpr std::string_view names[] = {"command", "drive", "body", "contact", "terrain", "sensor"};
  return names[static_cast<std::size_t>(stage)];
}

std::span<const EffectInfo> effect_catalogue() {
  return kCatalogue;
}

const EffectInfo* find_effect(std::string_view name) {
  const auto found = std::ranges::find(kCatalogue, name, &EffectInfo::name);
  return found == std::end(kCatalogue) ? nullptr : &*found;
}

const EffectParameter* find_parameter(const EffectInfo& effect, std::string_view name) {
  const auto found = std::ranges::find(effect.parameters, name, &EffectParameter::name);
  return found == effect.parameters.end() ? nullptr : &*found;
}

void set_effect(Effects& effects, std::string_view assignment) {
  // NAME:PARAMETER=VALUE
  const std::size_t colon = assignment.find(':'), equals = assignment.find('=');
  if (colon == assignment.npos || equals == assignment.npos || equals < colon)
    throw std::invalid_argument(
        fmt::format("effect \"{}\": write NAME:PARAMETER=VALUE, such as command_delay:delay_s=0.05", assignment));
  const std::string_view name = assignment.substr(0, colon);
  const std::string_view parameter_name = assignment.substr(colon + 1, equals - colon - 1);
  const std::string_view number = assignment.substr(equals + 1);

  // Both names must be in the catalogue; errors list what is.
  const EffectInfo* effect = find_effect(name);
  if (!effect)
    throw std::invalid_argument(
        fmt::format("effect \"{}\": there are {}", name, alternatives(effect_catalogue(), name)));
  const EffectParameter* parameter = find_parameter(*effect, parameter_name);
  if (!parameter)
    throw std::invalid_argument(fmt::format("effect {}: has no parameter \"{}\", but {}", name, parameter_name,
                                            alternatives(effect->parameters, parameter_name)));

  // A number, to its last character, within the parameter's range.
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || end != number.data() + number.size())
    throw std::invalid_argument(
        fmt::format("effect {}: {} = \"{}\" is not a number; write it as 0.05 or 5e-2", name, parameter_name, number));
  if (!(value >= parameter->min && value <= parameter->max))
    throw std::invalid_argument(fmt::format("effect {}: {} = {} is out of range; it goes from {} to {}{}", name,
                                            parameter_name, value, parameter->min, parameter->max,
                                            parameter->unit == "1" ? "" : fmt::format(" {}", parameter->unit)));
  effects.*(parameter->value) = value;
}

}  // namespace kenaf::physics
