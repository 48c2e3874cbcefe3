#include "can/canopen/eds_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen {
namespace {

constexpr std::uint16_t kFirstReceivePdo = 0x1400, kFirstTransmitPdo = 0x1800, kMappingOfPdo = 0x200;
constexpr int kMostPdos = 512;
constexpr std::uint8_t kMostMapped = 8;

struct Value {
  int line;
  std::string_view text;
};
struct Section {
  int line = 0;
  std::map<std::string, Value> values;  // keys in lower case
};
using Sections = std::map<std::string, Section>;  // names in lower case

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// ---- sections ----

class Reader {
 public:
  explicit Reader(std::string_view text) { read_sections(text); }
  EdsFile read() &&;

 private:
  void fault(int line, std::string words);
  void read_sections(std::string_view text);
  void read_line(std::string_view line, int number);

  const Section* section(const std::string& name) const;
  const Value* value(const Section& section, std::string_view key) const;
  std::string_view text(const Section& section, std::string_view key) const;
  std::optional<EdsNumber> number(const Section& section, std::string_view key);
  std::int64_t number_or(const Section& section, std::string_view key, std::int64_t fallback, std::int64_t min,
                         std::int64_t max);

  void read_device();
  void read_objects();
  void read_object(ObjectAddress address, const std::string& name, const Section& section);
  void read_compact(std::uint16_t index, const std::string& name, const Section& section, std::int64_t count);
  void add_compact_pdos(std::uint16_t first, int count);
  void check_lists();
  void add(ObjectAddress address, EdsObject object);
  EdsObject entry(const Section& section);
  std::optional<EdsNumber> fitting(const Section& section, std::string_view key, EdsType type);

  Sections sections_;
  Section* current_ = nullptr;
  EdsFile file_;
};

void Reader::fault(int line, std::string words) {
  if (file_.faults.size() < kMostEdsFaults) file_.faults.push_back({line, std::move(words)});
}

void Reader::read_sections(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8, as some editors put it before a file
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    read_line(text::trimmed(text.substr(0, end)), number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void Reader::read_line(std::string_view line, int number) {
  if (line.empty() || line.front() == ';' || line.front() == '#') return;
  if (line.front() == '[') {
    const std::size_t end = line.find(']');
    if (end == line.npos) return fault(number, fmt::format("{} is a section without ]", text::quoted(line)));
    const std::string name = lower(text::trimmed(line.substr(1, end - 1)));
    const auto [found, is_new] = sections_.try_emplace(name, Section{number, {}});
    if (!is_new) fault(number, fmt::format("section [{}] is there already, in line {}", name, found->second.line));
    if (sections_.size() > kMostEdsObjects)
      throw std::runtime_error(fmt::format("line {}: more than {} sections", number, kMostEdsObjects));
    current_ = &found->second;
    return;
  }
  const std::size_t equals = line.find('=');
  if (equals == line.npos || equals == 0)
    return fault(number, fmt::format("{} is neither [section] nor key=value", text::quoted(line)));
  if (current_ == nullptr) return fault(number, fmt::format("{} is before the first section", text::quoted(line)));
  const auto [found, is_new] = current_->values.try_emplace(lower(text::trimmed(line.substr(0, equals))),
                                                            Value{number, text::trimmed(line.substr(equals + 1))});
  if (!is_new) fault(number, fmt::format("{} is there already, in line {}", found->first, found->second.line));
}

const Section* Reader::section(const std::string& name) const {
  const auto found = sections_.find(name);
  return found == sections_.end() ? nullptr : &found->second;
}

const Value* Reader::value(const Section& section, std::string_view key) const {
  const auto found = section.values.find(std::string(key));
  return found == section.values.end() || found->second.text.empty() ? nullptr : &found->second;
}

std::string_view Reader::text(const Section& section, std::string_view key) const {
  const Value* found = value(section, key);
  return found ? found->text : std::string_view();
}

// A key without a value is as good as none: files of many makers have them.
std::optional<EdsNumber> Reader::number(const Section& section, std::string_view key) {
  const Value* found = value(section, key);
  if (!found) return std::nullopt;
  const std::optional<EdsNumber> number = eds_number(found->text);
  if (!number) fault(found->line, fmt::format("{} is {}, which is no whole number", key, text::quoted(found->text)));
  return number;
}

std::int64_t Reader::number_or(const Section& section, std::string_view key, std::int64_t fallback, std::int64_t min,
                               std::int64_t max) {
  const std::optional<EdsNumber> found = number(section, key);
  if (!found) return fallback;
  if (!found->plus_node && found->value >= min && found->value <= max) return found->value;
  fault(value(section, key)->line, fmt::format("{} must be from {} to {}", key, min, max));
  return fallback;
}

// ---- objects ----

struct ObjectSection {
  std::uint16_t index;
  std::optional<std::uint8_t> sub;
};

// "1018", "1018sub1"; nullopt for the name of any other section.
std::optional<ObjectSection> object_of(std::string_view name) {
  constexpr std::size_t kIndexDigits = 4;
  const std::optional<std::uint32_t> index = text::hexadecimal(name.substr(0, kIndexDigits));
  if (!index || name.size() < kIndexDigits) return std::nullopt;
  const std::string_view rest = name.substr(kIndexDigits);
  if (rest.empty()) return ObjectSection{static_cast<std::uint16_t>(*index), std::nullopt};
  if (!rest.starts_with("sub")) return std::nullopt;
  const std::optional<std::uint32_t> sub = text::hexadecimal(rest.substr(3), 2);
  if (!sub) return std::nullopt;
  return ObjectSection{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

EdsObject Reader::entry(const Section& section) {
  EdsObject object;
  object.line = section.line;
  object.name = std::string(text(section, "parametername"));
  object.type.number = static_cast<std::uint16_t>(number_or(section, "datatype", 0, 0, 0xffff));
  const std::string access = lower(text(section, "accesstype"));
  if (access == "wo") {
    object.access = EdsAccess::write_only;
  } else if (access.starts_with("rw")) {
    object.access = EdsAccess::read_write;
  } else if (!access.empty() && access != "ro" && access != "const") {
    fault(value(section, "accesstype")->line,
          fmt::format("AccessType is {}, but must be ro, wo, rw, rwr, rww or const", text::quoted(access)));
  }
  object.mappable = number_or(section, "pdomapping", 0, 0, 1) == 1;
  if (object.type.bits() == 0) return object;  // limits and values of texts and real numbers are not compared
  object.low = fitting(section, "lowlimit", object.type);
  object.high = fitting(section, "highlimit", object.type);
  const bool configured = value(section, "parametervalue") != nullptr;
  object.value = fitting(section, configured ? "parametervalue" : "defaultvalue", object.type);
  return object;
}

// Files give negative numbers as they are, or by their bits: -1 of 8 bits is also 0xff.
std::optional<EdsNumber> Reader::fitting(const Section& section, std::string_view key, EdsType type) {
  std::optional<EdsNumber> found = number(section, key);
  const unsigned bits = type.bits();
  if (!found || bits >= 64) return found;
  const std::int64_t span = std::int64_t{1} << bits;
  if (type.is_signed() && found->value >= span / 2 && found->value < span) found->value -= span;
  const std::int64_t min = type.is_signed() ? -span / 2 : 0, max = min + span - 1;
  if (found->value >= min && found->value <= max) return found;
  fault(value(section, key)->line,
        fmt::format("{} is {}, which {} cannot hold", key, text::quoted(value(section, key)->text), describe(type)));
  return std::nullopt;
}

void Reader::add(ObjectAddress address, EdsObject object) {
  if (file_.objects.size() >= kMostEdsObjects)
    throw std::runtime_error(fmt::format("line {}: more than {} objects", object.line, kMostEdsObjects));
  file_.objects.try_emplace(address, std::move(object));
}

// CiA 306-1, 4.6.3.3: sub-index 0 is the number of entries, and all entries have what the section says, but for names
// and values of their own.
void Reader::read_compact(std::uint16_t index, const std::string& name, const Section& section, std::int64_t count) {
  EdsObject number_of_entries{.line = section.line, .name = "number of entries", .type = {0x0005}};
  number_of_entries.value = EdsNumber{count, false};
  add({index, 0}, std::move(number_of_entries));
  const EdsObject all = entry(section);
  const Section *names = this->section(name + "name"), *values = this->section(name + "value");
  for (std::int64_t sub = 1; sub <= count; ++sub) {
    EdsObject object = all;
    const std::string key = fmt::to_string(sub);
    object.name = names && value(*names, key) ? std::string(text(*names, key)) : fmt::format("{}{}", all.name, sub);
    if (values && value(*values, key) && all.type.bits() != 0) object.value = fitting(*values, key, all.type);
    add({index, static_cast<std::uint8_t>(sub)}, std::move(object));
  }
}

void Reader::read_object(ObjectAddress address, const std::string& name, const Section& section) {
  constexpr std::int64_t kVariable = 7, kArray = 8, kRecord = 9, kMostSubs = 254;
  const std::int64_t kind = number_or(section, "objecttype", kVariable, 0, 0xff);
  if (const std::int64_t count = number_or(section, "compactsubobj", 0, 0, kMostSubs); count > 0)
    return read_compact(address.index, name, section, count);
  if (kind == kArray || kind == kRecord) return;  // what it holds is in its sub-indices
  add(address, entry(section));
}

void Reader::read_objects() {
  for (const auto& [name, section] : sections_) {
    const std::optional<ObjectSection> object = object_of(name);
    if (!object) continue;
    if (object->sub) {
      add({object->index, *object->sub}, entry(section));
    } else {
      read_object({object->index, 0}, name, section);
    }
  }
}

// CiA 306-1, 4.6.2, CompactPDO: the records exist as CiA 301 has them, without sections of their own.
void Reader::add_compact_pdos(std::uint16_t first, int count) {
  constexpr std::uint16_t kUnsigned8 = 0x0005, kUnsigned32 = 0x0007;
  const auto add_entry = [&](int index, std::uint8_t sub, std::uint16_t type) {
    EdsObject object{.name = "of CompactPDO", .type = {type}, .access = EdsAccess::read_write};
    add({static_cast<std::uint16_t>(index), sub}, std::move(object));
  };
  for (int number = 0; number < count; ++number) {
    const int communication = first + number, mapping = communication + kMappingOfPdo;
    add_entry(communication, 1, kUnsigned32);
    add_entry(communication, 2, kUnsigned8);
    add_entry(mapping, 0, kUnsigned8);
    for (std::uint8_t sub = 1; sub <= kMostMapped; ++sub) add_entry(mapping, sub, kUnsigned32);
  }
}

void Reader::read_device() {
  if (const Section* info = section("deviceinfo")) {
    file_.vendor = std::string(text(*info, "vendorname"));
    file_.product = std::string(text(*info, "productname"));
    file_.receive_pdos = static_cast<int>(number_or(*info, "nrofrxpdo", 0, 0, kMostPdos));
    file_.transmit_pdos = static_cast<int>(number_or(*info, "nroftxpdo", 0, 0, kMostPdos));
    if (number_or(*info, "compactpdo", 0, 0, 0xff) != 0) {
      add_compact_pdos(kFirstReceivePdo, file_.receive_pdos);
      add_compact_pdos(kFirstTransmitPdo, file_.transmit_pdos);
    }
  }
  if (const Section* commissioning = section("devicecommissioning")) {
    const std::int64_t node = number_or(*commissioning, "nodeid", 0, 1, kMaxNode);
    if (node > 0) file_.node = static_cast<NodeId>(node);
  }
}

// An object in a list without a section of its own does not exist for a master that reads the file.
void Reader::check_lists() {
  for (const char* list : {"mandatoryobjects", "optionalobjects", "manufacturerobjects"}) {
    const Section* objects = section(list);
    if (!objects) continue;
    for (const auto& [key, listed] : objects->values) {
      if (!text::is_decimal(key)) continue;
      const std::optional<EdsNumber> index = eds_number(listed.text);
      const bool fits = index && !index->plus_node && index->value >= 0 && index->value <= 0xffff;
      if (!fits) {
        fault(listed.line, fmt::format("{} is no index of an object", text::quoted(listed.text)));
      } else if (!section(fmt::format("{:04x}", index->value)) &&
                 !file_.has_index(static_cast<std::uint16_t>(index->value))) {
        fault(listed.line, fmt::format("object {:#06x} is listed, but has no section", index->value));
      }
    }
  }
}

EdsFile Reader::read() && {
  read_objects();
  if (file_.objects.empty())
    throw std::runtime_error(
        sections_.empty() ? "line 1: no [section]: is this an electronic data sheet (EDS or DCF) as text?"
                          : fmt::format("line {}: no section of an object, such as [1000]: is this an EDS or DCF?",
                                        sections_.begin()->second.line));
  read_device();
  check_lists();
  std::ranges::stable_sort(file_.faults, {}, &EdsFault::line);
  return std::move(file_);
}

struct TypeName {
  std::uint16_t number;
  std::string_view name;
  unsigned bits;
};
// CiA 301, 7.4.7.1, table 44.
constexpr TypeName kTypes[] = {
    {0x0001, "BOOLEAN", 8},        {0x0002, "INTEGER8", 8},     {0x0003, "INTEGER16", 16},  {0x0004, "INTEGER32", 32},
    {0x0005, "UNSIGNED8", 8},      {0x0006, "UNSIGNED16", 16},  {0x0007, "UNSIGNED32", 32}, {0x0008, "REAL32", 0},
    {0x0009, "VISIBLE_STRING", 0}, {0x000a, "OCTET_STRING", 0}, {0x000f, "DOMAIN", 0},      {0x0010, "INTEGER24", 24},
    {0x0011, "REAL64", 0},         {0x0012, "INTEGER40", 40},   {0x0013, "INTEGER48", 48},  {0x0014, "INTEGER56", 56},
    {0x0015, "INTEGER64", 64},     {0x0016, "UNSIGNED24", 24},  {0x0018, "UNSIGNED40", 40}, {0x0019, "UNSIGNED48", 48},
    {0x001a, "UNSIGNED56", 56},    {0x001b, "UNSIGNED64", 64}};

const TypeName* known(EdsType type) {
  const auto* found = std::ranges::find(kTypes, type.number, &TypeName::number);
  return found == std::end(kTypes) ? nullptr : found;
}

}  // namespace

std::string_view describe(EdsAccess access) {
  switch (access) {
    case EdsAccess::read_only:
      return "read only";
    case EdsAccess::write_only:
      return "write only";
    case EdsAccess::read_write:
      return "read and write";
  }
  return "";
}

unsigned EdsType::bits() const {
  const TypeName* type = known(*this);
  return type ? type->bits : 0;
}

bool EdsType::is_signed() const {
  const TypeName* type = known(*this);
  return type && type->name.starts_with("INTEGER");
}

std::string describe(EdsType type) {
  const TypeName* found = known(type);
  if (found) return std::string(found->name);
  return type.number == 0 ? "no data type" : fmt::format("data type {:#06x}", type.number);
}

const EdsObject* EdsFile::find(ObjectAddress object) const {
  const auto found = objects.find(object);
  return found == objects.end() ? nullptr : &found->second;
}

bool EdsFile::has_index(std::uint16_t index) const {
  const auto found = objects.lower_bound({index, 0});
  return found != objects.end() && found->first.index == index;
}

EdsFile read_eds(std::string_view text) {
  return Reader(text).read();
}

}  // namespace kenaf::canopen
