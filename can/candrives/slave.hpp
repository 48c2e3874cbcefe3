// One CANopen node without its device profile: the behaviour common to all slaves. CiA 301.
//
//   NMT          boot-up message, pre-operational, operational, stopped; the two resets                   7.2.8, 7.3.2
//   SDO          its object dictionary, read and written by the master                                    7.2.4
//   PDO, SYNC    process_data.hpp; RPDOs that stay away for longer than their event timer                 7.2.2, 7.2.5
//   heartbeat    its own (object 0x1017), and the master's, which it watches (0x1016)                     7.2.8.2.2
//   guarding     answers to the master's requests, and the watch for them (0x100C, 0x100D)                7.2.8.2.1
//   emergency    error_state.hpp                                                                          7.2.7
//
//                     power on, reset node
//                              | boot-up message
//                              v
//          stopped <---> pre-operational <---> operational        What works: SDO in the latter two, PDO in the last,
//             ^                                     ^             NMT and heartbeats in all.
//             +-------------------------------------+
//
// A device profile derives from it and adds objects and reactions to writes. Frames and times go in, frames come out;
// no clock and no socket. Neither copyable nor movable: its parts refer to each other.
#pragma once

#include <string>

#include "can/candrives/dictionary.hpp"
#include "can/candrives/error_state.hpp"
#include "can/candrives/process_data.hpp"
#include "can/candrives/quirks.hpp"
#include "can/canopen/nmt.hpp"
#include "can/canopen/sdo_server.hpp"

namespace kenaf::candrives {

struct DeviceIdentity {
  std::uint32_t device_type = 0;  // object 0x1000: the lower 16 bits are the profile
  std::string name;               // 0x1008
  std::uint32_t vendor_id = 0, product_code = 0, revision = 0, serial_number = 0;  // 0x1018
};

class Slave {
 public:
  Slave(canopen::NodeId node, const DeviceIdentity& identity, const std::vector<DefaultPdo>& pdos);
  virtual ~Slave() = default;
  Slave(const Slave&) = delete;
  Slave& operator=(const Slave&) = delete;

  canopen::NodeId node() const { return node_; }
  canopen::NmtState state() const { return state_; }
  const Dictionary& objects() const { return objects_; }

  const Quirks& quirks() const { return quirks_; }
  void set_quirks(const Quirks& quirks);

  // All objects at their initial values, then the boot-up message.
  void power_on(canopen::Time now, Frames& out);
  void on_frame(const canopen::Frame& frame, canopen::Time now, Frames& out);
  // Sends heartbeats, event-driven PDOs and messages of new errors, and watches the master's heartbeat.
  void on_time(canopen::Time now, Frames& out);
  // Returns when on_time has something to do, as far as known now; Time::max(): not before a frame arrives.
  canopen::Time deadline() const;
  // True if it sends PDOs on data changes, so that on_time should be called after every change.
  bool follows_data() const;

  // Faults: it does not notice that the master's heartbeat ends, or that RPDOs stay away.
  void ignore_heartbeat(bool ignore);
  void ignore_event_timer(bool ignore) { event_timer_ignored_ = ignore; }

 protected:
  // The deriving class adds the objects of its device profile in its constructor.
  Dictionary& dictionary() { return objects_; }
  ErrorState& errors() { return errors_; }

  // Quirks have changed.
  virtual void on_quirks() {}
  // A PDO came too soon after the one before, for a node that is slow to take them, and is lost.
  virtual void on_overrun() {}
  // True for objects that the node has by its profile, but not with its quirks.
  virtual bool lacks(canopen::ObjectAddress) const { return false; }
  // True while objects are written by a PDO, not by SDO.
  bool takes_pdo() const { return takes_pdo_; }
  // Power on or node reset; objects have their initial values.
  virtual void on_reset() {}
  // Brings measurements into the dictionary before they are read or sent.
  virtual void refresh() {}
  virtual std::optional<canopen::SdoAbort> check_write(canopen::ObjectAddress, std::int64_t) { return std::nullopt; }
  virtual void on_write(canopen::ObjectAddress, std::int64_t) {}
  // The master is gone or has cut the connection: heartbeat lost, NMT stop, or communication reset; the list of CiA
  // 402-2, abort connection option code. The same, chosen, where an RPDO stays away: CiA 301 leaves that to the device.
  // `error_code`: of the emergency message that tells the cause.
  virtual void on_connection_lost(std::uint16_t error_code) { static_cast<void>(error_code); }

 private:
  canopen::ObjectAccess object_access();
  void on_order(canopen::NmtCommand command, canopen::Time now, Frames& out);
  void begin_boot(canopen::Time now, Frames& out);
  void boot(canopen::Time now, Frames& out);
  void on_guard_request(canopen::Time now, Frames& out);
  bool is_hidden(canopen::ObjectAddress at) const;
  bool comes_too_soon(const canopen::Frame& frame);
  void reset_communication();
  void enter(canopen::NmtState state);
  void on_sync(const canopen::Frame& frame, canopen::Time now, Frames& out);
  void on_heartbeat(const canopen::Heartbeat& heartbeat, canopen::Time now);
  void watch_master(canopen::Time now);
  void watch_commands(canopen::Time now);
  void send_messages(canopen::Time now, Frames& out);
  std::optional<canopen::SdoAbort> check(canopen::ObjectAddress object, std::int64_t value);
  void written(canopen::ObjectAddress object, std::int64_t value);

  canopen::NodeId node_;
  Dictionary objects_;
  ProcessData process_data_;
  canopen::SdoServer sdo_;
  ErrorState errors_;
  canopen::NmtState state_ = canopen::NmtState::boot_up;
  canopen::Time next_heartbeat_ = canopen::Time::max();
  canopen::Time master_lost_at_ = canopen::Time::max();  // max: not received yet, or already lost
  bool heartbeat_ignored_ = false, event_timer_ignored_ = false;
  bool heartbeat_changed_ = false;                // object 0x1017 was written: takes effect at once
  canopen::Time boot_at_ = canopen::Time::max();  // slow boot
  bool guard_toggle_ = false;                     // of the next answer
  bool takes_pdo_ = false;
  Quirks quirks_;
  int syncs_since_pdo_ = kSyncsOfSlowCommand;
};

}  // namespace kenaf::candrives
