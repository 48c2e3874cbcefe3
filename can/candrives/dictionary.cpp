#include "can/candrives/dictionary.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kenaf::candrives {

using canopen::ObjectAddress;
using canopen::ObjectType;
using canopen::SdoAbort;

ObjectLimits range_of(ObjectType type) {
  const auto bits = static_cast<int>(8 * canopen::byte_count(type));
  const std::int64_t values = std::int64_t{1} << bits;
  if (canopen::is_signed(type)) return {-values / 2, values / 2 - 1};
  return {0, values - 1};
}

void Dictionary::add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value) {
  add(object, access, mappable, value, range_of(object.type));
}

void Dictionary::add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value,
                     ObjectLimits limits) {
  entries_[object.object] = {object.type, access, mappable, value, value, limits, {}};
}

void Dictionary::add_text(ObjectAddress object, std::string text) {
  entries_[object] = {ObjectType::text, Access::read_only, Mappable::no, 0, 0, {}, std::move(text)};
}

const ObjectEntry* Dictionary::find(ObjectAddress object) const {
  const auto entry = entries_.find(object);
  return entry == entries_.end() ? nullptr : &entry->second;
}

std::int64_t Dictionary::value(ObjectAddress object) const {
  return entries_.at(object).value;
}

void Dictionary::set(ObjectAddress object, std::int64_t value) {
  entries_.at(object).value = value;
}

void Dictionary::reset(std::uint16_t first, std::uint16_t last) {
  for (auto& [object, entry] : entries_) {
    if (object.index >= first && object.index <= last) entry.value = entry.value_at_reset;
  }
}

std::optional<SdoAbort> Dictionary::missing(ObjectAddress object) const {
  if (entries_.contains(object)) return std::nullopt;
  const bool has_index =
      std::ranges::any_of(entries_, [&](const auto& entry) { return entry.first.index == object.index; });
  return has_index ? SdoAbort::no_sub_index : SdoAbort::no_object;
}

std::variant<canopen::ObjectBytes, SdoAbort> Dictionary::read(ObjectAddress object) const {
  if (const auto abort = missing(object)) return *abort;
  const ObjectEntry& entry = entries_.at(object);
  if (entry.type == ObjectType::text) return canopen::ObjectBytes(entry.text.begin(), entry.text.end());
  return canopen::encode_number(entry.type, entry.value);
}

std::optional<SdoAbort> Dictionary::write(ObjectAddress object, std::span<const std::uint8_t> bytes) {
  if (const auto abort = missing(object)) return abort;
  const ObjectEntry& entry = entries_.at(object);
  if (entry.access == Access::read_only) return SdoAbort::read_only;
  const std::size_t wanted = canopen::byte_count(entry.type);
  if (bytes.size() > wanted) return SdoAbort::too_long;
  if (bytes.size() < wanted) return SdoAbort::too_short;
  const std::int64_t value = canopen::decode_number(entry.type, bytes);
  if (const auto abort = store(object, value)) return abort;
  if (on_written) on_written(object, value);
  return std::nullopt;
}

void Dictionary::write_together(std::span<const Number> numbers) {
  std::vector<Number> stored;
  for (const Number& number : numbers) {
    if (!store(number.object, number.value)) stored.push_back(number);
  }
  if (!on_written) return;
  for (const Number& number : stored) on_written(number.object, number.value);
}

std::optional<SdoAbort> Dictionary::store(ObjectAddress object, std::int64_t value) {
  ObjectEntry& entry = entries_.at(object);
  if (value > entry.limits.max) return SdoAbort::value_too_high;
  if (value < entry.limits.min) return SdoAbort::value_too_low;
  if (on_check) {
    if (const auto abort = on_check(object, value)) return abort;
  }
  entry.value = value;
  return std::nullopt;
}

}  // namespace kenaf::candrives
