#include "can/canlog/node_states.hpp"

namespace kenaf::canlog {

using canopen::NmtCommand;
using canopen::NmtState;
using canopen::NodeId;

bool NodeStates::was_operational(NodeId node, canopen::Time at) const {
  const auto found = nodes_.find(node);
  return found != nodes_.end() && found->second.state == NmtState::operational &&
         at - found->second.since > options_.crossing;
}

bool NodeStates::is_restart(const LogFrame& logged, const Address& address, NodeId node) {
  if (address.service == Service::heartbeat) {
    const auto heartbeat = canopen::heartbeat_from(logged.frame);
    return heartbeat && heartbeat->node == node && heartbeat->state == NmtState::boot_up;
  }
  const auto order = canopen::nmt_order_from(logged.frame);
  return order && (order->node == 0 || order->node == node) &&
         (order->command == NmtCommand::reset_node || order->command == NmtCommand::reset_communication);
}

void NodeStates::on_frame(const LogFrame& logged, const Address& address) {
  switch (address.service) {
    case Service::nmt:
      return on_order(logged);
    case Service::heartbeat:
      return on_heartbeat(logged, address.node);
    case Service::transmit_pdo:
    case Service::receive_pdo:
      return check_pdo(logged, address);
    case Service::sdo_answer:
    case Service::sdo_request:
    case Service::emergency:
      return check_service(logged, address);
    case Service::sync:
    case Service::time_stamp:
    case Service::lss_request:
    case Service::lss_answer:
    case Service::none:
      return;
  }
}

void NodeStates::enter(Node& node, NmtState state, canopen::Time at) {
  if (node.state != state) node.since = at;
  node.state = state;
  node.reported = false;
}

// An order to all nodes counts for each node of the description; the master executes its own orders by itself.
void NodeStates::on_order(const LogFrame& logged) {
  const auto order = canopen::nmt_order_from(logged.frame);
  if (!order) return;
  const auto obey = [&](Node& node) {
    switch (order->command) {
      case NmtCommand::reset_node:
      case NmtCommand::reset_communication:
        return enter(node, NmtState::boot_up, logged.at);
      case NmtCommand::start:
        if (node.state != NmtState::boot_up) enter(node, NmtState::operational, logged.at);
        return;
      case NmtCommand::stop:
        if (node.state != NmtState::boot_up) enter(node, NmtState::stopped, logged.at);
        return;
      case NmtCommand::enter_pre_operational:
        if (node.state != NmtState::boot_up) enter(node, NmtState::pre_operational, logged.at);
        return;
    }
  };
  if (order->node != 0) return obey(nodes_[order->node]);
  for (const auto& [id, name] : network_.names()) {
    if (!network_.is_master(id)) obey(nodes_[id]);
  }
}

void NodeStates::on_heartbeat(const LogFrame& logged, NodeId id) {
  const auto heartbeat = canopen::error_control_from(logged.frame);
  if (!heartbeat || network_.is_master(id)) return;
  Node& node = nodes_[id];
  if (heartbeat->state == NmtState::boot_up) return enter(node, NmtState::pre_operational, logged.at);
  check_boot_up(logged, id);
  const bool is_news = logged.at - node.since > options_.heartbeat_wait;
  if (!node.state || (node.state != NmtState::boot_up && is_news)) enter(node, heartbeat->state, logged.at);
}

void NodeStates::check_boot_up(const LogFrame& logged, NodeId id) {
  Node& node = nodes_[id];
  const bool waited =
      address_of(logged.frame.id).service == Service::heartbeat && logged.at - node.since <= options_.heartbeat_wait;
  if (node.state != NmtState::boot_up || node.reported || waited || may_have_crossed(node, logged)) return;
  node.reported = true;
  findings_.add(logged, rule::boot_up, "{} sends before its boot-up message, after it was reset", network_.name(id));
}

void NodeStates::check_pdo(const LogFrame& logged, const Address& address) {
  Node& node = nodes_[address.node];
  const bool from_node = address.service == Service::transmit_pdo;
  if (from_node) check_boot_up(logged, address.node);
  const bool waits_for_boot_up = from_node && node.state == NmtState::boot_up;
  if (!node.state || node.state == NmtState::operational || waits_for_boot_up || may_have_crossed(node, logged)) return;
  findings_.add(logged, rule::nmt_state, "a PDO {} {}, which is {}", from_node ? "of" : "for",
                network_.name(address.node),
                node.state == NmtState::boot_up ? "starting" : canopen::describe(*node.state));
}

void NodeStates::check_service(const LogFrame& logged, const Address& address) {
  Node& node = nodes_[address.node];
  if (address.service != Service::sdo_request) check_boot_up(logged, address.node);
  if (node.state != NmtState::stopped || may_have_crossed(node, logged)) return;
  findings_.add(logged, rule::nmt_state, "{} {} {}, which is stopped: it has no SDO and no EMCY then",
                address.service == Service::emergency ? "an EMCY" : "an SDO",
                address.service == Service::sdo_request ? "for" : "of", network_.name(address.node));
}

}  // namespace kenaf::canlog
