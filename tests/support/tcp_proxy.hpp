// TCP between a client and a server as a network carries it that can be taken away: from cut() on, the connections
// there are carry nothing any more, not even their ends, and stay open on both sides. Later ones are carried.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace kenaf::support {

// Thread safety: cut() from any thread.
class TcpProxy {
 public:
  // To the server at 127.0.0.1:`server_port`. Throws std::system_error.
  explicit TcpProxy(std::uint16_t server_port);
  ~TcpProxy();
  TcpProxy(const TcpProxy&) = delete;
  TcpProxy& operator=(const TcpProxy&) = delete;

  std::uint16_t port() const { return port_; }
  void cut() { cuts_ = true; }

 private:
  struct Pair {
    int client, server;
    bool is_cut = false;
  };

  void run();
  void accept();
  static bool pass(int from, int to);  // false: the other side has closed

  int listener_;
  std::uint16_t server_port_, port_ = 0;
  std::vector<Pair> pairs_;
  std::atomic<bool> stopping_{false}, cuts_{false};
  std::thread thread_;
};

}  // namespace kenaf::support
