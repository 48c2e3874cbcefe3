// The rules that can be checked on a single frame: identifier, length, content, and messages of the driver.
#pragma once

#include <set>

#include "can/canlog/findings.hpp"
#include "can/canlog/pdo_setup.hpp"

namespace kenaf::canlog {

class FrameRules {
 public:
  // All arguments must outlive this.
  FrameRules(const Network& network, const PdoSetup& setup, Findings& findings)
      : network_(network), setup_(setup), findings_(findings) {}

  // Returns false if the frame does not fit its identifier, so that nothing more can be checked.
  bool check(const LogFrame& logged, const Address& address);

 private:
  void check_other_kind(const LogFrame& logged, const Address& address);
  void check_remote(const LogFrame& logged, const Address& address);
  std::string strangeness(std::uint16_t cob_id, const Address& address) const;
  bool check_identifier(const LogFrame& logged, const Address& address);
  bool check_length(const LogFrame& logged, const Address& address);
  bool check_content(const LogFrame& logged, const Address& address);

  const Network& network_;
  const PdoSetup& setup_;
  Findings& findings_;
  // each reported once: an unexpected sender repeats itself
  std::set<std::uint16_t> strange_ids_, strange_requests_;
  std::set<canopen::FrameKind> strange_kinds_;
};

}  // namespace kenaf::canlog
