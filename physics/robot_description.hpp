// Description of a robot: a plain value, read from a TOML file in share/robots/. docs/descriptions.md lists every key.
//
// Body frame B: origin at the body's geometric centre, x forward, y left, z up. SI units, radians.
//
// Thread safety: a value.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/description/description_error.hpp"
#include "formats/description/flipper_pairs.hpp"
#include "physics/effects.hpp"
#include "physics/pose.hpp"
#include "robot/parts.hpp"

namespace kenaf::physics {

struct BodyDescription {
  double mass_kg;                // of the body with its main tracks, without flippers
  Eigen::Vector3d size_m;        // collision box of the hull between the tracks
  Eigen::Vector3d p_BBcm_m;      // centre of mass
  Eigen::Vector3d inertia_kgm2;  // about the centre of mass, along x, y, z
  double friction;               // of the hull against ground of friction 1

  bool operator==(const BodyDescription&) const = default;
};

// A track is a stadium: a rectangle with a half circle at each end, swept across its width. A wheel is a track without
// a rectangle: length_m = 2 end_radius_m, pieces 1, no lugs.
struct TrackDescription {
  double length_m;  // over both end arcs
  double end_radius_m;
  double width_m;
  Eigen::Vector3d p_BT_m;  // centre of the LEFT track; the right one is its mirror image
  double friction_along;   // rolling direction
  double friction_across;
  int pieces;           // number of pieces of the belly with contacts of their own, which spread the load along it
  double lug_height_m;  // height of the belt's profile that catches behind an edge
  // Shear deformation modulus K of friction that builds up as a belt slips, of all belts (docs/physics.md); 0:
  // Coulomb's friction. Not of wheels, whose length of contact is not known: 0.
  double shear_deformation_m = 0;

  // Its centre, or that of its mirror image on the right.
  Eigen::Vector3d center_m(robot::Track side) const {
    return side == robot::kLeft ? p_BT_m : Eigen::Vector3d(p_BT_m.x(), -p_BT_m.y(), p_BT_m.z());
  }
  double straight_m() const { return length_m - 2 * end_radius_m; }  // of the rectangle; 0: a wheel
  bool operator==(const TrackDescription&) const = default;
};

// A wheel that swivels and is not driven: it slides in all directions alike.
struct CasterDescription {
  Eigen::Vector3d p_BC_m;  // its centre
  double radius_m;
  double width_m;
  double friction;  // what its swivelling and rolling cost

  TrackDescription as_wheel() const;  // at its place, not of the left side
  bool operator==(const CasterDescription&) const = default;
};

// The drive of one side, whose wheels all turn together.
struct TrackDriveDescription {
  double sprocket_radius_m;  // surface speed per spin; of a wheel, its radius
  double max_speed_mps;
  double max_force_n;                // at the belt, at standstill
  double time_constant_s;            // of the closed speed loop
  double moving_mass_kg;             // belt, sprocket, gear and rotor, as felt at the belt
  double encoder_counts_per_radian;  // of the sprocket
  double amperes_per_newton;         // motor current per belt force
  double idle_amperes;

  bool operator==(const TrackDriveDescription&) const = default;
};

// An arm with a track of its own: a large drum at its pivot, a small one at its tip, a belt around both.
struct FlipperDescription {
  double mass_kg;
  double length_m;  // pivot to the centre of the tip drum
  double pivot_radius_m;
  double tip_radius_m;
  double width_m;
  Eigen::Vector3d p_BPivot_m;  // of the FRONT LEFT flipper; the others are mirror images
  double friction_along;
  double friction_across;
  double min_angle_rad;  // positive tip up
  double max_angle_rad;
  double start_angle_rad;
  bool belt_driven;  // its belt runs with the main track of its side

  bool operator==(const FlipperDescription&) const = default;
};

struct FlipperServoDescription {
  double max_speed_radps;
  double max_torque_nm;
  double amperes_per_nm;
  double resolution_rad = 0;  // of its encoder; 0: exact

  bool operator==(const FlipperServoDescription&) const = default;
};

struct BatteryDescription {
  double open_circuit_v;
  double internal_resistance_ohm;
  double capacity_s;  // USARSim's {Battery} at the start: seconds left, counted down

  bool operator==(const BatteryDescription&) const = default;
};

enum class SensorType {
  ground_truth,
  ins,
  imu,
  encoder,
  odometry,
  tachometer,
  sonar,
  range_scanner,
  gps,
  touch,
  drives
};
// USARSim's name of a sensor type: "GroundTruth", "INS", "IMU", "Encoder", "Odometry", "Tachometer", "Sonar",
// "RangeScanner", "GPS", "Touch", and "Drives" for the one that USARSim does not have (motor currents, battery).
std::string_view usarsim_type_name(SensorType type);

struct SensorDescription {
  SensorType type;
  std::string name;  // unique on the robot
  Pose X_BS;         // its mount
  double period_s;   // 0: at every output of its connection
  double delay_s;    // age of the reported state
  // Sigma of white noise per sample, and of a constant bias drawn once for each robot. In the reading's own units.
  double noise_m = 0, noise_rad = 0, noise_radps = 0, noise_mps2 = 0, noise_a = 0, noise_v = 0;
  double bias_rad = 0, bias_radps = 0;
  // Ray sensors only.
  double min_range_m = 0, max_range_m = 0, field_of_view_rad = 0, resolution_rad = 0;

  std::size_t scan_values() const;  // of a range scanner: rays from one end of the field of view to the other
  bool operator==(const SensorDescription&) const = default;
};

// A mission package, as USARSim calls it: a camera mount with links that turn, driven by MISPKG. Massless: it moves no
// body.
struct MissionPackageDescription {
  struct Link {
    double min_rad, max_rad, max_speed_radps;
    bool operator==(const Link&) const = default;
  };
  std::string name;
  Pose X_BM;
  std::vector<Link> links;  // link 1 first

  bool operator==(const MissionPackageDescription&) const = default;
};

// A camera (camera/). Frame C: x along the optical axis, y left, z up.
struct CameraDescription {
  std::string name;                                     // unique among the robot's cameras
  std::optional<std::size_t> mission_package;           // index of the mount that turns it, which has one link or two
  Pose X_BC;                                            // its mount on the body, if it is on no package
  int width, height;                                    // pixels
  double field_of_view_rad;                             // horizontal, as it starts
  double min_field_of_view_rad, max_field_of_view_rad;  // of its zoom
  double rate_hz;                                       // pictures a second
  double latency_s;                                     // from exposure until the picture can be sent
  int jpeg_quality;                                     // 1 to 100

  bool operator==(const CameraDescription&) const = default;
};

// Factor of an asymmetry on one side: 1 + half of it on the left, 1 - half of it on the right.
inline double side_factor(robot::Track side, double asymmetry) {
  return 1 + (side == robot::kLeft ? 0.5 : -0.5) * asymmetry;
}

struct RobotDescription {
  std::string name;           // stem of its file's name
  std::string usarsim_class;  // "USARBot.Kenaf"
  BodyDescription body;
  std::vector<TrackDescription> track;    // of the left side: one track, or at least one wheel, the front one first
  std::vector<CasterDescription> caster;  // of robots with wheels
  TrackDriveDescription drive;
  std::vector<FlipperDescription> flipper;  // empty, or one that stands for all that the robot has
  description::FlipperPairs flipper_pairs;  // which; of no meaning without flippers
  FlipperServoDescription servo{};
  BatteryDescription battery{};
  std::vector<SensorDescription> sensors;
  std::vector<MissionPackageDescription> mission_packages;
  std::vector<CameraDescription> cameras;
  Effects effects;  // switched on by [effects.NAME] tables

  bool has_flippers() const { return !flipper.empty(); }
  bool has(robot::Flipper which) const {
    return has_flippers() && (robot::is_front(which) ? flipper_pairs.front : flipper_pairs.rear);
  }
  std::size_t flipper_count() const;  // 0, 2 or 4
  bool has_wheels() const { return track.front().straight_m() == 0; }
  double total_mass_kg() const;
  double track_gauge_m() const;     // between the centre planes of the tracks, or of the wheels in the mean
  double track_length_m() const;    // from the front end to the rear end of the tracks, or wheels and casters
  double contact_length_m() const;  // of the line on which they touch flat ground: a track's belly, or the wheel base
  double outer_width_m() const;     // from the left side of the left ones to the right side of the right ones
  double ride_height_m() const;     // of B's origin when they stand on flat ground
  double encoder_factor(robot::Track side) const;  // metres that its encoder reports per metre

  bool operator==(const RobotDescription&) const = default;
};

// Loads a shipped robot ("kenaf") or a TOML file by its path. Throws DescriptionError.
RobotDescription load_robot(const std::string& name_or_path);
RobotDescription parse_robot(std::string_view toml_text, const std::string& name_for_errors);

// Returns the name of the shipped description for a USARSim class such as "USARBot.P2DX" or "usarbot.kenaf"; empty if
// there is none.
std::string robot_name_for_class(std::string_view usarsim_class);

}  // namespace kenaf::physics
