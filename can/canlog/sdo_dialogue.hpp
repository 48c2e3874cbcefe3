// The SDO transfers of a bus, followed frame by frame, and the rules about them. CiA 301, 7.2.4. Block transfers are
// not followed: nothing is said of a node from one until its next expedited or segmented transfer.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class SdoDialogue {
 public:
  // All must outlive this.
  SdoDialogue(const Network& network, const CheckOptions& options, Findings& findings);

  // The write that this frame has completed.
  std::optional<WrittenObject> on_frame(const LogFrame& logged, const Address& address);
  // A node that was reset has forgotten its transfer.
  void on_restart(canopen::NodeId node) { nodes_[node] = {}; }
  void on_end(const LogFrame& last);

 private:
  enum class Kind { none, read, write, block };
  struct Transfer {
    Kind kind = Kind::none;
    canopen::ObjectAddress object{};
    canopen::ObjectBytes value{};       // of a write
    bool segmented = false;             // a first answer has come, segments follow
    bool last_segment = false;          // the one under way
    bool toggle = false;                // of the next or present segment
    std::optional<LogFrame> request{};  // not answered yet
    bool late = false;                  // and that has been said
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
