#include "can/canlog/pdo_setup.hpp"

namespace kenaf::canlog {

using canopen::NodeId;

namespace {

constexpr std::uint32_t kIdBits = 0x1fffffff;
constexpr unsigned kMaxPdos = 512, kMaxBits = 64;
constexpr std::uint8_t kCobId = 1, kTransmission = 2, kInhibit = 3;

}  // namespace

std::optional<PdoSetup::Key> PdoSetup::key_of(const WrittenObject& written) {
  const unsigned index = written.object.index;
  if (index < 0x1400 || index >= 0x1c00) return std::nullopt;
  return Key{written.node, index >= 0x1800, index % kMaxPdos + 1};
}

std::string PdoSetup::name(const Key& key, const Network& network) {
  return fmt::format("{}PDO{} of {}", key.transmit ? 'T' : 'R', key.number, network.name(key.node));
}

void PdoSetup::on_write(const LogFrame& logged, const WrittenObject& written) {
  const std::optional<Key> key = key_of(written);
  if (!key) return;
  if ((written.object.index & 0x200) == 0) {
    write_communication(logged, *key, written);
  } else {
    write_mapping(logged, *key, written);
  }
}

void PdoSetup::write_communication(const LogFrame& logged, const Key& key, const WrittenObject& written) {
  Record& record = records_[key];
  const std::uint32_t value = written.number();
  if (written.object.sub == kTransmission) record.transmission = static_cast<std::uint8_t>(value);
  if (written.object.sub == kInhibit && record.valid != false)
    findings_.add(logged, rule::pdo_setup, "the inhibit time of {} is written while it is valid", name(key, network_));
  if (written.object.sub != kCobId) return;
  if (record.valid == true && (value & canopen::kPdoInvalid) == 0 && (value & kIdBits) != record.id)
    findings_.add(logged, rule::pdo_setup, "the identifier of {} is changed while it is valid", name(key, network_));
  record.valid = (value & canopen::kPdoInvalid) == 0;
  record.id = value & kIdBits;
}

void PdoSetup::write_mapping(const LogFrame& logged, const Key& key, const WrittenObject& written) {
  Record& record = records_[key];
  record.mapped = true;
  const std::uint8_t sub = written.object.sub;
  if (record.valid != false)
    findings_.add(logged, rule::pdo_setup, "{} is mapped without having been made invalid", name(key, network_));
  if (sub > 0) {
    if (record.count != 0) {
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
  std::erase_if(records_, [node](const auto& entry) { return entry.first.node == node; });
}

void PdoSetup::on_start(const LogFrame& logged, NodeId node) {
  for (const auto& [key, record] : records_) {
    if (key.node == node && record.mapped && record.valid == false)
      findings_.add(logged, rule::pdo_setup, "{} starts while {} is mapped and not made valid again",
                    network_.name(node), name(key, network_));
  }
}

const PdoSetup::Record* PdoSetup::record(std::uint16_t cob_id) const {
  for (const auto& [key, record] : records_) {
    if (record.valid == true && record.id == cob_id) return &record;
  }
  return nullptr;
}

std::optional<std::size_t> PdoSetup::mapped_bytes(std::uint16_t cob_id) const {
  const Record* written = record(cob_id);
  if (written != nullptr && written->mapped && written->count) {
    std::size_t bits = 0;
    for (unsigned i = 1; i <= *written->count; ++i) {
      const auto entry = written->entries.find(static_cast<std::uint8_t>(i));
      if (entry == written->entries.end()) return std::nullopt;
      bits += entry->second & 0xff;
    }
    return bits / 8;
  }
  const KnownPdo* known = network_.pdo(cob_id);
  if (known == nullptr || network_.is_gyro(cob_id)) return std::nullopt;
  return byte_count(known->pdo);
}

std::optional<std::uint8_t> PdoSetup::transmission(std::uint16_t cob_id) const {
  const Record* written = record(cob_id);
  if (written != nullptr && written->transmission) return written->transmission;
  const KnownPdo* known = network_.pdo(cob_id);
  if (known == nullptr || network_.is_gyro(cob_id)) return std::nullopt;
  return known->pdo.transmission;
}

}  // namespace kenaf::canlog
