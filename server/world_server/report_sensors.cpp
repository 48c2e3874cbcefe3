// SEN in both dialects. Which messages carry a time, and the grouping of names and values, follow recorded lines.
#include <algorithm>
#include <cmath>

#include "server/world_server/encoder_names.hpp"
#include "server/world_server/report.hpp"
#include "server/world_server/scan_angles.hpp"
#include "server/world_server/wire_frames.hpp"

namespace kenaf::world_server {

namespace {

using physics::SensorDescription;
using physics::SensorSample;
using physics::SensorType;
using protocol::usarsim::MessageWriter;
using protocol::usarsim::NumberFormat;

// The order of the UT2004 server, followed by sensors it did not have.
constexpr std::array kOrder = {SensorType::sonar,    SensorType::range_scanner, SensorType::ins,
                               SensorType::odometry, SensorType::encoder,       SensorType::ground_truth,
                               SensorType::gps,      SensorType::tachometer,    SensorType::imu,
                               SensorType::touch,    SensorType::drives};

// One message of one sensor, with everything needed to write it.
struct Report {
  MessageWriter& writer;
  const Formats& formats;
  Dialect dialect;
  const SensorDescription& sensor;
  double t_s;

  MessageWriter& begin(bool with_time) const { return begin(with_time, formats.sensor_time); }
  MessageWriter& begin(bool with_time, NumberFormat time_format) const {
    writer.begin("SEN");
    if (with_time) writer.number("Time", t_s, time_format);
    return writer.text("Type", physics::usarsim_type_name(sensor.type));
  }
  MessageWriter& named(bool with_time) const { return begin(with_time).text("Name", sensor.name); }
};

void write(const Report& report, const physics::GroundTruthReading& reading) {
  const auto orientation = report.dialect == Dialect::ut2004 ? wire_positive_angles(reading.roll_pitch_yaw_rad)
                                                             : wire_angles(reading.roll_pitch_yaw_rad);
  report.named(true)
      .numbers("Location", wire_vector(reading.p_WB_m), report.formats.ground_truth)
      .numbers("Orientation", orientation, report.formats.ground_truth)
      .end();
}

void write(const Report& report, const physics::InsReading& reading) {
  report.named(false)
      .numbers("Location", wire_vector(reading.p_WB_m), report.formats.ins)
      .numbers("Orientation", wire_positive_angles(reading.roll_pitch_yaw_rad), report.formats.ins)
      .end();
}

void write(const Report& report, const physics::ImuReading& reading) {
  const NumberFormat format = report.formats.value;
  report.named(true)
      .numbers("XYZAcceleration", wire_vector(reading.acceleration_mps2), format)
      .numbers("AngularVel", wire_vector(reading.angular_velocity_radps), format)
      .numbers("AngularAccel", wire_vector(reading.angular_acceleration_radps2), format)
      .numbers("Rotation", wire_angles(reading.roll_pitch_yaw_rad), format)
      .end();
}

void write(const Report& report, const physics::EncoderReading& reading) {
  if (report.dialect == Dialect::ut2004) {
    report.begin(false);
    for (std::size_t i = 0; i < kEncoderNames.size(); ++i) {
      report.writer.open_group("Name", kEncoderNames[i]).add_integer("Tick", reading.counts[i]).close_group();
    }
    report.writer.end();
    return;
  }
  for (std::size_t i = 0; i < kEncoderNames.size(); ++i) {
    report.begin(true).text("Name", kEncoderNames[i]).integer("Tick", reading.counts[i]).end();
  }
}

// Positive yaw is a turn to the right.
void write(const Report& report, const physics::OdometryReading& reading) {
  const std::array pose = {reading.x_m, -reading.y_m, -reading.yaw_rad};
  report.named(false).numbers("Pose", pose, report.formats.value).end();
}

void write(const Report& report, const physics::TachometerReading& reading) {
  report.named(true)
      .numbers("Vel", reading.spin_radps, report.formats.value)
      .numbers("Pos", reading.angle_rad, report.formats.value)
      .end();
}

// As UDK; UT2004 has all sonars in one message.
void write(const Report& report, const physics::SonarReading& reading) {
  report.named(true).number("Range", reading.range_m, report.formats.value).end();
}

// From the right end to the left one; reversed in place.
void write(const Report& report, physics::RangeScanReading& reading) {
  std::ranges::reverse(reading.range_m);
  const ScanAngles angles = scan_angles(report.sensor, report.formats.scan_angle);
  report.begin(true, report.formats.scan_time)
      .text("Name", report.sensor.name)
      .number("Resolution", angles.resolution_rad, angles.format)
      .number("FOV", angles.field_of_view_rad, angles.format)
      .numbers("Range", reading.range_m, report.formats.scan)
      .end();
}

// 39.1338 degrees are 39 degrees and 8.03 minutes: {Latitude 39,8.0280,N}.
void write_degrees(const Report& report, const char* key, double degrees, char positive, char negative) {
  const double whole = std::floor(std::abs(degrees));
  std::string text;
  protocol::usarsim::append_number(text, whole, {0, false});
  text += ',';
  protocol::usarsim::append_number(text, (std::abs(degrees) - whole) * 60, report.formats.value);
  text += ',';
  text += degrees < 0 ? negative : positive;
  report.writer.text(key, text);
}

// UT2004's had no time, as recorded.
void write(const Report& report, const physics::GpsReading& reading) {
  report.named(report.dialect == Dialect::udk);
  if (reading.fix) {
    write_degrees(report, "Latitude", reading.latitude_deg, 'N', 'S');
    write_degrees(report, "Longitude", reading.longitude_deg, 'E', 'W');
  }
  report.writer.integer("Fix", reading.fix ? 1 : 0).integer("Satellites", reading.satellites).end();
}

void write(const Report& report, const physics::TouchReading& reading) {
  if (report.dialect == Dialect::udk) {
    report.named(true).boolean("Touch", reading.touched).end();
    return;
  }
  report.begin(true)
      .open_group("Name", report.sensor.name)
      .add_text("Touch", reading.touched ? "True" : "False")
      .close_group()
      .end();
}

void write(const Report& report, const physics::DrivesReading& reading) {
  report.named(true)
      .numbers("TrackCurrent", reading.track_a, report.formats.value)
      .numbers("FlipperCurrent", reading.flipper_a, report.formats.value)
      .number("BatteryVoltage", reading.battery_v, report.formats.value)
      .end();
}

void write_sonars_together(MessageWriter& writer, const Formats& formats, const std::vector<SensorSample>& samples,
                           const std::vector<SensorDescription>& sensors) {
  bool open = false;
  for (const SensorSample& sample : samples) {
    const auto* reading = std::get_if<physics::SonarReading>(&sample.reading);
    if (reading == nullptr) continue;
    if (!open) writer.begin("SEN").number("Time", sample.t_s, formats.sensor_time).text("Type", "Sonar");
    open = true;
    writer.open_group("Name", sensors[sample.sensor].name)
        .add_number("Range", reading->range_m, formats.value)
        .close_group();
  }
  if (open) writer.end();
}

}  // namespace

void write_samples(std::vector<SensorSample>& samples, const std::vector<SensorDescription>& sensors, Dialect dialect,
                   const Formats& formats, bool extended, std::string& out) {
  MessageWriter writer(out);
  for (const SensorType type : kOrder) {
    if (type == SensorType::sonar && dialect == Dialect::ut2004) {
      write_sonars_together(writer, formats, samples, sensors);
      continue;
    }
    // USARSim had no such sensor, so only clients that know this server get it.
    if (type == SensorType::drives && !extended) continue;
    for (SensorSample& sample : samples) {
      const SensorDescription& sensor = sensors[sample.sensor];
      if (sensor.type != type) continue;
      const Report report{writer, formats, dialect, sensor, sample.t_s};
      std::visit([&](auto& reading) { write(report, reading); }, sample.reading);
    }
  }
}

void write_sensors(Simulation& simulation, Session& session) {
  const SessionRobot& robot = *session.robot;
  simulation.samples.clear();
  simulation.world.read_sensors(robot.id, simulation.samples);
  write_samples(simulation.samples, robot.description->sensors, simulation.dialect, session.formats, session.extended,
                session.out);
}

}  // namespace kenaf::world_server
