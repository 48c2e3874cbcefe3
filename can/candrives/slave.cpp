#include "can/candrives/slave.hpp"

#include <algorithm>

#include "can/canopen/device.hpp"

namespace kenaf::candrives {

using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::ObjectAddress;
using canopen::ObjectType;
using canopen::SdoAbort;
using canopen::Time;

namespace {

// Objects of the communication profile; a communication reset affects only these.
constexpr std::uint16_t kFirstCommunicationObject = 0x1000, kLastCommunicationObject = 0x1fff;
// Objects of the manufacturer and of the device profile.
constexpr std::uint16_t kFirstDeviceObject = 0x2000, kLastDeviceObject = 0x9fff;

// NMT reaction of a node to the loss of its master, object 0x1029:1.
enum CommunicationErrorBehaviour : std::int64_t { kToPreOperational = 0, kStay = 1, kStop = 2 };

void add_communication_objects(Dictionary& objects, canopen::NodeId node, const DeviceIdentity& identity) {
  const auto constant = [&](const canopen::MappedObject& at, std::int64_t value) {
    objects.add(at, Access::read_only, Mappable::no, value);
  };
  constant(canopen::object::device_type, identity.device_type);
  objects.add(canopen::object::error_register, Access::read_only, Mappable::transmit, 0);
  constant({{0x1005, 0}, ObjectType::unsigned32}, canopen::kSyncId);
  objects.add_text(canopen::object::device_name, identity.name);
  objects.add(canopen::object::guard_time_ms, Access::read_write, Mappable::no, 0);
  objects.add(canopen::object::life_time_factor, Access::read_write, Mappable::no, 0);
  constant(canopen::object::emergency_id, canopen::kEmergencyId + node);
  constant(canopen::object::consumer_heartbeat_count, 1);
  objects.add(canopen::object::consumer_heartbeat_1, Access::read_write, Mappable::no, 0, {0, 0x00ffffff});
  objects.add(canopen::object::producer_heartbeat_ms, Access::read_write, Mappable::no, 0);
  constant({{0x1018, 0}, ObjectType::unsigned8}, 4);
  constant(canopen::object::vendor_id, identity.vendor_id);
  constant(canopen::object::product_code, identity.product_code);
  constant(canopen::object::revision, identity.revision);
  constant(canopen::object::serial_number, identity.serial_number);
  constant({{0x1029, 0}, ObjectType::unsigned8}, 1);
  objects.add(canopen::object::communication_error_behaviour, Access::read_write, Mappable::no, kToPreOperational,
              {kToPreOperational, kStop});
}

}  // namespace

Slave::Slave(canopen::NodeId node, const DeviceIdentity& identity, const std::vector<DefaultPdo>& pdos)
    : node_(node), process_data_(node, objects_, pdos), sdo_(node, object_access()), errors_(node) {
  add_communication_objects(objects_, node, identity);
  objects_.on_check = [this](ObjectAddress at, std::int64_t value) { return check(at, value); };
  objects_.on_written = [this](ObjectAddress at, std::int64_t value) { written(at, value); };
}

canopen::ObjectAccess Slave::object_access() {
  return {[this](ObjectAddress at) -> std::variant<canopen::ObjectBytes, SdoAbort> {
            if (is_hidden(at)) return SdoAbort::no_object;
            refresh();
            return objects_.read(at);
          },
          [this](ObjectAddress at, std::span<const std::uint8_t> bytes) -> std::optional<SdoAbort> {
            if (is_hidden(at)) return SdoAbort::no_object;
            return objects_.write(at, bytes);
          }};
}

bool Slave::is_hidden(ObjectAddress at) const {
  const bool is_heartbeat = at.index == canopen::object::consumer_heartbeat_1.object.index ||
                            at.index == canopen::object::producer_heartbeat_ms.object.index;
  return (quirks_.guarding_only && is_heartbeat) || lacks(at);
}

void Slave::set_quirks(const Quirks& quirks) {
  quirks_ = quirks;
  process_data_.set_quirks({quirks.count_first, quirks.fixed_mapping, quirks.first_rpdo_fixed});
  on_quirks();
}

// ---- NMT ----

void Slave::power_on(Time now, Frames& out) {
  objects_.reset(kFirstDeviceObject, kLastDeviceObject);
  errors_.reset();
  reset_communication();
  on_reset();
  begin_boot(now, out);
}

void Slave::begin_boot(Time now, Frames& out) {
  if (!quirks_.slow_boot) return boot(now, out);
  state_ = NmtState::boot_up;
  boot_at_ = now + kSlowBoot;
}

void Slave::boot(Time now, Frames& out) {
  boot_at_ = Time::max();
  out.push_back(encode(canopen::Heartbeat{node_, NmtState::boot_up}));
  enter(NmtState::pre_operational);
  on_time(now, out);
}

void Slave::reset_communication() {
  objects_.reset(kFirstCommunicationObject, kLastCommunicationObject);
  // the watches are off again; boot-up is the first message
  errors_.forget(canopen::kErrorHeartbeat);
  errors_.forget(canopen::kErrorPdoTimeOut);
  sdo_ = canopen::SdoServer(node_, object_access());
  next_heartbeat_ = master_lost_at_ = Time::max();
  heartbeat_changed_ = guard_toggle_ = false;
  syncs_since_pdo_ = kSyncsOfSlowCommand;
}

void Slave::enter(NmtState state) {
  if (state == NmtState::operational && state_ != NmtState::operational) process_data_.begin();
  state_ = state;
}

void Slave::on_order(NmtCommand command, Time now, Frames& out) {
  switch (command) {
    case NmtCommand::start:
      return enter(NmtState::operational);
    case NmtCommand::enter_pre_operational:
      return enter(NmtState::pre_operational);
    case NmtCommand::stop:
      enter(NmtState::stopped);
      return on_connection_lost(canopen::kErrorHeartbeat);
    case NmtCommand::reset_node:
      return power_on(now, out);
    case NmtCommand::reset_communication:
      on_connection_lost(canopen::kErrorHeartbeat);  // before the objects that configure the reaction are reset
      reset_communication();
      return begin_boot(now, out);
  }
}

// ---- frames ----

void Slave::on_frame(const Frame& frame, Time now, Frames& out) {
  if (boot_at_ != Time::max()) return;
  // The master's heartbeat, or the time of its commands, may have expired before this frame came.
  watch_master(now);
  watch_commands(now);
  if (frame.remote) {
    if (canopen::guard_request_from(frame) == node_) on_guard_request(now, out);
    return;
  }
  // By kind: NMT for this node or all, heartbeats, SYNC, SDO (not while stopped), and PDOs (operational only).
  if (const auto order = canopen::nmt_order_from(frame)) {
    if (order->node == 0 || order->node == node_) on_order(order->command, now, out);
  } else if (const auto heartbeat = canopen::heartbeat_from(frame)) {
    on_heartbeat(*heartbeat, now);
  } else if (frame.id == canopen::kSyncId) {
    on_sync(frame, now, out);
  } else if (frame.id == canopen::kSdoRequestId + node_) {
    if (state_ == NmtState::stopped) return;
    if (const auto answer = sdo_.on_frame(frame)) out.push_back(*answer);
  } else if (state_ == NmtState::operational) {
    if (process_data_.receives(frame) && comes_too_soon(frame)) return on_overrun();
    takes_pdo_ = true;
    const ProcessData::Reception reception = process_data_.on_frame(frame, now);
    takes_pdo_ = false;
    switch (reception) {
      case ProcessData::Reception::not_for_me:
        return;
      case ProcessData::Reception::too_short:
        errors_.raise(canopen::kErrorPdoTooShort);
        break;
      case ProcessData::Reception::taken:
        errors_.clear(canopen::kErrorPdoTooShort);
        errors_.clear(canopen::kErrorPdoTimeOut);
        break;
    }
  }
  on_time(now, out);
}

void Slave::on_sync(const Frame& frame, Time now, Frames& out) {
  if (!canopen::is_sync(frame)) return errors_.raise(canopen::kErrorSyncLength);
  errors_.clear(canopen::kErrorSyncLength);
  if (syncs_since_pdo_ < kSyncsOfSlowCommand) ++syncs_since_pdo_;
  if (state_ != NmtState::operational) return;
  takes_pdo_ = true;
  process_data_.on_sync(
      now,
      [this] {
        takes_pdo_ = false;
        refresh();
      },
      out);
}

// Counted from the last one that came, also if it was lost.
bool Slave::comes_too_soon(const Frame& frame) {
  if (!quirks_.slow_commands || frame.remote) return false;
  return std::exchange(syncs_since_pdo_, 0) < kSyncsOfSlowCommand;
}

// CiA 301, 7.2.8.2.1: a node with a heartbeat of its own is not guarded. The watch begins with the first request.
void Slave::on_guard_request(Time now, Frames& out) {
  if (objects_.value(canopen::object::producer_heartbeat_ms.object) != 0) return;
  out.push_back(encode(canopen::ErrorControl{node_, state_, guard_toggle_}));
  guard_toggle_ = !guard_toggle_;
  const auto life = std::chrono::milliseconds(objects_.value(canopen::object::guard_time_ms.object) *
                                              objects_.value(canopen::object::life_time_factor.object));
  if (life.count() == 0) return;
  master_lost_at_ = now + life;
  errors_.clear(canopen::kErrorHeartbeat);
}

// ---- heartbeats ----

// The watch begins with the first received heartbeat. CiA 301, 7.2.8.2.2.
void Slave::on_heartbeat(const canopen::Heartbeat& heartbeat, Time now) {
  const std::int64_t watched = objects_.value(canopen::object::consumer_heartbeat_1.object);
  const auto patience = std::chrono::milliseconds(watched & 0xffff);
  if (heartbeat_ignored_ || patience.count() == 0 || heartbeat.node != watched >> 16) return;
  master_lost_at_ = now + patience;
  errors_.clear(canopen::kErrorHeartbeat);
}

void Slave::watch_master(Time now) {
  if (now < master_lost_at_) return;
  master_lost_at_ = Time::max();
  errors_.raise(canopen::kErrorHeartbeat);
  const std::int64_t behaviour = objects_.value(canopen::object::communication_error_behaviour.object);
  if (behaviour == kToPreOperational && state_ == NmtState::operational) enter(NmtState::pre_operational);
  if (behaviour == kStop) enter(NmtState::stopped);
  on_connection_lost(canopen::kErrorHeartbeat);
}

void Slave::ignore_heartbeat(bool ignore) {
  heartbeat_ignored_ = ignore;
  if (ignore) master_lost_at_ = Time::max();
}

// ---- commands ----

void Slave::watch_commands(Time now) {
  if (state_ != NmtState::operational || !process_data_.take_overdue(now) || event_timer_ignored_) return;
  errors_.raise(canopen::kErrorPdoTimeOut);
  on_connection_lost(canopen::kErrorPdoTimeOut);
}

// ---- time ----

void Slave::on_time(Time now, Frames& out) {
  if (now >= boot_at_) return boot(now, out);
  if (state_ == NmtState::boot_up) return;
  watch_master(now);
  watch_commands(now);
  const auto period = std::chrono::milliseconds(objects_.value(canopen::object::producer_heartbeat_ms.object));
  if (std::exchange(heartbeat_changed_, false)) next_heartbeat_ = period.count() > 0 ? now : Time::max();
  if (now >= next_heartbeat_) {
    out.push_back(encode(canopen::Heartbeat{node_, state_}));
    next_heartbeat_ += period;
    if (next_heartbeat_ <= now) next_heartbeat_ = now + period;  // called late: none is sent twice
  }
  objects_.set(canopen::object::error_register.object, errors_.error_register());
  send_messages(now, out);
}

void Slave::send_messages(Time now, Frames& out) {
  const Frames messages = errors_.take_messages();  // a stopped node sends none
  if (state_ != NmtState::stopped) out.insert(out.end(), messages.begin(), messages.end());
  if (state_ != NmtState::operational || !process_data_.follows_data()) return;
  refresh();
  process_data_.on_time(now, out);
}

Time Slave::deadline() const {
  const Time of_pdo = state_ == NmtState::operational ? process_data_.deadline() : Time::max();
  return std::min({next_heartbeat_, master_lost_at_, boot_at_, of_pdo});
}

bool Slave::follows_data() const {
  return state_ == NmtState::operational && process_data_.follows_data();
}

// ---- objects ----

std::optional<SdoAbort> Slave::check(ObjectAddress at, std::int64_t value) {
  if (at == canopen::object::consumer_heartbeat_1.object && value >> 16 > canopen::kMaxNode)
    return SdoAbort::invalid_value;
  if (const auto abort = process_data_.check(at, value)) return abort;
  const std::optional<ObjectAddress> mapped = process_data_.mapped_by(at, value);
  if (mapped && is_hidden(*mapped)) return SdoAbort::no_object;
  return check_write(at, value);
}

void Slave::written(ObjectAddress at, std::int64_t value) {
  if (at == canopen::object::producer_heartbeat_ms.object) heartbeat_changed_ = true;
  if (at == canopen::object::consumer_heartbeat_1.object || at == canopen::object::life_time_factor.object) {
    master_lost_at_ = Time::max();
    errors_.clear(canopen::kErrorHeartbeat);
  }
  process_data_.on_written(at);
  on_write(at, value);
}

}  // namespace kenaf::candrives
