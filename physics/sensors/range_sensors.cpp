#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/sensors/measure.hpp"

namespace kenaf::physics {
namespace {

constexpr double kPi = std::numbers::pi;

double ranged(const SensorDescription& sensor, SensorState& state, std::optional<double> hit_m) {
  if (!hit_m) return sensor.max_range_m;
  return std::clamp(*hit_m + state.noise.normal(sensor.noise_m), sensor.min_range_m, sensor.max_range_m);
}

}  // namespace

SonarReading measure_sonar(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                           const RayCaster& cast) {
  // The axis of the cone, and two rings of rays around it.
  const Pose X_WS = compose(now.X_WB, sensor.X_BS);
  std::optional<double> nearest = cast(X_WS.p, X_WS.q * Eigen::Vector3d::UnitX(), sensor.max_range_m);
  for (const double off : {sensor.field_of_view_rad / 4, sensor.field_of_view_rad / 2}) {
    for (int i = 0; i < 8; ++i) {
      const double around = i * kPi / 4;
      const Eigen::Vector3d ray_S(std::cos(off), std::sin(off) * std::cos(around), std::sin(off) * std::sin(around));
      const auto hit = cast(X_WS.p, X_WS.q * ray_S, nearest.value_or(sensor.max_range_m));
      if (hit) nearest = hit;
    }
  }
  return {ranged(sensor, state, nearest)};
}

RangeScanReading measure_range_scanner(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                                       const RayCaster& cast) {
  const Pose X_WS = compose(now.X_WB, sensor.X_BS);
  const std::size_t rays = sensor.scan_values();
  RangeScanReading reading;
  reading.range_m.reserve(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double share = rays > 1 ? static_cast<double>(i) / static_cast<double>(rays - 1) : 0.5;
    const double angle = sensor.field_of_view_rad * (0.5 - share);  // the left end first
    const Eigen::Vector3d ray_S(std::cos(angle), std::sin(angle), 0);
    reading.range_m.push_back(ranged(sensor, state, cast(X_WS.p, X_WS.q * ray_S, sensor.max_range_m)));
  }
  return reading;
}

GpsReading measure_gps(const SensorDescription& sensor, SensorState& state, const MotionSample& now,
                       const RayCaster& cast) {
  // The world's origin is where USARSim's own example lies, 39 deg 8.03' N, 77 deg 13.0' W; x east, y north (REP 103).
  constexpr double kLatitude_deg = 39.13383333, kLongitude_deg = -77.21666667;
  constexpr double kEquator_m = 6378137.0, kEccentricity2 = 6.69437999014e-3;  // WGS 84
  constexpr double kRoof_m = 100;
  constexpr int kSatellites = 11;
  const Pose X_WS = compose(now.X_WB, sensor.X_BS);
  if (cast(X_WS.p, Eigen::Vector3d::UnitZ(), kRoof_m)) return {0, 0, 0, false};

  // Radii of curvature of the ellipsoid at the origin, w = 1 - e^2 sin^2 latitude: a (1 - e^2) / w^(3/2) to the north,
  // a cos(latitude) / w^(1/2) to the east.
  const double sine = std::sin(kLatitude_deg * kPi / 180);
  const double w = 1 - kEccentricity2 * sine * sine;
  const double north_radius_m = kEquator_m * (1 - kEccentricity2) / (w * std::sqrt(w));
  const double east_radius_m = kEquator_m / std::sqrt(w) * std::cos(kLatitude_deg * kPi / 180);
  const double east = X_WS.p.x() + state.noise.normal(sensor.noise_m);
  const double north = X_WS.p.y() + state.noise.normal(sensor.noise_m);
  return {kLatitude_deg + north / north_radius_m * 180 / kPi, kLongitude_deg + east / east_radius_m * 180 / kPi,
          kSatellites, true};
}

}  // namespace kenaf::physics
