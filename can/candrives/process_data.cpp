#include "can/candrives/process_data.hpp"

#include <algorithm>

namespace kenaf::candrives {

using canopen::Frame;
using canopen::ObjectAddress;
using canopen::ObjectType;
using canopen::SdoAbort;
using canopen::Time;

namespace {

constexpr std::uint8_t kMaxMapped = 8, kMaxBits = 64;
constexpr std::uint16_t kFirstReceiveMapping = 0x1600;
constexpr std::uint8_t kCobId = 1, kTransmission = 2, kInhibit = 3, kEventTimer = 5;

ObjectAddress address_of(std::int64_t mapping_entry) {
  return {static_cast<std::uint16_t>(mapping_entry >> 16), static_cast<std::uint8_t>(mapping_entry >> 8 & 0xff)};
}

// Identifiers that no PDO may have. CiA 301, table 41.
bool is_restricted(std::uint32_t id) {
  return id <= 0x07f || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5ff) || (id >= 0x601 && id <= 0x67f) ||
         (id >= 0x6e0 && id <= 0x6ff) || id >= 0x701;
}

}  // namespace

ProcessData::ProcessData(canopen::NodeId node, Dictionary& objects, const std::vector<DefaultPdo>& pdos)
    : objects_(&objects) {
  // The records are plain objects; check() has the rules by which they change.
  const auto add = [&](std::uint16_t index, std::uint8_t sub, ObjectType type, Access access, std::int64_t value) {
    objects.add({{index, sub}, type}, access, Mappable::no, value);
  };
  for (const DefaultPdo& with : pdos) {
    const canopen::Pdo& pdo = with.pdo;
    const bool transmit = pdo.direction == canopen::PdoDirection::transmit;

    // Indices: receive 0x1400 and 0x1600, transmit 0x1800 and 0x1a00, plus number - 1.
    State state{.communication = static_cast<std::uint16_t>((transmit ? 0x1800 : 0x1400) + pdo.number - 1),
                .mapping = static_cast<std::uint16_t>((transmit ? 0x1a00 : 0x1600) + pdo.number - 1),
                .transmit = transmit};

    // Communication record; sub-index 0 is the highest sub-index that it has.
    const std::uint32_t id =
        cob_id(pdo, node) | (transmit ? canopen::kPdoNoRemoteRequest : 0) | (with.valid ? 0 : canopen::kPdoInvalid);
    const bool has_timer = transmit || with.has_event_timer;
    add(state.communication, 0, ObjectType::unsigned8, Access::read_only, has_timer ? kEventTimer : kTransmission);
    add(state.communication, kCobId, ObjectType::unsigned32, Access::read_write, id);
    add(state.communication, kTransmission, ObjectType::unsigned8, Access::read_write, pdo.transmission);
    if (transmit) add(state.communication, kInhibit, ObjectType::unsigned16, Access::read_write, with.inhibit_100us);
    if (has_timer) add(state.communication, kEventTimer, ObjectType::unsigned16, Access::read_write, with.event_ms);

    // Mapping record: all eight entries exist, those beyond the count are 0.
    add(state.mapping, 0, ObjectType::unsigned8, Access::read_write, static_cast<std::int64_t>(pdo.objects.size()));
    for (std::uint8_t sub = 1; sub <= kMaxMapped; ++sub) {
      const std::uint32_t entry = sub <= pdo.objects.size() ? canopen::mapping_entry(pdo.objects[sub - 1u]) : 0;
      add(state.mapping, sub, ObjectType::unsigned32, Access::read_write, entry);
    }
    pdos_.push_back(state);
  }
}

// ---- the rules of the records ----

std::optional<SdoAbort> ProcessData::check(ObjectAddress object, std::int64_t value) const {
  for (const State& state : pdos_) {
    if (object.index == state.mapping) return check_mapping(state, object.sub, value);
    if (object.index != state.communication) continue;
    if (object.sub == kCobId) return check_cob_id(state, value);
    if (object.sub == kTransmission && value > 240 && value < 254) return SdoAbort::invalid_value;
    if (object.sub == kInhibit && is_valid(state)) return SdoAbort::unsupported_access;
  }
  return std::nullopt;
}

// While the PDO is valid, only its validity may change. Bit 29 (29-bit identifier) is not supported.
std::optional<SdoAbort> ProcessData::check_cob_id(const State& state, std::int64_t value) const {
  const auto now = static_cast<std::uint32_t>(objects_->value({state.communication, kCobId}));
  const auto wanted = static_cast<std::uint32_t>(value);
  if ((wanted & ~(canopen::kPdoInvalid | canopen::kPdoNoRemoteRequest)) > 0x7ff || is_restricted(wanted & 0x7ff))
    return SdoAbort::invalid_value;
  if (quirks_.count_first && is_active(state) && (wanted & canopen::kPdoInvalid) != 0)
    return SdoAbort::incompatible_parameter;
  if (is_valid(state) && ((now ^ wanted) & ~canopen::kPdoInvalid) != 0) return SdoAbort::invalid_value;
  return std::nullopt;
}

std::optional<SdoAbort> ProcessData::check_mapping(const State& state, std::uint8_t sub, std::int64_t value) const {
  const bool is_first_rpdo = state.mapping == kFirstReceiveMapping;
  if (quirks_.fixed_mapping || (quirks_.first_rpdo_fixed && is_first_rpdo)) return SdoAbort::cannot_be_mapped;
  const bool may_empty = quirks_.count_first && sub == 0 && value == 0;
  if (is_valid(state) && !may_empty) return SdoAbort::unsupported_access;
  if (sub > 0) {
    if (objects_->value({state.mapping, 0}) != 0) return SdoAbort::unsupported_access;
    const ObjectEntry* entry = objects_->find(address_of(value));
    if (entry == nullptr) return SdoAbort::no_object;
    const Mappable wanted = state.transmit ? Mappable::transmit : Mappable::receive;
    const bool mappable = entry->mappable == wanted || entry->mappable == Mappable::both;
    if (!mappable || (value & 0xff) != static_cast<std::int64_t>(8 * canopen::byte_count(entry->type)))
      return SdoAbort::cannot_be_mapped;
    return std::nullopt;
  }
  if (value > kMaxMapped) return SdoAbort::value_too_high;
  std::int64_t bits = 0;
  for (std::int64_t i = 1; i <= value; ++i) {
    const std::int64_t entry = objects_->value({state.mapping, static_cast<std::uint8_t>(i)});
    if (entry == 0) return SdoAbort::no_object;
    bits += entry & 0xff;
  }
  if (bits > kMaxBits) return SdoAbort::pdo_too_long;
  return std::nullopt;
}

std::optional<ObjectAddress> ProcessData::mapped_by(ObjectAddress object, std::int64_t value) const {
  const bool is_entry =
      object.sub > 0 && std::ranges::any_of(pdos_, [&](const State& state) { return state.mapping == object.index; });
  return is_entry ? std::optional(address_of(value)) : std::nullopt;
}

// ---- the data ----

void ProcessData::on_written(ObjectAddress object) {
  for (State& state : pdos_) {
    if (object.index == state.communication && object.sub == kEventTimer && !state.transmit) {
      state.overdue_at = Time::max();  // and what was received stays
    } else if (object.index == state.communication || object.index == state.mapping) {
      begin(state);
    }
  }
}

void ProcessData::begin() {
  for (State& state : pdos_) begin(state);
}

void ProcessData::begin(State& state) {
  state.pending = false;
  state.syncs = 0;
  state.sent.reset();
  state.overdue_at = Time::max();
}

bool ProcessData::is_valid(const State& state) const {
  return (objects_->value({state.communication, kCobId}) & canopen::kPdoInvalid) == 0;
}

bool ProcessData::is_active(const State& state) const {
  return is_valid(state) && objects_->value({state.mapping, 0}) > 0;
}

bool ProcessData::is_event_driven(const State& state) const {
  return objects_->value({state.communication, kTransmission}) >= 254;
}

Time ProcessData::event_time(const State& state) const {
  const ObjectEntry* timer = objects_->find({state.communication, kEventTimer});
  return std::chrono::milliseconds(timer == nullptr ? 0 : timer->value);
}

Time ProcessData::inhibit_time(const State& state) const {
  return std::chrono::microseconds(100 * objects_->value({state.communication, kInhibit}));
}

std::vector<canopen::MappedObject> ProcessData::mapped(const State& state) const {
  std::vector<canopen::MappedObject> objects;
  const std::int64_t count = objects_->value({state.mapping, 0});
  for (std::uint8_t i = 1; i <= count; ++i) {
    const ObjectAddress object = address_of(objects_->value({state.mapping, i}));
    objects.push_back({object, objects_->find(object)->type});
  }
  return objects;
}

std::size_t ProcessData::bytes(const State& state) const {
  std::size_t sum = 0;
  for (const auto& object : mapped(state)) sum += canopen::byte_count(object.type);
  return sum;
}

Frame ProcessData::pack(const State& state) const {
  std::vector<std::uint8_t> data;
  for (const auto& object : mapped(state)) {
    const auto value = canopen::encode_number(object.type, objects_->value(object.object));
    data.insert(data.end(), value.begin(), value.end());
  }
  return canopen::make_frame(static_cast<std::uint16_t>(objects_->value({state.communication, kCobId}) & 0x7ff), data);
}

bool ProcessData::receives(const Frame& frame) const {
  return std::ranges::any_of(pdos_, [&](const State& state) {
    return !state.transmit && is_active(state) && (objects_->value({state.communication, kCobId}) & 0x7ff) == frame.id;
  });
}

ProcessData::Reception ProcessData::on_frame(const Frame& frame, Time now) {
  for (State& state : pdos_) {
    if (state.transmit || !is_active(state)) continue;
    if ((objects_->value({state.communication, kCobId}) & 0x7ff) != frame.id) continue;
    if (frame.length < bytes(state)) return Reception::too_short;
    if (const Time event = event_time(state); event > Time::zero()) state.overdue_at = now + event;
    state.received = frame.data;
    state.pending = true;
    if (is_event_driven(state)) {
      std::vector<Dictionary::Number> numbers;
      take(state, numbers);
      objects_->write_together(numbers);
    }
    return Reception::taken;
  }
  return Reception::not_for_me;
}

bool ProcessData::take_overdue(Time now) {
  bool is_overdue = false;
  for (State& state : pdos_) {
    if (now < state.overdue_at) continue;
    state.overdue_at = Time::max();
    is_overdue = true;
  }
  return is_overdue;
}

void ProcessData::take(State& state, std::vector<Dictionary::Number>& numbers) const {
  state.pending = false;
  std::span<const std::uint8_t> rest = state.received;
  for (const auto& object : mapped(state)) {
    numbers.push_back({object.object, canopen::decode_number(object.type, rest)});
    rest = rest.subspan(canopen::byte_count(object.type));
  }
}

void ProcessData::transmit(State& state, const Frame& frame, Time now, Frames& out) {
  state.sent = frame;
  state.sent_at = now;
  state.syncs = 0;
  out.push_back(frame);
}

void ProcessData::on_sync(Time now, const std::function<void()>& refresh, Frames& out) {
  std::vector<Dictionary::Number> numbers;
  for (State& state : pdos_) {
    if (state.pending) take(state, numbers);
  }
  objects_->write_together(numbers);
  refresh();
  for (State& state : pdos_) {
    if (!state.transmit || !is_active(state) || is_event_driven(state)) continue;
    const std::int64_t each = objects_->value({state.communication, kTransmission});
    if (state.syncs < each) ++state.syncs;
    const Frame frame = pack(state);
    if (each == 0 ? state.sent != frame : state.syncs >= each) transmit(state, frame, now, out);
  }
}

void ProcessData::on_time(Time now, Frames& out) {
  for (State& state : pdos_) {
    if (!state.transmit || !is_active(state) || !is_event_driven(state)) continue;
    if (state.sent && now < state.sent_at + inhibit_time(state)) continue;
    const Frame frame = pack(state);
    const Time event = event_time(state);
    const bool due = event > Time::zero() && state.sent && now >= state.sent_at + event;
    if (due || state.sent != frame) transmit(state, frame, now, out);
  }
}

Time ProcessData::deadline() const {
  Time earliest = Time::max();
  for (const State& state : pdos_) {
    earliest = std::min(earliest, state.overdue_at);
    if (!state.transmit || !is_active(state) || !is_event_driven(state)) continue;
    const Time event = event_time(state);
    if (event == Time::zero() || !state.sent) continue;
    earliest = std::min(earliest, state.sent_at + std::max(event, inhibit_time(state)));
  }
  return earliest;
}

bool ProcessData::follows_data() const {
  return std::ranges::any_of(
      pdos_, [&](const State& state) { return state.transmit && is_active(state) && is_event_driven(state); });
}

}  // namespace kenaf::candrives
