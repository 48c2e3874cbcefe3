// TCP between a client and a server as a network carries it that can be taken away: from cut() on, the connections
// there are carry nothing any more, not even their ends, and stay open on both sides. Later ones are carried. It may
// delay what it carries, each way.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <thread>
#include <vector>

namespace kenaf::support {

// Thread safety: cut() from any thread.
class TcpProxy {
 public:
  // To the server at 127.0.0.1:`server_port`; all bytes come later by `each_way`. Throws std::system_error.
  explicit TcpProxy(std::uint16_t server_port, std::chrono::milliseconds each_way = {});
  ~TcpProxy();
  TcpProxy(const TcpProxy&) = delete;
  TcpProxy& operator=(const TcpProxy&) = delete;

  std::uint16_t port() const { return port_; }
  void cut() { cuts_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  // Bytes under way; none: the end.
  struct Way {
    struct Piece {
      Clock::time_point due;
      std::string bytes;
    };
    int from, to;
    std::deque<Piece> under_way{};
    bool has_ended = false;
  };
  struct Pair {
    Way there, back;
    bool is_cut = false;
  };

  void run();
  void accept();
  void take(Way& way);
  static bool deliver(Way& way, Clock::time_point now);  // false: the way is over
  int wait_ms() const;

  int listener_;
  std::chrono::milliseconds each_way_;
  std::uint16_t server_port_, port_ = 0;
  std::vector<Pair> pairs_;
  std::atomic<bool> stopping_{false}, cuts_{false};
  std::thread thread_;
};

}  // namespace kenaf::support
