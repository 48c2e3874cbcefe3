#include "gap/recordings/message_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <set>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::size_t kDeepest = 32;
constexpr std::size_t kMostFieldsOfAll = 20000;  // chosen, of all messages of a definition
constexpr std::string_view kWhite = " \t\r\f\v";

struct Named {
  std::string_view name;
  FieldKind kind;
};
// ROS 2 has "byte" as an octet and "char" as an unsigned number of 8 bits; ROS 1 has "byte" signed.
constexpr Named kNumbers[] = {
    {"bool", FieldKind::boolean},  {"int8", FieldKind::int8},       {"uint8", FieldKind::uint8},
    {"char", FieldKind::uint8},    {"int16", FieldKind::int16},     {"uint16", FieldKind::uint16},
    {"int32", FieldKind::int32},   {"uint32", FieldKind::uint32},   {"int64", FieldKind::int64},
    {"uint64", FieldKind::uint64}, {"float32", FieldKind::float32}, {"float64", FieldKind::float64},
    {"string", FieldKind::string}, {"wstring", FieldKind::wstring},
};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.size(), text.find_first_not_of(kWhite));
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(kWhite) + 1);
}

// Calls `take` with each line and its number from 1.
template <class Take>
void for_each_line(std::string_view text, const Take& take) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.size(), text.find('\n'));
    take(text.substr(0, end), number);
    text.remove_prefix(std::min(text.size(), end + 1));
  }
}

bool is_separator(std::string_view line) {
  line = trimmed(line);
  return line.size() >= 10 && line.find_first_not_of('=') == line.npos;
}

std::optional<FieldKind> kind_of(std::string_view type, RosVersion version) {
  const auto number = std::ranges::find(kNumbers, type, &Named::name);
  if (number != std::end(kNumbers)) return number->kind;
  if (type == "byte") return version == RosVersion::ros1 ? FieldKind::int8 : FieldKind::uint8;
  if (version == RosVersion::ros1 && type == "time") return FieldKind::time;
  if (version == RosVersion::ros1 && type == "duration") return FieldKind::duration;
  return std::nullopt;
}

bool is_name(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && std::ranges::all_of(text, fits);
}

bool is_type_name(std::string_view text) {
  std::string without_slashes;
  for (const char c : text)
    if (c != '/') without_slashes += c;
  return is_name(without_slashes);
}

// A field as its line says, with the type's name where it is no number or text.
struct FieldLine {
  MessageField field;
  std::string type;
};

class Parser {
 public:
  Parser(const DefinitionTexts& texts, RosVersion version) : texts_(texts), version_(version) {}

  std::size_t add(const std::string& type, std::size_t depth) {
    if (const auto known = added_.find(type); known != added_.end()) return known->second;
    if (!open_.insert(type).second) throw RecordingError(fmt::format("the type {} depends on itself", type));
    if (depth > kDeepest)
      throw RecordingError(fmt::format("the type {} lies more than {} levels deep", type, kDeepest));
    const auto text = texts_.find(type);
    if (text == texts_.end()) throw RecordingError(fmt::format("no definition of the type {}", type));

    MessageDefinition message{type, {}, 0};
    for_each_line(text->second, [&](std::string_view line, std::size_t number) {
      std::optional<FieldLine> parsed = field_in(line, type, number);
      if (!parsed) return;
      if (std::ranges::find(message.fields, parsed->field.name, &MessageField::name) != message.fields.end())
        throw RecordingError(fmt::format("the definition of {}: two fields '{}'", type, parsed->field.name));
      if (++fields_ > kMostFieldsOfAll) throw RecordingError("its definition has too many fields");
      if (!parsed->type.empty()) parsed->field.message = add(full_name(parsed->type, type), depth + 1);
      message.fields.push_back(std::move(parsed->field));
    });
    message.least_bytes = least_bytes_of(message);
    open_.erase(type);
    result_.messages.push_back(std::move(message));
    return added_[type] = result_.messages.size() - 1;
  }

  Definitions take(std::size_t root) {
    result_.root = root;
    return std::move(result_);
  }

 private:
  // Empty for comments and constants.
  std::optional<FieldLine> field_in(std::string_view line, const std::string& type, std::size_t number) const {
    const auto fail = [&](const char* what) {
      throw RecordingError(
          fmt::format("the definition of {}, line {}: {}: '{}'", type, number, what, std::string(line.substr(0, 60))));
    };
    const std::string_view code = trimmed(line.substr(0, line.find('#')));
    if (code.empty()) return std::nullopt;
    const std::size_t type_end = code.find_first_of(kWhite);
    if (type_end == code.npos) fail("a field has a type and a name");
    const std::string_view after = trimmed(code.substr(type_end));
    const std::size_t name_end = std::min(after.size(), after.find_first_of(" \t="));
    const std::string_view rest = trimmed(after.substr(name_end));
    if (rest.starts_with('=')) return std::nullopt;  // a constant; other rests are default values

    FieldLine parsed{{std::string(after.substr(0, name_end)), FieldKind::message}, {}};
    if (!is_name(parsed.field.name)) fail("no name of a field");
    std::string_view base = code.substr(0, type_end);
    if (!take_array(base, parsed.field)) fail("no size of an array");
    base = base.substr(0, base.find("<="));  // bounded texts are as long as they say
    if (const auto kind = kind_of(base, version_))
      parsed.field.kind = *kind;
    else if (is_type_name(base))
      parsed.type = base;
    else
      fail("no type of a field");
    return parsed;
  }

  // Takes "[...]" off the end of the type. Returns false if it is wrong.
  static bool take_array(std::string_view& base, MessageField& field) {
    if (!base.ends_with(']')) return true;
    const std::size_t open = base.rfind('[');
    if (open == base.npos) return false;
    const std::string_view size = base.substr(open + 1, base.size() - open - 2);
    base = base.substr(0, open);
    field.array = MessageField::Array::sequence;
    if (size.empty() || size.starts_with("<=")) return true;
    field.array = MessageField::Array::fixed;
    std::uint32_t length = 0;
    const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), length);
    field.length = length;
    return error == std::errc{} && end == size.data() + size.size() && length > 0;
  }

  // A type without a package is of the package of the message that has it, or of ROS itself.
  std::string full_name(const std::string& type, const std::string& of_message) const {
    if (type.find('/') != type.npos) return short_type(type);
    if (version_ == RosVersion::ros2 && type == "time") return "builtin_interfaces/Time";
    if (version_ == RosVersion::ros2 && type == "duration") return "builtin_interfaces/Duration";
    const std::string beside = of_message.substr(0, of_message.find('/') + 1) + type;
    return type == "Header" && !texts_.contains(beside) ? "std_msgs/Header" : beside;
  }

  std::uint64_t least_bytes_of(const MessageDefinition& message) const {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    std::uint64_t sum = version_ == RosVersion::ros2 && message.fields.empty() ? 1 : 0;
    for (const MessageField& field : message.fields) {
      const bool has_length = field.kind == FieldKind::string || field.kind == FieldKind::wstring;
      std::uint64_t bytes = has_length ? 4 : size_of(field.kind);
      if (field.kind == FieldKind::message) bytes = result_.messages[field.message].least_bytes;
      if (field.array == MessageField::Array::sequence) bytes = 4;
      if (field.array == MessageField::Array::fixed) bytes = std::min(kMost, bytes * field.length);
      sum = std::min(kMost, sum + bytes);
    }
    return sum;
  }

  const DefinitionTexts& texts_;
  RosVersion version_;
  Definitions result_;
  std::map<std::string, std::size_t> added_;
  std::set<std::string> open_;
  std::size_t fields_ = 0;
};

}  // namespace

std::size_t size_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::boolean:
    case FieldKind::int8:
    case FieldKind::uint8:
      return 1;
    case FieldKind::int16:
    case FieldKind::uint16:
      return 2;
    case FieldKind::int32:
    case FieldKind::uint32:
    case FieldKind::float32:
      return 4;
    case FieldKind::int64:
    case FieldKind::uint64:
    case FieldKind::float64:
    case FieldKind::time:
    case FieldKind::duration:
      return 8;
    case FieldKind::string:
    case FieldKind::wstring:
    case FieldKind::message:
      return 0;
  }
  return 0;
}

std::string short_type(std::string_view type) {
  const std::size_t first = type.find('/'), last = type.rfind('/');
  if (first == type.npos || first == last) return std::string(type);
  return std::string(type.substr(0, first)) + std::string(type.substr(last));
}

DefinitionTexts split_definitions(std::string_view text, std::string_view type) {
  DefinitionTexts texts;
  std::string name = short_type(type), body;
  bool after_separator = false;
  for_each_line(text, [&](std::string_view line, std::size_t) {
    if (is_separator(line)) {
      texts.emplace(name, std::move(body));
      body.clear();
      name.clear();
      after_separator = true;
      return;
    }
    const std::string_view code = trimmed(line);
    if (code.starts_with("IDL:")) throw RecordingError("its definition is in IDL, which is not supported");
    if (after_separator && code.starts_with("MSG:")) {
      name = short_type(trimmed(code.substr(4)));
      after_separator = false;
      return;
    }
    body.append(line).append("\n");
  });
  texts.emplace(name, std::move(body));
  return texts;
}

Definitions parse_definitions(const DefinitionTexts& texts, std::string_view type, RosVersion version) {
  Parser parser(texts, version);
  return parser.take(parser.add(short_type(type), 0));
}

}  // namespace kenaf::gap::recordings
