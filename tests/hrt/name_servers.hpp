// What answers look-ups of names in tests, without a network.
#pragma once

#include <netdb.h>

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "libkenaf_sim/addresses.hpp"

namespace kenaf::hrt::test {

// Answers nothing while it lives.
class SilentNameServer {
 public:
  SilentNameServer() = default;
  ~SilentNameServer() { end_.set_value(); }  // late look-ups end with the test
  SilentNameServer(const SilentNameServer&) = delete;
  SilentNameServer& operator=(const SilentNameServer&) = delete;

  sim::AskForAddresses ask() const {
    return [ended = ended_, asked = asked_](const protocol::HostPort&, int, sim::Addresses&) {
      ++*asked;
      ended.wait();
      return EAI_AGAIN;
    };
  }
  int asked() const { return *asked_; }

 private:
  std::promise<void> end_;
  std::shared_future<void> ended_ = end_.get_future().share();
  std::shared_ptr<std::atomic<int>> asked_ = std::make_shared<std::atomic<int>>(0);
};

// Every name has these addresses, in digits, in this order.
inline sim::AskForAddresses name_of(std::vector<protocol::HostPort> addresses) {
  return [addresses = std::move(addresses)](const protocol::HostPort&, int socket_type, sim::Addresses& found) {
    for (const protocol::HostPort& address : addresses)
      if (const int wrong = sim::ask_system(address, socket_type, found); wrong != 0) return wrong;
    return 0;
  };
}

}  // namespace kenaf::hrt::test
