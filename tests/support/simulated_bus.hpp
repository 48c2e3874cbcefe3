// A CAN bus in this process whose slaves are the simulated ones, for tests of a master: nothing waits for a clock. Time
// stands still while the master computes, and runs in receive() and run_until(), from one event to the next.
//
// One frame is on the bus at a time. Of those that wait, the lowest identifier goes first; each takes its longest
// possible time at 500 kbit/s (worst_case_bits) and reaches everybody at its end.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "can/candrives/ideal_plant.hpp"
#include "can/candrives/robot_slaves.hpp"
#include "can/canopen/bus.hpp"

namespace kenaf::candrives {

inline constexpr canopen::Time kBitTime = std::chrono::microseconds(2);  // 500 kbit/s
canopen::Time time_on_bus(const canopen::Frame& frame);

enum class Sender { master, slaves, other };  // other: somebody else on the bus, heard by both

struct LoggedFrame {
  canopen::Time at;  // when it was received
  canopen::Frame frame;
  Sender sender;
};

class SimulatedBus final : public canopen::Bus {
 public:
  // The slaves get power at time 0. The plant outlives the bus.
  SimulatedBus(const canbus::RobotBus& bus, Plant& plant);

  // ---- canopen::Bus ----
  canopen::Time now() const override { return now_ - suspended_; }
  canopen::Time suspended() override { return suspended_; }
  void send(const canopen::Frame& frame) override;
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until) override;
  void start_sync(canopen::Time period) override;  // the first one at once, as the kernel does
  void stop_sync() override;
  void interrupt() override { interrupted_ = true; }

  // ---- for tests ----
  RobotSlaves& slaves() { return slaves_; }
  void inject(const Fault& fault);
  void send_as_other(const canopen::Frame& frame) { put(frame, Sender::other); }
  const std::vector<LoggedFrame>& log() const { return log_; }  // everything that was on the bus
  double load() const;                                          // share of the time in which it was busy

  // Every frame before it goes onto the bus: may change it; false drops it.
  std::function<bool(canopen::Frame&, Sender)> alter;
  // The master is dead: nothing it sent or sends reaches the bus any more, its SYNC ends. It can still look on.
  void stop_master();
  // The interface is down: send, receive and start_sync throw BusError with `words`, and nothing is carried. Up again,
  // SYNC has to be started anew.
  void go_down(const std::string& words);
  void come_up() { down_.reset(); }
  // Time runs on without the master; what the slaves send is logged, and what was on its way to the master is lost to
  // it.
  void run_until(canopen::Time until);
  // The master is held up: time runs on, and what is sent to it waits in its socket.
  void hold_up_until(canopen::Time until);
  // The master's computer sleeps: its clock stands still, it sends no SYNC, and what is sent to it is lost.
  void suspend_until(canopen::Time until);
  // Another master, or the same with a new socket, in which nothing waits.
  void open_socket() { in_socket_.clear(); }

 private:
  struct Waiting {
    canopen::Frame frame;
    Sender sender;
    bool is_own_sync;
  };
  void put(const canopen::Frame& frame, Sender sender, bool is_own_sync = false);
  void put_all(Frames& frames);
  // The next event, not after `until`; a frame that reaches the master.
  std::optional<canopen::ReceivedFrame> step(canopen::Time until);
  std::optional<canopen::ReceivedFrame> deliver();
  void begin_frame();
  void check_up() const;

  RobotSlaves slaves_;
  canopen::Time now_{}, busy_{};
  canopen::Time suspended_{};  // so far: the master's clock is late by it
  std::vector<Waiting> waiting_;
  std::optional<Waiting> on_bus_;
  canopen::Time frame_ends_ = canopen::Time::max();
  std::deque<canopen::ReceivedFrame> in_socket_;
  std::optional<canopen::Time> sync_period_;
  canopen::Time next_sync_{};
  std::optional<std::string> down_;
  bool master_dead_ = false, interrupted_ = false;
  std::vector<LoggedFrame> log_;
};

}  // namespace kenaf::candrives
