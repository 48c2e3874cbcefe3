// Synchronous PDOs: one at each of its SYNCs, within the window. CiA 301, 7.2.2.2 and 7.2.2.3. The gyro's are exempt:
// its device decides when it sends.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"
#include "can/canlog/node_states.hpp"
#include "can/canlog/pdo_setup.hpp"

namespace kenaf::canlog {

class SyncRules {
 public:
  // All arguments must outlive this.
  SyncRules(const Network& network, const CheckOptions& options, const NodeStates& states, const PdoSetup& setup,
            Findings& findings)
      : network_(network), options_(options), states_(states), setup_(setup), findings_(findings) {}

  void on_frame(const LogFrame& logged, const Address& address);
  void on_write(const WrittenObject& written);
  void on_restart(canopen::NodeId node);

 private:
  struct Sent {
    canopen::NodeId node = 0;
    unsigned syncs = 0;     // since the last transmission, or since it could send
    bool in_phase = false;  // the SYNCs at which it sends are known
  };
  void on_sync(const LogFrame& logged);
  void on_pdo(const LogFrame& logged);
  std::string name(std::uint16_t cob_id) const;
  // nullopt: not synchronous, or unknown
  std::optional<unsigned> each(std::uint16_t cob_id) const;

  const Network& network_;
  const CheckOptions& options_;
  const NodeStates& states_;
  const PdoSetup& setup_;
  Findings& findings_;
  std::optional<LogFrame> sync_;
  std::optional<canopen::Time> written_window_;
  std::map<std::uint16_t, Sent> sent_;  // for nodes that were operational at the last SYNC
};

}  // namespace kenaf::canlog
