// A robot's bus with round numbers, so that answers can be derived by hand: 10000 counts for 1 m of track and 1 rad of
// flipper, drives whose speeds are in counts/s and accelerations in counts/s^2. Nodes 1 and 2 tracks, 3 to 6 flippers,
// 7 inclinometer, 8 gyro; left is direction +1, right -1. And frames as candump writes them.
#pragma once

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "can/candrives/ideal_plant.hpp"
#include "can/candrives/robot_slaves.hpp"

namespace kenaf::candrives {

inline canbus::RobotBus easy_robot() {
  canbus::RobotBus bus{};
  bus.interface = "vcan0";
  bus.master = 127;
  bus.master_heartbeat_s = 0.02;
  bus.master_silence_s = 0.1;
  bus.node_heartbeat_s = 0.1;
  bus.answer_s = 0.5;
  constexpr std::array kNames{"track left",          "track right",       "flipper front left",
                              "flipper front right", "flipper rear left", "flipper rear right"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const double direction = i % 2 == 0 ? 1 : -1;
    canbus::DriveOnBus& drive = bus.drives.emplace_back();
    drive.name = kNames[i];
    drive.side = i % 2 == 0 ? robot::kLeft : robot::kRight;
    if (i >= robot::kTrackCount) drive.flipper = static_cast<robot::Flipper>(i - robot::kTrackCount);
    drive.node = static_cast<canopen::NodeId>(i + 1);
    drive.mode = drive.is_flipper() ? canopen::DriveMode::profile_position : canopen::DriveMode::profile_velocity;
    drive.units = {.counts_per_unit = 10'000 * direction,
                   .velocity_per_unit = 10'000 * direction,
                   .acceleration_per_unit = 10'000};
    drive.max_speed = 1;
    drive.acceleration = 5;
    drive.quick_stop_deceleration = 10;
    drive.min_position = -3;
    drive.max_position = 3;
  }
  using Axis = canbus::InclinometerAxis;
  bus.inclinometer = canbus::InclinometerOnBus{7, Axis{true, 1, 0.0}, Axis{false, -1, 0.1}};
  bus.gyro = canbus::GyroOnBus{8, 1, 16, 16, 1000.0};
  return bus;
}

// "181#2704": identifier and data, both in hexadecimal.
inline canopen::Frame frame(std::string_view text) {
  const std::size_t mark = text.find('#');
  const auto number = [](std::string_view digits) {
    return static_cast<std::uint16_t>(std::strtoul(std::string(digits).c_str(), nullptr, 16));
  };
  std::vector<std::uint8_t> data;
  for (std::size_t at = mark + 1; at < text.size(); at += 2)
    data.push_back(static_cast<std::uint8_t>(number(text.substr(at, 2))));
  return canopen::make_frame(number(text.substr(0, mark)), data);
}

inline std::string text(const canopen::Frame& frame) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string line;
  for (const int shift : {8, 4, 0}) line += kDigits[frame.id >> shift & 15];
  line += '#';
  for (std::size_t i = 0; i < frame.length; ++i) {
    line += kDigits[frame.data[i] >> 4];
    line += kDigits[frame.data[i] & 15];
  }
  return line;
}

inline std::vector<std::string> texts(const Frames& frames) {
  std::vector<std::string> lines;
  for (const auto& one : frames) lines.push_back(text(one));
  return lines;
}

using Lines = std::vector<std::string>;

// The slaves with an ideal plant, and a clock that the test winds.
struct EasyRobot {
  IdealPlant plant;
  RobotSlaves slaves;
  canopen::Time now{};

  explicit EasyRobot(const IdealPlant& with = IdealPlant(), const canbus::RobotBus& bus = easy_robot())
      : plant(with), slaves(bus, plant, canopen::Time::zero()) {
    wait(1);  // boot-up messages, and the drives' self tests
  }
  EasyRobot(const EasyRobot&) = delete;

  // What comes back at once.
  Lines send(std::string_view line) {
    Frames out;
    slaves.on_frame(frame(line), now, out);
    return texts(out);
  }
  // What comes while `ms` pass.
  Lines wait(int ms) {
    Frames out;
    now += std::chrono::milliseconds(ms);
    slaves.on_time(now, out);
    return texts(out);
  }
  Lines inject(const Fault& fault) {
    Frames out;
    slaves.inject(fault, now, out);
    return texts(out);
  }
  const Drive& drive(std::size_t index) const { return slaves.drive(index); }
  // An object after a read, which brings measured ones up to date.
  std::int64_t value(canopen::NodeId node, std::uint16_t index, std::uint8_t sub = 0) {
    canopen::Frame request{.id = static_cast<std::uint16_t>(0x600 + node), .length = 8};
    request.data[0] = 0x40;
    canopen::put(request.data, 1, 2, index);
    request.data[3] = sub;
    send(text(request));
    return slaves.slave(node)->objects().value({index, sub});
  }
  // Writes an object of 1, 2 or 4 bytes by SDO; what comes back.
  std::string write(canopen::NodeId node, std::uint16_t index, std::uint8_t sub, std::size_t bytes,
                    std::int64_t value) {
    canopen::Frame request{.id = static_cast<std::uint16_t>(0x600 + node), .length = 8};
    request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
    canopen::put(request.data, 1, 2, index);
    request.data[3] = sub;
    canopen::put(request.data, 4, bytes, static_cast<std::uint32_t>(value));
    const Lines answer = send(text(request));
    return answer.empty() ? "" : answer.front();
  }
  // From any state to operation enabled, by SDO, as a master does it.
  void enable(canopen::NodeId node, int mode) {
    write(node, 0x6060, 0, 1, mode);
    wait(1);
    for (const int word : {0x06, 0x07, 0x0f}) write(node, 0x6040, 0, 2, word);
  }
};

}  // namespace kenaf::candrives
