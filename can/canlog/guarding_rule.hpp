// Node guarding: the master asks by a remote frame, the node answers with its state and a bit that alternates. CiA 301,
// 7.2.8.3.2.1. What is answered first in a log may have either bit, unless the node was reset in it.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class GuardingRule {
 public:
  // Both must outlive this.
  GuardingRule(const Network& network, Findings& findings) : network_(network), findings_(findings) {}

  void on_request(canopen::NodeId node) { nodes_[node].asked = true; }
  void on_frame(const LogFrame& logged, const Address& address);
  // The first answer after it has 0.
  void on_restart(canopen::NodeId node) { nodes_[node] = {.due = false}; }

 private:
  struct Node {
    bool asked = false;
    std::optional<bool> due{};  // the toggle bit of the next answer
  };
  const Network& network_;
  Findings& findings_;
  std::map<canopen::NodeId, Node> nodes_;
};

}  // namespace kenaf::canlog
