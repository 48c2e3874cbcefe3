// Quality of the link to the control process, from the datagrams alone. Plain state; the caller passes the time,
// seconds of one steady clock.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "link.hpp"

namespace kenaf::teleop {

class LinkHealth {
 public:
  void sent(std::uint32_t sequence, double now_s);
  // Returns true if it is the newest so far, and counts.
  bool heard(const Status& status, double now_s);

  // Seconds since the newest status; nullopt before the first.
  std::optional<double> silence_s(double now_s) const;
  // Round trip of the newest status that echoes a new wish, without the time that the control process kept the wish.
  std::optional<double> round_trip_s() const { return round_trip_s_; }
  // Lost datagrams in percent over the last kWindow_s; 0 if none was due.
  double loss_up_percent() const;
  double loss_down_percent() const;
  std::uint32_t newest_status() const { return newest_ ? newest_->sequence : 0; }

 private:
  static constexpr double kWindow_s = 5;
  struct Counts {
    double at_s;
    std::uint32_t newest_wish, wishes_received, newest_status, statuses_received;
  };

  std::array<double, 256> sent_at_s_{};  // indexed by the sequence's last byte: 12 s of wishes
  std::uint32_t newest_sent_ = 0;
  struct Newest {
    std::uint32_t sequence, wish;
    double at_s;
  };
  std::optional<Newest> newest_;
  std::uint32_t statuses_received_ = 0;
  std::optional<double> round_trip_s_;
  std::deque<Counts> window_;  // oldest first
};

}  // namespace kenaf::teleop
