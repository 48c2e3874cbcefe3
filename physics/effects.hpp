// Effects: the named ways in which a robot or its ground may differ from the nominal model. One catalogue for the
// simulator, the command line and the diagnosis. docs/effects.md has the physics of each.
//
// Every parameter has a neutral value, and with all at neutral a simulation gives the same bits as without effects.
//
// Thread safety: values and constants.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::physics {

// Where an effect acts between a command and a measurement. A delay of the same length is another effect in each stage.
enum class Stage { command, drive, body, contact, terrain, sensor };
std::string_view stage_name(Stage stage);

// The value of every parameter. The physics reads these members; everything else goes through the catalogue.
struct Effects {
  // command: between the command that was sent and the one that the drives get
  double command_delay_s = 0;
  double command_loss = 0;       // share of calls of World::set_command that do not arrive
  double command_gain = 1;       // of track speeds
  double command_gain_turn = 1;  // of the turn rate alone
  double command_limit_forward_spm = 0,
         command_limit_turn_sprad = 0;  // forward speed and turn rate are at most 1 / this
  double command_dead_band_mps = 0;     // slower track commands do not move a track
  double command_slew_s2pm = 0;         // track speeds change by 1 / this at most
  double command_slew_forward_s2pm = 0, command_slew_turn_s2prad = 0;  // the same of forward speed and turn rate
  // drive: between the command that arrived and belt or flipper
  double drive_lag_s = 0;      // a second first-order lag of the speed loop
  double drive_asymmetry = 0;  // left track faster by half of it, right one slower
  double drive_torque_scale = 1;
  double drive_droop_mpspn = 0;  // a motor that gives a force runs slower by this times the force
  double drive_coulomb_n = 0;    // friction of the running gear, at the belt
  double drive_coulomb_left_n = 0, drive_coulomb_right_n = 0;  // added to it on one side
  double drive_viscous_nspm = 0;
  double battery_resistance_ohm = 0;  // added to the battery's own
  double flipper_lag_s = 0;           // of the angle that the servo follows
  double flipper_backlash_rad = 0;    // free play, between both ends
  double flipper_compliance_radpnm = 0;
  double flipper_torque_scale = 1;
  // body
  double mass_scale = 1;  // of the body, its inertia with it
  double roll_inertia_scale = 1, pitch_inertia_scale = 1, yaw_inertia_scale = 1;
  double com_forward_m = 0, com_left_m = 0, com_up_m = 0;  // of the body's centre of mass
  // contact: between belt and ground
  double friction_along_scale = 1, friction_across_scale = 1;
  double friction_asymmetry = 0;   // left belts have more friction by half of it, right ones less
  double slip_with_speed_spm = 0;  // belt's surface speed u drives as u (1 - this |u|)
  double shear_deformation_m = 0;  // added to the description's: friction that builds up as a belt slips
  double rolling_resistance = 0;   // force against the belt's motion for a unit of normal force
  double lug_height_scale = 1;
  // terrain
  double ground_compliance_scale = 1, ground_damping_scale = 1;
  double obstacle_height_m = 0;    // ground that is not under the start is higher
  double obstacle_position_m = 0;  // ground that is not under the start is further ahead (+x of the world)
  double ground_slope_rad = 0;     // the whole world falls away forward (+) under level axes
  double ground_bank_rad = 0;      // the whole world falls away to the right (+)
  // sensor
  double encoder_scale = 1;      // reported track travel and speed
  double encoder_asymmetry = 0;  // left encoder reports more by half of it, right one less
  double gyro_bias_z_radps = 0;  // added to the reported yaw rate
  double gyro_scale = 1;         // of all three reported rates
  double gyro_delay_s = 0;
  double posture_bias_rad = 0;   // added to the reported pitch
  double posture_scale = 1;      // of reported roll and pitch
  double posture_delay_s = 0;    // the report's time stamp stays that of the nominal delay
  double posture_mount_rad = 0;  // the orientation sensor is mounted turned about z
  double tracking_delay_s = 0;   // of the pose that motion capture or lidar reports; no sensor of the robot
  double tracking_scale = 1;     // of its x, y from the first pose on
  double tracked_point_forward_m = 0, tracked_point_left_m = 0;  // in B, of the point whose pose that is
  double tracking_turn_rad = 0;                                  // of the reported heading against the body's
  double clock_offset_s = 0;                                     // its clock is behind (+) the robot's

  bool operator==(const Effects&) const = default;
};

struct EffectParameter {
  std::string_view name;     // with its unit as the last word, "delay_s"; "scale" has none
  std::string_view unit;     // "s", "m/s"; "1" for a ratio
  double neutral, min, max;  // min < max, neutral within
  double Effects::*value;
};

struct EffectInfo {
  std::string_view name;  // "command_delay"
  Stage stage;
  std::string_view summary;  // one line of physics
  std::span<const EffectParameter> parameters;
};

// All effects, in the order of the stages.
std::span<const EffectInfo> effect_catalogue();
// Null if there is none of that name.
const EffectInfo* find_effect(std::string_view name);
const EffectParameter* find_parameter(const EffectInfo& effect, std::string_view name);

// `assignment`: "command_delay:delay_s=0.05". Throws std::invalid_argument, with the alternatives and the one
// that was probably meant, if the effect or parameter is unknown, or if the value is no number or out of range.
void set_effect(Effects& effects, std::string_view assignment);

}  // namespace kenaf::physics
