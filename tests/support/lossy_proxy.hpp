// UDP between a client and a server as a bad network carries it: datagrams are lost, doubled, late and overtaken.
// Seeded.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <thread>

namespace kenaf::support {

struct Network {
  double lost = 0.2, doubled = 0.2;  // shares of the datagrams
  double delayed = 0.25;             // share that takes up to `delay` longer
  std::chrono::microseconds delay{8000};
  std::chrono::microseconds latency{0};  // of all, each way
};

struct ProxyHooks {
  std::function<void()> at_start{};                                           // first of all, on the proxy's thread
  std::function<void(bool to_server, std::span<const std::byte>)> passing{};  // before its fate is drawn
};

// Serves one client, the one that sent last. Thread safety: cut() from any thread; the hooks run on the proxy's.
class LossyProxy {
 public:
  // To the server at 127.0.0.1:`server_port`. Throws std::system_error.
  LossyProxy(std::uint16_t server_port, unsigned seed, const Network& network = {}, ProxyHooks hooks = {});
  ~LossyProxy();
  LossyProxy(const LossyProxy&) = delete;
  LossyProxy& operator=(const LossyProxy&) = delete;

  std::uint16_t port() const { return port_; }
  // While it is cut nothing passes in either direction; what is under way is lost too.
  void cut(bool is_cut) { is_cut_ = is_cut; }

 private:
  void run(unsigned seed, Network network, const ProxyHooks& hooks);

  int client_side_, server_side_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false}, is_cut_{false};
  std::thread thread_;
};

}  // namespace kenaf::support
