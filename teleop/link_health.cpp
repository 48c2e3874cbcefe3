#include "link_health.hpp"

#include <algorithm>

namespace kenaf::teleop {

namespace {

// Duplicated datagrams can make more arrive than were sent.
double percent_lost(std::uint32_t due, std::uint32_t received) {
  if (due == 0) return 0;
  return 100.0 * (due - std::min(due, received)) / due;
}

}  // namespace

void LinkHealth::sent(std::uint32_t sequence, double now_s) {
  sent_at_s_[sequence % sent_at_s_.size()] = now_s;
  newest_sent_ = sequence;
}

bool LinkHealth::heard(const Status& status, double now_s) {
  ++statuses_received_;
  const bool is_known = status.newest_wish <= newest_sent_ && newest_sent_ - status.newest_wish < sent_at_s_.size();
  if (newest_ && status.sequence <= newest_->sequence) {
    // A restarted control process counts anew; a datagram that is merely late echoes no newer wish.
    if (!is_known || status.newest_wish <= newest_->wish) return false;
    window_.clear();
  }
  if (is_known && status.newest_wish > (newest_ ? newest_->wish : 0)) {
    const double echo_s = now_s - sent_at_s_[status.newest_wish % sent_at_s_.size()] - status.wish_age_s;
    round_trip_s_ = std::max(0.0, echo_s);
  }
  newest_ = {status.sequence, status.newest_wish, now_s};
  window_.push_back({now_s, status.newest_wish, status.wishes_received, status.sequence, statuses_received_});
  while (now_s - window_.front().at_s > kWindow_s) window_.pop_front();
  return true;
}

std::optional<double> LinkHealth::silence_s(double now_s) const {
  return newest_ ? std::optional(now_s - newest_->at_s) : std::nullopt;
}

double LinkHealth::loss_up_percent() const {
  if (window_.empty()) return 0;
  const Counts &first = window_.front(), &last = window_.back();
  return percent_lost(last.newest_wish - first.newest_wish, last.wishes_received - first.wishes_received);
}

double LinkHealth::loss_down_percent() const {
  if (window_.empty()) return 0;
  const Counts &first = window_.front(), &last = window_.back();
  return percent_lost(last.newest_status - first.newest_status, last.statuses_received - first.statuses_received);
}

}  // namespace kenaf::teleop
