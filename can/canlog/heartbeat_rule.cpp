#include "can/canlog/heartbeat_rule.hpp"

namespace kenaf::canlog {

namespace {

constexpr std::uint16_t kConsumerHeartbeat = 0x1016;

}  // namespace

void HeartbeatRule::on_write(const WrittenObject& written) {
  if (written.object.index != kConsumerHeartbeat || written.object.sub == 0) return;
  const Key key{written.node, written.object.sub};
  const auto producer = static_cast<canopen::NodeId>(written.number() >> 16 & 0x7f);
  const std::chrono::milliseconds patience(written.number() & 0xffff);
  watches_.erase(key);
  if (producer != 0 && patience.count() > 0) watches_.emplace(key, Watch{producer, patience, std::nullopt});
}

void HeartbeatRule::on_restart(canopen::NodeId node) {
  std::erase_if(watches_, [node](const auto& entry) { return entry.first.consumer == node; });
}

void HeartbeatRule::on_frame(const LogFrame& logged, const Address& address) {
  check(logged);
  if (address.service != Service::heartbeat) return;
  for (auto& [key, watch] : watches_) {
    if (watch.producer != address.node) continue;
    watch.last = logged;
    watch.reported = false;
  }
}

void HeartbeatRule::check(const LogFrame& now) {
  for (auto& [key, watch] : watches_) {
    if (!watch.last || watch.reported || now.at - watch.last->at <= watch.patience) continue;
    watch.reported = true;
    findings_.add(*watch.last, rule::master_heartbeat,
                  "after this heartbeat of {} comes none for {} ms, the time of {}", network_.name(watch.producer),
                  std::chrono::duration_cast<std::chrono::milliseconds>(watch.patience).count(),
                  network_.name(key.consumer));
  }
}

}  // namespace kenaf::canlog
