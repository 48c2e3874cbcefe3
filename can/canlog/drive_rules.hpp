// The rules of a drive's power states, set-points and targets. CiA 402-2.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "can/canlog/drive_frames.hpp"
#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class DriveRules {
 public:
  // All arguments must outlive this.
  DriveRules(const Network& network, const CheckOptions& options, Findings& findings);

  // `pdo` is what the frame's identifier carries, nullptr for nothing.
  void on_frame(const LogFrame& logged, const PdoInForce* pdo);
  void on_write(const WrittenObject& written);
  void on_restart(canopen::NodeId node);

 private:
  struct Shown {
    DriveStatus status;
    canopen::Time at;
    unsigned sync;
    canopen::PowerState state() const { return canopen::power_state_of(status.statusword); }
  };
  struct Drive {
    canopen::DriveMode mode;
    std::optional<Shown> shown{}, before{};  // its newest statusword, and the previous one
    std::optional<DriveCommand> command{};   // the newest
    std::set<DriveOrder> orders{};           // given since it showed its present state, plus the one in force then
    bool followed = false;                   // every order since its start, or since the first one in the log
    bool ended = false;                      // commanded to stop; until it is enabled again
  };
  void on_command(const LogFrame& logged, const DriveCommand& command);
  void on_status(const LogFrame& logged, const DriveStatus& status);
  void check_order(const LogFrame& logged, const DriveCommand& command, const Drive& drive);
  void check_fault_reset(const LogFrame& logged, const DriveCommand& command, const Drive& drive);
  void check_target(const LogFrame& logged, const DriveCommand& command, const Drive& drive);
  void check_set_point(const LogFrame& logged, const DriveCommand& command, const Drive& drive);
  void check_transition(const LogFrame& logged, const DriveStatus& status, const Drive& drive);
  // True if `holds` is true for the drive's newest statusword, or for the previous one if the two frames may have
  // crossed.
  template <class Holds>
  bool could_be(const LogFrame& logged, const Drive& drive, Holds holds) const;

  const std::string& name_of(std::size_t drive) const { return network_.bus().drives[drive].name; }

  const Network& network_;
  const CheckOptions& options_;
  Findings& findings_;
  std::vector<Drive> drives_;
  unsigned syncs_ = 0;
};

}  // namespace kenaf::canlog
