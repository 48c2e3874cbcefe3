// The SDO transfers of a bus, tracked frame by frame, and their rules. CiA 301, 7.2.4.
//
// A log may begin within a transfer. Nothing is judged for a node until a transfer begins in the log; and a first
// request that is not answered, but followed by one with the next number, was a segment of a block transfer.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"
#include "can/canlog/sdo_block.hpp"

namespace kenaf::canlog {

class SdoDialogue {
 public:
  // All arguments must outlive this.
  SdoDialogue(const Network& network, const CheckOptions& options, Findings& findings);

  // Returns the write that this frame has completed.
  std::optional<WrittenObject> on_frame(const LogFrame& logged, const Address& address);
  // A reset node has lost its transfer.
  void on_restart(canopen::NodeId node) { nodes_[node] = {.kind = Kind::none, .followed = true}; }
  void on_end(const LogFrame& last);

  // The node's block transfer under way; nullptr: none.
  const SdoBlock* block(canopen::NodeId node) const;

 private:
  // unknown: the log may have begun within a transfer.
  enum class Kind { unknown, none, read, write, block };
  struct Transfer {
    Kind kind = Kind::unknown;
    bool followed = false;  // the log has a whole exchange of this node, or its reset
    canopen::ObjectAddress object{};
    canopen::ObjectBytes value{};       // for a write
    bool segmented = false;             // the first answer has come, segments follow
    bool last_segment = false;          // of the transfer under way
    bool toggle = false;                // of the next or present segment
    std::optional<LogFrame> request{};  // not yet answered
    bool late = false;                  // its lateness has been reported
    std::optional<SdoBlock> block{};    // for Kind::block
  };
  bool continues_unseen_block(const LogFrame& logged, const Transfer& transfer) const;
  void end_transfer(canopen::NodeId node) { nodes_[node] = {.kind = Kind::none, .followed = true}; }
  void check_block(const LogFrame& logged, canopen::NodeId node, bool from_server);
  std::optional<WrittenObject> on_block_answer(const LogFrame& logged, canopen::NodeId node);
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
