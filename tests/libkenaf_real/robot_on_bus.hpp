// libkenaf_real's transport on a bus in this process, with the simulated drives of a robot on it and a time of its own.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>

#include "can/candrives/ideal_plant.hpp"
#include "can/canopen/drive.hpp"
#include "hrt/config.hpp"
#include "libkenaf_real/can_transport.hpp"
#include "robot/state.hpp"
#include "tests/support/simulated_bus.hpp"

namespace kenaf::real {

// What a transport may close while the test looks on.
class BorrowedBus final : public canopen::Bus {
 public:
  explicit BorrowedBus(canopen::Bus& bus) : bus_(bus) {}
  canopen::Time now() const override { return bus_.now(); }
  canopen::Time suspended() override { return bus_.suspended(); }
  void send(const canopen::Frame& frame) override { bus_.send(frame); }
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until) override { return bus_.receive(until); }
  void start_sync(canopen::Time period) override { bus_.start_sync(period); }
  void stop_sync() override { bus_.stop_sync(); }
  void interrupt() override { bus_.interrupt(); }

 private:
  canopen::Bus& bus_;
};

// Follows its command exactly, or with a lag, and leans and turns as the test says.
class LeaningPlant final : public candrives::Plant {
 public:
  void advance(canopen::Time step, const candrives::PlantCommand& command) override {
    const double step_s = std::chrono::duration<double>(step).count();
    const double share = speed_loop_s > 0 ? -std::expm1(-step_s / speed_loop_s) : 1;
    candrives::PlantCommand followed = command;
    for (std::size_t i = 0; i < robot::kTrackCount; ++i)
      followed.track_mps[i] = state_.track_mps[i] + share * (command.track_mps[i] - state_.track_mps[i]);
    tracks_.advance(step, followed);
    state_ = tracks_.state();
    for (double& angle_rad : state_.flipper_rad) angle_rad -= flipper_sag_rad;
    state_.roll_rad = roll_rad;
    state_.pitch_rad = pitch_rad;
    state_.yaw_rate_radps = yaw_rate_radps;
  }
  const candrives::PlantState& state() const override { return state_; }
  double roll_rad = 0, pitch_rad = 0, yaw_rate_radps = 0;
  double speed_loop_s = 0;
  double flipper_sag_rad = 0;  // that flippers lie below what their drives demand, as under a load

 private:
  candrives::IdealPlant tracks_;
  candrives::PlantState state_ = tracks_.state();
};

struct RobotOnBus {
  canbus::RobotBus description;
  LeaningPlant plant;
  candrives::SimulatedBus wire;
  hrt_config config = hrt::default_config();
  CanTransport transport;

  explicit RobotOnBus(const std::string& robot = "kenaf") : RobotOnBus(robot, canbus::load_robot_bus(robot)) {}
  // With all of `on_wire` on the bus, which may be more than the description names.
  RobotOnBus(const std::string& robot, const canbus::RobotBus& on_wire)
      : description(canbus::load_robot_bus(robot)),
        wire(on_wire, plant),
        transport([this](const std::string&, std::span<const std::uint16_t>) {
          wire.open_socket();
          return std::make_unique<BorrowedBus>(wire);
        }) {
    robot.copy(config.robot, sizeof config.robot - 1);
    config.robot[robot.size()] = '\0';
  }
  RobotOnBus(const RobotOnBus&) = delete;

  void open() { transport.open(config); }
  // Cycles with `command` in force; the newest state.
  robot::State run(int cycles, const robot::Command& command) {
    robot::State state{};
    for (int i = 0; i < cycles; ++i) {
      state = transport.wait_state().value();
      transport.send(command);
    }
    return state;
  }
  canopen::PowerState power(std::size_t drive) const {
    return const_cast<candrives::SimulatedBus&>(wire).slaves().drive(drive).power_state();
  }
  bool all_are(canopen::PowerState state) const {
    for (std::size_t i = 0; i < description.drives.size(); ++i) {
      if (power(i) != state) return false;
    }
    return true;
  }
  bool stands() const { return plant.state().track_mps[0] == 0 && plant.state().track_mps[1] == 0; }
  // How long the tracks still run without the master doing anything; 1 s: longer than that.
  double seconds_to_rest() {
    const canopen::Time begin = wire.now();
    while (!stands() && wire.now() - begin < std::chrono::seconds(1))
      wire.run_until(wire.now() + std::chrono::milliseconds(1));
    return std::chrono::duration<double>(wire.now() - begin).count();
  }
  double seconds() const { return std::chrono::duration<double>(wire.now()).count(); }
};

inline robot::Command drive_at(double left_mps, double right_mps) {
  robot::Command command;
  command.track_speed_mps = {left_mps, right_mps};
  return command;
}

}  // namespace kenaf::real
