// Sensor readings. SI units, radians; frames of REP 103; roll, pitch, yaw as physics/pose.hpp defines them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <variant>
#include <vector>
#include "robot/parts.hpp"

namespace kenaf::physics {

struct GroundTruthReading {
  Eigen::Vector3d p_WB_m, roll_pitch_yaw_rad;
};
struct InsReading {
  Eigen::Vector3d p_WB_m, roll_pitch_yaw_rad;
};  // with noise and bias
struct ImuReading {
  Eigen::Vector3d acceleration_mps2;  // proper acceleration in B: +g on z at rest on level ground
  Eigen::Vector3d angular_velocity_radps, angular_acceleration_radps2;  // in B
  Eigen::Vector3d roll_pitch_yaw_rad;
};
struct EncoderReading {
  std::array<std::int64_t, robot::kTrackCount> counts;
};  // of the sprockets, since add_robot or reset_sensor
struct OdometryReading {
  double x_m, y_m, yaw_rad;
};  // from the encoders, since its reset
struct TachometerReading {
  std::array<double, robot::kTrackCount> spin_radps, angle_rad;
};
struct SonarReading {
  double range_m;
};
struct RangeScanReading {
  std::vector<double> range_m;
};  // from the left end to the right end
struct GpsReading {
  double latitude_deg, longitude_deg;
  int satellites;
  bool fix;
};
struct TouchReading {
  bool touched;
};
struct DrivesReading {
  std::array<double, robot::kTrackCount> track_a;
  std::array<double, robot::kFlipperCount> flipper_a;
  double battery_v;
  std::array<double, robot::kFlipperCount> flipper_rad{};  // from the servos' own encoders
};

using Reading =
    std::variant<GroundTruthReading, InsReading, ImuReading, EncoderReading, OdometryReading, TachometerReading,
                 SonarReading, RangeScanReading, GpsReading, TouchReading, DrivesReading>;

struct SensorSample {
  std::size_t sensor;  // index into RobotDescription::sensors
  double t_s;          // time of the measurement: robot time, before the sensor's delay
  Reading reading;
};

}  // namespace kenaf::physics
