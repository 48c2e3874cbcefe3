#include "can/canlog/rules.hpp"

#include <algorithm>
#include <array>

#include "can/canlog/drive_rules.hpp"
#include "can/canlog/findings.hpp"
#include "can/canlog/frame_rules.hpp"
#include "can/canlog/guarding_rule.hpp"
#include "can/canlog/heartbeat_rule.hpp"
#include "can/canlog/loop_span.hpp"
#include "can/canlog/node_states.hpp"
#include "can/canlog/pdo_setup.hpp"
#include "can/canlog/sdo_dialogue.hpp"
#include "can/canlog/sync_rules.hpp"

namespace kenaf::canlog {
namespace {

// Each part tracks the bus in its own way; the Checker determines which parts get which frames, and in which order.
class Checker {
 public:
  Checker(const Network& network, const CheckOptions& options)
      : network_(network),
        setup_(network, findings_),
        frames_(network, setup_, findings_),
        states_(network, options, findings_),
        dialogue_(network, options, findings_),
        sync_(network, options, states_, setup_, findings_),
        heartbeat_(network, findings_),
        guarding_(network, findings_),
        drives_(network, options, findings_) {}

  void on_frame(const LogFrame& logged) {
    const Address address = setup_.address_of(logged.frame.id);
    if (logged.kind == canopen::FrameKind::remote && address.service == Service::heartbeat)
      guarding_.on_request(address.node);
    if (!frames_.check(logged, address)) return;
    states_.on_frame(logged, address);
    for (const auto& [node, name] : network_.names()) {
      if (NodeStates::is_restart(logged, address, node)) on_restart(node);
    }
    on_start(logged);
    if (const auto written = dialogue_.on_frame(logged, address)) {
      setup_.on_write(logged, *written);
      sync_.on_write(*written);
      heartbeat_.on_write(*written);
      drives_.on_write(*written);
    }
    sync_.on_frame(logged, address);
    heartbeat_.on_frame(logged, address);
    guarding_.on_frame(logged, address);
    drives_.on_frame(logged, setup_.pdo(logged.frame.id));
  }

  void check_loop(const Log& log, const LoopSpan& span) {
    for (std::size_t i = span.first; i <= span.last; ++i) {
      const LogFrame& logged = log.frames[i];
      const Address address = address_of(logged.frame.id);
      const bool is_request = logged.kind == canopen::FrameKind::data && address.service == Service::sdo_request;
      if (!is_request || network_.is_other(address.node) || logged.frame.length != canopen::kMaxFrameBytes) continue;
      findings_.add(logged, rule::sdo_in_loop, "an SDO for {} while the robot is driven", network_.name(address.node));
    }
  }

  std::vector<Violation> finish(const LogFrame& last) {
    dialogue_.on_end(last);
    heartbeat_.on_end(last);
    std::vector<Violation> found = findings_.take();
    std::ranges::stable_sort(found, {}, &Violation::line);
    return found;
  }

 private:
  void on_restart(canopen::NodeId node) {
    setup_.on_restart(node);
    dialogue_.on_restart(node);
    sync_.on_restart(node);
    heartbeat_.on_restart(node);
    guarding_.on_restart(node);
    drives_.on_restart(node);
  }
  void on_start(const LogFrame& logged) {
    const auto order = canopen::nmt_order_from(logged.frame);
    if (!order || order->command != canopen::NmtCommand::start) return;
    for (const auto& [node, name] : network_.names()) {
      if (order->node == 0 || order->node == node) setup_.on_start(logged, node);
    }
  }

  const Network& network_;
  Findings findings_;
  PdoSetup setup_;
  FrameRules frames_;
  NodeStates states_;
  SdoDialogue dialogue_;
  SyncRules sync_;
  HeartbeatRule heartbeat_;
  GuardingRule guarding_;
  DriveRules drives_;
};

}  // namespace

std::span<const Rule* const> all_rules() {
  static constexpr std::array kAll{&rule::identifier, &rule::length,           &rule::content,     &rule::node_guarding,
                                   &rule::bus_off,    &rule::boot_up,          &rule::nmt_state,   &rule::sdo_dialogue,
                                   &rule::sdo_block,  &rule::sdo_time,         &rule::sdo_in_loop, &rule::pdo_setup,
                                   &rule::sync_pdo,   &rule::master_heartbeat, &rule::controlword, &rule::fault_reset,
                                   &rule::statusword, &rule::set_point,        &rule::target};
  return kAll;
}

std::vector<Violation> check_rules(const Log& log, const Network& network, const CheckOptions& options) {
  if (log.frames.empty()) return {};
  Checker checker(network, options);
  for (const LogFrame& logged : log.frames) checker.on_frame(logged);
  for (const LoopSpan& span : loop_spans(log, network)) checker.check_loop(log, span);
  return checker.finish(log.frames.back());
}

}  // namespace kenaf::canlog
