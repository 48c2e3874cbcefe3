#include "can/canlog/sync_rules.hpp"

namespace kenaf::canlog {

namespace {

constexpr canopen::ObjectAddress kWindow{0x1007, 0};
constexpr unsigned kMaxSynchronous = 240;

double milliseconds(canopen::Time time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

void SyncRules::on_frame(const LogFrame& logged, const Address& address) {
  if (address.service == Service::sync) on_sync(logged);
  if (address.service == Service::transmit_pdo) on_pdo(logged);
}

void SyncRules::on_write(const WrittenObject& written) {
  if (written.object != kWindow) return;
  written_window_.reset();  // 0: there is none
  if (written.number() > 0) written_window_ = std::chrono::microseconds(written.number());
}

void SyncRules::on_restart(canopen::NodeId node) {
  std::erase_if(sent_, [&](const auto& entry) { return entry.second.node == node; });
}

std::optional<unsigned> SyncRules::each(std::uint16_t cob_id) const {
  const PdoInForce* pdo = setup_.pdo(cob_id);
  if (pdo == nullptr || pdo->is_gyro) return std::nullopt;
  const auto transmission = pdo->transmission;
  if (!transmission || *transmission == 0 || *transmission > kMaxSynchronous) return std::nullopt;
  return *transmission;
}

std::string SyncRules::name(std::uint16_t cob_id) const {
  const Address address = setup_.address_of(cob_id);
  return fmt::format("TPDO{} of {}", address.pdo, network_.name(address.node));
}

void SyncRules::on_sync(const LogFrame& logged) {
  for (const auto& [id, pdo] : setup_.in_force()) {
    if (!pdo.transmit || pdo.is_gyro) continue;
    if (!states_.was_operational(pdo.node, logged.at)) {
      sent_.erase(id);
      continue;
    }
    Sent& sent = sent_[id];
    sent.node = pdo.node;
    const auto n = each(id);
    if (n && sent.syncs >= *n) {
      findings_.add(*sync_, rule::sync_pdo, "{}, due at each {}SYNC, does not come at this one", name(id),
                    *n == 1 ? "" : fmt::format("{}th ", *n));
      sent = {.node = pdo.node};
    }
    ++sent.syncs;
  }
  sync_ = logged;
}

void SyncRules::on_pdo(const LogFrame& logged) {
  const std::uint16_t id = logged.frame.id;
  const auto n = each(id);
  const auto found = sent_.find(id);
  if (!n || !sync_ || found == sent_.end()) return;
  Sent& sent = found->second;
  if (sent.syncs == 0) {
    findings_.add(logged, rule::sync_pdo, "{} comes a second time for the SYNC of line {}", name(id), sync_->line);
    return;
  }
  if (sent.in_phase && sent.syncs < *n)
    findings_.add(logged, rule::sync_pdo, "{} comes after {} SYNCs, not {}", name(id), sent.syncs, *n);
  sent = {.node = sent.node, .in_phase = true};
  const auto window = options_.sync_window ? options_.sync_window : written_window_;
  if (window && logged.at - sync_->at > *window) {
    findings_.add(logged, rule::sync_pdo, "{} comes {:.2f} ms after SYNC, beyond the window of {:.2f} ms", name(id),
                  milliseconds(logged.at - sync_->at), milliseconds(*window));
  }
}

}  // namespace kenaf::canlog
