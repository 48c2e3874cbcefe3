// The NMT state of each node, tracked from orders and heartbeats, and the rules about it. CiA 301, 7.3.2.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class NodeStates {
 public:
  // All arguments must outlive this.
  NodeStates(const Network& network, const CheckOptions& options, Findings& findings)
      : network_(network), options_(options), findings_(findings) {}

  void on_frame(const LogFrame& logged, const Address& address);

  // True if it was operational before `at`, allowing for crossing frames; false if the log does not tell.
  bool was_operational(canopen::NodeId node, canopen::Time at) const;
  // True if this frame made the node lose its set-up: an order to reset it, or its boot-up.
  static bool is_restart(const LogFrame& logged, const Address& address, canopen::NodeId node);

 private:
  struct Node {
    std::optional<canopen::NmtState> state;  // boot_up: it was reset and has not reported yet
    canopen::Time since{};
    bool reported = false;  // one violation for each reset
  };
  void on_order(const LogFrame& logged);
  void on_heartbeat(const LogFrame& logged, canopen::NodeId node);
  void check_pdo(const LogFrame& logged, const Address& address);
  void check_service(const LogFrame& logged, const Address& address);
  void check_boot_up(const LogFrame& logged, canopen::NodeId node);
  bool may_have_crossed(const Node& node, const LogFrame& logged) const {
    return logged.at - node.since <= options_.crossing;
  }
  void enter(Node& node, canopen::NmtState state, canopen::Time at);

  const Network& network_;
  const CheckOptions& options_;
  Findings& findings_;
  std::map<canopen::NodeId, Node> nodes_;
};

}  // namespace kenaf::canlog
