// The SDO transfers of a bus, tracked frame by frame, and their rules. CiA 301, 7.2.4. Block transfers are not tracked:
// after one, nothing is judged for the node until its next expedited or segmented transfer.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class SdoDialogue {
 public:
  // All arguments must outlive this.
  SdoDialogue(const Network& network, const CheckOptions& options, Findings& findings);

  // Returns the write that this frame has completed.
  std::optional<WrittenObject> on_frame(const LogFrame& logged, const Address& address);
  // A reset node has lost its transfer.
  void on_restart(canopen::NodeId node) { nodes_[node] = {}; }
  void on_end(const LogFrame& last);

 private:
  enum class Kind { none, read, write, block };
  struct Transfer {
    Kind kind = Kind::none;
    canopen::ObjectAddress object{};
    canopen::ObjectBytes value{};       // for a write
    bool segmented = false;             // the first answer has come, segments follow
    bool last_segment = false;          // of the transfer under way
    bool toggle = false;                // of the next or present segment
    std::optional<LogFrame> request{};  // not yet answered
    bool late = false;                  // its lateness has been reported
  };
  void on_request(const LogFrame& logged, canopen::NodeId node);
  void begin(const LogFrame& logged, canopen::NodeId node, Kind kind);
  void next_segment(const LogFrame& logged, canopen::NodeId node, Kind kind);
  std::optional<WrittenObject> on_answer(const LogFrame& logged, canopen::NodeId node);
  std::optional<WrittenObject> answered_segment(const LogFrame& logged, canopen::NodeId node, Kind kind);
  void check_time(const LogFrame& now, canopen::NodeId node);

  const Network& network_;
  const canopen::Time patience_;
  Findings& findings_;
  std::map<canopen::NodeId, Transfer> nodes_;
};

}  // namespace kenaf::canlog
