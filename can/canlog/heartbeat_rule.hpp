// The heartbeats that nodes watch, by their object 0x1016, never come further apart than allowed. CiA 301, 7.5.2.19;
// the watch begins with the first heartbeat after its configuration (7.2.8.3.2.2).
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class HeartbeatRule {
 public:
  // Both must outlive this.
  HeartbeatRule(const Network& network, Findings& findings) : network_(network), findings_(findings) {}

  void on_frame(const LogFrame& logged, const Address& address);
  void on_write(const WrittenObject& written);
  void on_restart(canopen::NodeId node);
  void on_end(const LogFrame& last) { check(last); }

 private:
  struct Watch {
    canopen::NodeId producer;
    canopen::Time patience;
    std::optional<LogFrame> last;  // the newest heartbeat
    bool reported = false;
  };
  struct Key {
    canopen::NodeId consumer;
    std::uint8_t sub;
    auto operator<=>(const Key&) const = default;
  };
  void check(const LogFrame& now);

  const Network& network_;
  Findings& findings_;
  std::map<Key, Watch> watches_;
};

}  // namespace kenaf::canlog
