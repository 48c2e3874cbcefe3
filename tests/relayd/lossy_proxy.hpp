// UDP between a program and the relay as a bad network carries it: a datagram in five is lost, one in five doubled,
// and some are held back and overtaken. Seeded.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "relayd/sockets.hpp"

namespace kenaf::test {

class LossyProxy {
 public:
  LossyProxy(std::uint16_t relay_port, unsigned seed);
  ~LossyProxy();
  std::uint16_t port() const { return port_; }

 private:
  void run(unsigned seed);

  relayd::Descriptor program_side_, relay_side_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace kenaf::test
