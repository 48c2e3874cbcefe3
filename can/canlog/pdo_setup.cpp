#include "can/canlog/pdo_setup.hpp"

namespace kenaf::canlog {

using canopen::NodeId;

namespace {

constexpr std::uint32_t kIdBits = 0x1fffffff, kTwentyNineBits = 1u << 29;
constexpr unsigned kMaxPdos = 512, kMaxBits = 64;
constexpr std::uint8_t kCobId = 1, kTransmission = 2, kInhibit = 3;

// CiA 301, table 41, and the identifiers of SYNC, TIME and the emergency messages.
bool is_for_pdos(std::uint32_t id) {
  const auto within = [id](std::uint32_t first, std::uint32_t last) { return id >= first && id <= last; };
  return id > 0x180 && id < 0x7e0 && !within(0x581, 0x5ff) && !within(0x601, 0x67f) && !within(0x6e0, 0x6ff) &&
         !within(0x701, 0x77f);
}

// Where the identifier carries a PDO at all, and it has 11 bits.
std::optional<std::uint16_t> carried_by(std::optional<std::uint32_t> id) {
  if (!id || !is_for_pdos(*id)) return std::nullopt;
  return static_cast<std::uint16_t>(*id);
}

}  // namespace

PdoSetup::PdoSetup(const Network& network, Findings& findings) : network_(network), findings_(findings) {
  for (const auto& [id, known] : network.pdos()) update(id);
}

std::optional<PdoSetup::Key> PdoSetup::key_of(const WrittenObject& written) {
  const unsigned index = written.object.index;
  if (index < 0x1400 || index >= 0x1c00) return std::nullopt;
  return Key{written.node, index >= 0x1800, index % kMaxPdos + 1};
}

std::optional<PdoSetup::Key> PdoSetup::predefined(std::uint16_t cob_id) {
  const Address address = canlog::address_of(cob_id);
  if (address.service != Service::transmit_pdo && address.service != Service::receive_pdo) return std::nullopt;
  return Key{address.node, address.service == Service::transmit_pdo, address.pdo};
}

std::optional<std::uint16_t> PdoSetup::predefined_id(const Key& key) {
  if (key.number > 4) return std::nullopt;
  const auto& bases = key.transmit ? canopen::kTransmitPdoId : canopen::kReceivePdoId;
  return static_cast<std::uint16_t>(bases[key.number - 1] + key.node);
}

std::string PdoSetup::name(const Key& key, const Network& network) {
  return fmt::format("{}PDO{} of {}", key.transmit ? 'T' : 'R', key.number, network.name(key.node));
}

// ---- writes ----

void PdoSetup::on_write(const LogFrame& logged, const WrittenObject& written) {
  const std::optional<Key> key = key_of(written);
  if (!key) return;
  if ((written.object.index & 0x200) == 0) {
    write_communication(logged, *key, written);
  } else {
    write_mapping(logged, *key, written);
  }
  update(*key);
}

void PdoSetup::write_communication(const LogFrame& logged, const Key& key, const WrittenObject& written) {
  Record& record = records_[key];
  const std::uint32_t value = written.number();
  if (written.object.sub == kTransmission) record.transmission = static_cast<std::uint8_t>(value);
  const bool may_be_invalid = record.valid == false || (!record.valid && !reset_.contains(key.node));
  if (written.object.sub == kInhibit && !may_be_invalid)
    findings_.add(logged, rule::pdo_setup, "the inhibit time of {} is written while it is valid", name(key, network_));
  if (written.object.sub == kCobId) write_identifier(logged, key, value);
}

void PdoSetup::write_identifier(const LogFrame& logged, const Key& key, std::uint32_t value) {
  Record& record = records_[key];
  const bool valid = (value & canopen::kPdoInvalid) == 0;
  const std::uint32_t id = value & kIdBits;
  if (record.valid == true && valid && id != record.id)
    findings_.add(logged, rule::pdo_setup, "the identifier of {} is changed while it is valid", name(key, network_));
  if (valid && (value & kTwentyNineBits) == 0 && !is_for_pdos(id))
    findings_.add(logged, rule::pdo_setup, "the identifier of {} is {:#x}, which is not for PDOs", name(key, network_),
                  id);

  // What it leaves, it leaves to others.
  give_up(key, record);
  record.valid = valid;
  record.no_remote = (value & canopen::kPdoNoRemoteRequest) != 0;
  record.id = (value & kTwentyNineBits) == 0 ? id : kTwentyNineBits | id;
  claim(key, record);
}

void PdoSetup::write_mapping(const LogFrame& logged, const Key& key, const WrittenObject& written) {
  Record& record = records_[key];
  record.mapped = true;
  const std::uint8_t sub = written.object.sub;
  const bool was_reset = reset_.contains(key.node);
  if (record.valid.value_or(was_reset))
    findings_.add(logged, rule::pdo_setup, "{} is mapped without having been made invalid", name(key, network_));
  if (sub > 0) {
    if (record.count ? *record.count != 0 : was_reset) {
      findings_.add(logged, rule::pdo_setup, "entry {} of {} is written before the count is 0", sub,
                    name(key, network_));
    }
    record.entries[sub] = written.number();
    return;
  }
  record.count = static_cast<std::uint8_t>(written.number());
  unsigned bits = 0;
  for (const auto& [number, entry] : record.entries) bits += number <= *record.count ? entry & 0xff : 0;
  if (bits > kMaxBits)
    findings_.add(logged, rule::pdo_setup, "{} has {} bits: a frame has {}", name(key, network_), bits, kMaxBits);
  if (*record.count == 0) record.entries.clear();
}

void PdoSetup::on_restart(NodeId node) {
  reset_.insert(node);
  std::vector<Key> lost;
  for (auto one = records_.lower_bound(Key{node, false, 0}); one != records_.end() && one->first.node == node;) {
    give_up(one->first, one->second);
    lost.push_back(one->first);
    one = records_.erase(one);
  }
  for (const Key& key : lost) update(key);
}

void PdoSetup::on_start(const LogFrame& logged, NodeId node) {
  for (const auto& [key, record] : records_) {
    if (key.node == node && record.mapped && record.valid == false)
      findings_.add(logged, rule::pdo_setup, "{} starts while {} is mapped and not made valid again",
                    network_.name(node), name(key, network_));
  }
}

// ---- what is in force ----

const PdoSetup::Record* PdoSetup::record(const Key& key) const {
  const auto found = records_.find(key);
  return found == records_.end() ? nullptr : &found->second;
}

void PdoSetup::claim(const Key& key, const Record& record) {
  const auto id = carried_by(record.id);
  if (record.valid != true || !id) return;
  claims_[*id].insert(key);
  update(*id);
}

void PdoSetup::give_up(const Key& key, const Record& record) {
  const auto id = carried_by(record.id);
  if (!id) return;
  claims_[*id].erase(key);
  update(*id);
}

void PdoSetup::update(const Key& key) {
  if (const auto id = predefined_id(key)) update(*id);
  const Record* written = record(key);
  if (written == nullptr) return;
  if (const auto id = carried_by(written->id)) update(*id);
}

void PdoSetup::update(std::uint16_t cob_id) {
  in_force_.erase(cob_id);
  if (const auto owner = owner_of(cob_id)) in_force_.emplace(cob_id, made_from(*owner));
}

// A transmit PDO first, and what the log has written before what the description has.
std::optional<PdoSetup::Key> PdoSetup::owner_of(std::uint16_t cob_id) const {
  std::optional<Key> described;
  const auto key = predefined(cob_id);
  if (key && network_.pdo(cob_id) != nullptr && !is_given_up(cob_id)) described = key;
  const auto claimed = claims_.find(cob_id);
  if (claimed == claims_.end() || claimed->second.empty()) return described;
  for (const Key& one : claimed->second) {
    if (one.transmit) return one;
  }
  return described && described->transmit ? described : *claimed->second.begin();
}

bool PdoSetup::is_given_up(std::uint16_t cob_id) const {
  const auto key = predefined(cob_id);
  const Record* written = key ? record(*key) : nullptr;
  return written != nullptr && written->valid && (!*written->valid || written->id != cob_id);
}

PdoInForce PdoSetup::made_from(const Key& key) const {
  const auto default_id = predefined_id(key);
  const KnownPdo* known = default_id ? network_.pdo(*default_id) : nullptr;
  const Record* written = record(key);
  PdoInForce pdo{.node = key.node, .transmit = key.transmit, .number = static_cast<std::uint16_t>(key.number)};
  pdo.drive = network_.drive_of(key.node);
  pdo.is_gyro = known != nullptr && network_.is_gyro(*default_id);
  if (known != nullptr && !pdo.is_gyro) {
    pdo.objects = known->pdo.objects;
    pdo.bytes = byte_count(known->pdo);
    pdo.transmission = known->pdo.transmission;
  }
  if (written == nullptr) return pdo;
  pdo.no_remote = written->no_remote;
  if (written->transmission) pdo.transmission = written->transmission;
  if (!written->mapped || !written->count) return pdo;

  // Entries that the log does not have leave the contents unknown.
  pdo.objects.clear();
  pdo.bytes.reset();
  std::size_t bits = 0;
  bool in_numbers = true;
  for (unsigned i = 1; i <= *written->count; ++i) {
    const auto entry = written->entries.find(static_cast<std::uint8_t>(i));
    if (entry == written->entries.end()) {
      pdo.objects.clear();
      return pdo;
    }
    bits += entry->second & 0xff;
    const auto mapped = mapped_object(entry->second);
    if (mapped) pdo.objects.push_back(*mapped);
    in_numbers = in_numbers && mapped;
  }
  pdo.bytes = (bits + 7) / 8;
  if (!in_numbers || bits > kMaxBits) pdo.objects.clear();
  return pdo;
}

const PdoInForce* PdoSetup::pdo(std::uint16_t cob_id) const {
  const auto found = in_force_.find(cob_id);
  return found == in_force_.end() ? nullptr : &found->second;
}

Address PdoSetup::address_of(std::uint16_t cob_id) const {
  const PdoInForce* carried = pdo(cob_id);
  if (carried == nullptr) return canlog::address_of(cob_id);
  return {carried->transmit ? Service::transmit_pdo : Service::receive_pdo, carried->node, carried->number};
}

}  // namespace kenaf::canlog
