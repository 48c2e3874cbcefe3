// The bus cycle, SYNC by SYNC: measurements of the nodes, commands to the drives, and detection of silent nodes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/master.hpp"
#include "libkenaf_real/process_image.hpp"

namespace kenaf::real {

// A drive silent for this long is lost, and with it the robot.
inline constexpr double kSilentDrive_s = 0.05;
// A sensor silent for this long is lost; the robot continues without it.
inline constexpr double kSilentSensor_s = 0.1;

// Throws hrt::Error(HRT_E_CONFIG) if the period is too short for the bus to carry a cycle with a margin for errors and
// other traffic, or too long: a drive's silence would show too late, or after fewer than two lost frames.
void check_period(const canbus::RobotBus& bus, double period_s);

struct DriveOrder {
  std::uint16_t controlword = 0;
  std::int32_t target = 0;  // position or velocity, according to the drive's mode, in its units
};
using DriveOrders = std::vector<DriveOrder>;  // of each drive in RobotBus::drives

struct Beat {
  std::uint32_t number;  // 1 = the first SYNC; a step of more than one: SYNCs that never came
  canopen::Time sync_at;
};

class BusCycle {
 public:
  // Both must outlive this.
  BusCycle(Master& master, const canbus::RobotBus& bus, double period_s);
  ~BusCycle();
  BusCycle(const BusCycle&) = delete;
  BusCycle& operator=(const BusCycle&) = delete;

  Master& master() { return master_; }
  const canbus::RobotBus& bus() const { return bus_; }
  const ProcessImage& image() const { return image_; }

  // Starts SYNC; it ends with stop() or with the program.
  void start();
  void stop();

  // Waits for the next SYNC, and then until all nodes have answered it or 0.6 periods have passed; if several SYNCs
  // wait, only the newest is a beat. nullopt: interrupted. Throws hrt::Error(HRT_E_LINK) if no more SYNC comes.
  std::optional<Beat> wait();
  // In force from the next SYNC on; late if that has already come. A drive that takes commands less often
  // (Device::command_every) gets each n-th. Throws HeldUp.
  void send(const DriveOrders& orders);
  // The same for stops that cannot wait: a drive's first quick stop goes out of its turn. Such a drive may answer that
  // with a fault, which stops it too, but without torque afterwards.
  void send_at_once(const DriveOrders& orders);
  const DriveOrders& sent() const { return sent_; }  // the last that went to each drive; zeros at first
  std::uint32_t late_orders() const { return late_; }
  double round_trip_s() const { return round_trip_s_; }  // newest SYNC to its last answer
  double period_s() const;

  // From now on a boot-up message counts as a restart.
  void watch_restarts() { image_.watch_restarts(); }
  // From now on a position that changes faster than the drive can turn means that it is lost.
  void watch_jumps() { image_.watch_jumps(); }
  // Returns the first drive that is not under control: restarted, silent, not enabled, or with an impossible position.
  std::optional<std::size_t> lost_drive() const;
  // Describes what is wrong with the drive at this moment, naming it. Its emergency message, if it sends one, may come
  // some milliseconds after its statusword: emergency_of, "" if there is none.
  std::string loss_of(std::size_t drive) const;
  std::string emergency_of(std::size_t drive) const;
  bool slope_is_silent() const, gyro_is_silent() const;

 private:
  bool is_silent(const std::optional<canopen::Time>& at, double limit_s) const;
  void send(const DriveOrders& orders, bool at_once);

  Master& master_;
  const canbus::RobotBus& bus_;
  const canopen::Time period_;
  ProcessImage image_;
  std::vector<canbus::DrivePdos> pdos_;
  DriveOrders sent_;
  std::vector<std::optional<std::uint32_t>> sent_at_;  // Beat::number of the last command to each drive
  std::optional<canopen::Time> first_sync_at_, answered_sync_at_;
  std::uint32_t number_ = 0, late_ = 0;
  double round_trip_s_ = 0;
};

}  // namespace kenaf::real
