// The master on the bus: waiting, with its heartbeat continuing meanwhile, and SDO for the set-up.
//
// The heartbeat is sent from the waits here, and not by a thread or timer of its own: a program that hangs must not
// appear alive.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "can/canopen/bus.hpp"
#include "can/canopen/pdo.hpp"
#include "can/canopen/sdo_client.hpp"
#include "hrt/error.hpp"

namespace kenaf::real {

// A node and its role on the robot: "flipper rear left (node 5)".
struct NamedNode {
  canopen::NodeId node;
  std::string_view name;
};
std::string to_string(const NamedNode& node);

// Called with every frame that arrives, also during other waits.
using FrameWatch = std::function<void(const canopen::ReceivedFrame&)>;

// The bus works and the drives obey, but this program is not their only master: they must be commanded to stop, and
// nothing else.
class ControlLost : public hrt::Error {
 public:
  using hrt::Error::Error;
};
// A foreign heartbeat with this master's node id was received. CiA 301, 7.2.8.2.2: a node id has one producer.
class OtherMaster : public ControlLost {
 public:
  using ControlLost::ControlLost;
};
// No heartbeat was sent for so long that the drives have stopped by themselves, or the computer was suspended.
class HeldUp : public ControlLost {
 public:
  using ControlLost::ControlLost;
};

// A node refused an SDO transfer, or did not answer it.
class SdoRefused : public hrt::Error {
 public:
  SdoRefused(const std::string& words, canopen::ObjectAddress at, std::int64_t to_write, canopen::SdoAbort why)
      : hrt::Error(HRT_E_DEVICE, words), object(at), value(to_write), abort(why) {}
  canopen::ObjectAddress object;
  std::int64_t value;  // that was to be written; 0 for a read
  canopen::SdoAbort abort;
};

class Master {
 public:
  Master(canopen::Bus& bus, canopen::NodeId own_node, canopen::Time heartbeat, canopen::Time answer_patience);

  canopen::Bus& bus() { return bus_; }
  canopen::Time now() const { return bus_.now(); }
  void send(const canopen::Frame& frame) { bus_.send(frame); }

  // From now on receive() sends a heartbeat whenever one is due.
  void start_heartbeat();
  void stop_heartbeat() { next_heartbeat_.reset(); }
  // From now on the node is asked by node guarding, with each heartbeat: it watches for that instead of the heartbeat.
  void guard(canopen::NodeId node);
  // From now on the drives obey: a pause of `silence` in the heartbeat ends that, or a suspend of the computer of any
  // length, which the clock of the pauses does not count. receive() and check_pause() then throw HeldUp, once, before
  // anything else is sent. Drives whose watch had restarted would otherwise follow the next command as if nothing had
  // happened.
  void watch_pauses(canopen::Time silence);
  void check_pause();

  void watch(FrameWatch watch) { watch_ = std::move(watch); }
  // As Bus::receive. Throws ControlLost.
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until);
  // Waits until `done` holds, checking after each frame; returns false at `until` or if interrupted.
  bool wait_until(canopen::Time until, const std::function<bool()>& done);
  bool was_interrupted() const { return interrupted_; }

  // Throw SdoRefused naming node, object, purpose and reason: aborted by the node, or no answer.
  std::int64_t read(const NamedNode& node, const canopen::MappedObject& object, std::string_view purpose);
  void write(const NamedNode& node, const canopen::SdoWrite& write);
  // nullopt or false if the node has no such object.
  std::optional<std::int64_t> read_if_there(const NamedNode& node, const canopen::MappedObject& object);
  bool write_if_there(const NamedNode& node, const canopen::SdoWrite& write);

 private:
  void send_heartbeat();
  void refuse_own_heartbeat(const canopen::ReceivedFrame& received) const;
  canopen::SdoOutcome run(canopen::SdoClient& client, const canopen::Frame& first);

  canopen::Bus& bus_;
  canopen::NodeId own_node_;
  canopen::Time heartbeat_, answer_patience_;
  std::optional<canopen::Time> next_heartbeat_, longest_pause_;
  canopen::Time suspended_before_{};  // before the pauses were watched
  FrameWatch watch_;
  std::vector<canopen::NodeId> guarded_;
  bool interrupted_ = false;
};

canopen::Time to_time(double seconds);

}  // namespace kenaf::real
