// Describes each frame of a bus in one line, for readers of a log.
#pragma once

#include <set>
#include <string>

#include "can/canlog/bus_state.hpp"
#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// Follows a log, because frames before it say what some frames are: segments of a block transfer, answers of node
// guarding, and PDOs that the log itself maps or moves.
class Describer {
 public:
  // `network` must outlive this.
  explicit Describer(const Network& network) : network_(network), bus_(network) {}

  // "NMT start: flipper rear left", "track left: operation enabled, position 1234 counts (0.0034 m)". To be called for
  // each frame in the order of the log. A frame that does not fit its identifier is described as such, and what is no
  // data frame by its kind.
  std::string describe(const LogFrame& logged);

 private:
  std::string data_words(const canopen::Frame& frame, const Address& address);
  std::string remote_words(const canopen::Frame& frame, const Address& address);
  std::string heartbeat_words(const canopen::Frame& frame, const Address& address);
  std::string sdo_words(const LogFrame& logged, const Address& address);

  const Network& network_;
  BusState bus_;
  std::set<canopen::NodeId> asked_;  // by node guarding, and not answered yet
};

}  // namespace kenaf::canlog
