// A world server of a few lines for the relay's tests: one robot on two ideal tracks that reach any speed at once, so
// that where it is follows from the commands alone. Wheel radius 0.05 m, 0.001 rad a tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "formats/protocol/usarsim_message.hpp"
#include "relayd/sockets.hpp"

namespace kenaf::test {

struct FakeWorldOptions {
  bool extended = true;    // knows CONTROL, PING and {Frame n}
  std::uint16_t port = 0;  // 0: any
  std::string garbage;     // sent before each frame
  std::size_t piece = 0;   // bytes a send() carries at most, 0: all
  bool accepts_robot = true;
};

class FakeWorld {
 public:
  explicit FakeWorld(const FakeWorldOptions& options = {});
  ~FakeWorld();  // closes everything

  std::uint16_t port() const { return port_; }
  int connections() const { return connections_; }       // so far
  std::vector<std::string> lines() const;                // received so far, over all connections
  int count(const std::string& beginning) const;         // of lines that begin so
  std::string last(const std::string& beginning) const;  // "" where there is none
  double x_m() const { return x_m_; }
  double speed_mps() const { return speed_mps_; }
  void mute(bool on) { mute_ = on; }                      // keeps the connection and says nothing
  void close_at_control() { closes_at_control_ = true; }  // the next one, instead of answering; then it is there again

 private:
  void run();
  void serve(int fd);
  bool handle(const std::string& line, int fd);
  void step();
  void send_frame(int fd);
  void send_text(int fd, const std::string& text);

  const FakeWorldOptions options_;
  relayd::Descriptor listener_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false}, mute_{false}, closes_at_control_{false};
  std::atomic<int> connections_{0};
  std::atomic<double> x_m_{0}, speed_mps_{0};
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;

  // Of the connection.
  bool has_robot_ = false, lockstep_ = false, numbered_ = false, owes_frame_ = false;
  double period_s_ = 0.2, time_s_ = 0;
  std::int64_t frame_ = 0, late_ = 0;
  double left_radps_ = 0, right_radps_ = 0, left_rad_ = 0, right_rad_ = 0;
  std::map<std::string, double> joints_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace kenaf::test
