#include "can/canlog/guarding_rule.hpp"

namespace kenaf::canlog {

void GuardingRule::on_frame(const LogFrame& logged, const Address& address) {
  if (address.service != Service::heartbeat) return;
  const auto answer = canopen::error_control_from(logged.frame);
  if (!answer || answer->state == canopen::NmtState::boot_up) return;
  Node& node = nodes_[address.node];

  // Heartbeats have the bit 0. A log without the requests has answers with 0 that look like them.
  if (!node.asked && !answer->toggle) {
    node.due.reset();
    return;
  }
  if (node.due && *node.due != answer->toggle) {
    findings_.add(logged, rule::node_guarding, "{} answers with the toggle bit {}, {} is due",
                  network_.name(address.node), answer->toggle ? 1 : 0, *node.due ? 1 : 0);
  }
  node = {.asked = false, .due = !answer->toggle};
}

}  // namespace kenaf::canlog
