#include "gap/recordings/payload_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::uint64_t kMostNames = 10000;  // of a message's elements, chosen

bool is_number(FieldKind kind) {
  return kind != FieldKind::string && kind != FieldKind::wstring && kind != FieldKind::message;
}

const MessageField* field_named(const MessageDefinition& message, std::string_view name) {
  const auto field = std::ranges::find(message.fields, name, &MessageField::name);
  return field == message.fields.end() ? nullptr : &*field;
}

// Walks payloads of one definition.
class Walk {
 public:
  explicit Walk(const Definitions& definitions) : definitions_(definitions) {}

  const MessageDefinition& root() const { return definitions_.messages[definitions_.root]; }
  const MessageDefinition& of(const MessageField& field) const { return definitions_.messages[field.message]; }

  void skip(const MessageDefinition& message, PayloadCursor& payload) const {
    if (has_no_bytes(message, payload)) return;
    if (message.fields.empty()) payload.skip(FieldKind::uint8, 1);  // CDR has a byte for an empty message
    for (const MessageField& field : message.fields) skip(field, payload);
  }

  void skip(const MessageField& field, PayloadCursor& payload) const { skip(field, count(field, payload), payload); }

  void skip(const MessageField& field, std::uint64_t elements, PayloadCursor& payload) const {
    if (field.kind != FieldKind::message) return payload.skip(field.kind, elements);
    check_count(field, elements, payload);
    if (has_no_bytes(of(field), payload)) return;
    for (std::uint64_t i = 0; i < elements; ++i) skip(of(field), payload);
  }

  // How many elements a field has here; one if it is no array.
  static std::uint64_t count(const MessageField& field, PayloadCursor& payload) {
    if (field.array == MessageField::Array::none) return 1;
    return field.array == MessageField::Array::fixed ? field.length : payload.length();
  }

  // Throws if the elements cannot be all in the message, before any is read.
  void check_count(const MessageField& field, std::uint64_t elements, const PayloadCursor& payload) const {
    const std::uint64_t least = field.kind == FieldKind::message ? of(field).least_bytes : 1;
    if (least > 0 && elements > payload.left() / least)
      throw RecordingError(fmt::format("the {} elements of '{}' are beyond its end", elements, field.name));
  }

  // `header.stamp`, if the message has one.
  std::optional<std::int64_t> stamp(const MessageDefinition& message, PayloadCursor payload) const {
    const MessageField* header = field_named(message, "header");
    if (header == nullptr || header->kind != FieldKind::message || header->array != MessageField::Array::none)
      return std::nullopt;
    const MessageField* stamp_field = field_named(of(*header), "stamp");
    if (stamp_field == nullptr || stamp_field->array != MessageField::Array::none) return std::nullopt;
    for (const MessageField& field : message.fields) {
      if (&field == header) break;
      skip(field, payload);
    }
    for (const MessageField& field : of(*header).fields) {
      if (&field == stamp_field) break;
      skip(field, payload);
    }
    if (stamp_field->kind == FieldKind::time) return payload.time_ns();
    if (stamp_field->kind != FieldKind::message || of(*stamp_field).name != "builtin_interfaces/Time")
      return std::nullopt;
    const double seconds = payload.number(FieldKind::int32), nanoseconds = payload.number(FieldKind::uint32);
    return static_cast<std::int64_t>(seconds) * 1000000000 + static_cast<std::int64_t>(nanoseconds);
  }

  // The message's own list of names of its arrays' elements; empty if it has none. `payload` is at its begin.
  std::vector<std::string_view> names(const MessageDefinition& message, PayloadCursor payload) const {
    std::vector<std::string_view> list;
    for (const MessageField& field : message.fields) {
      if (field.kind != FieldKind::string || field.array == MessageField::Array::none ||
          !is_list_of_names(field.name)) {
        skip(field, payload);
        continue;
      }
      const std::uint64_t elements = std::min(count(field, payload), kMostNames);
      for (std::uint64_t i = 0; i < elements; ++i) list.push_back(payload.text());
      return list;
    }
    return list;
  }
  static bool has_names(const MessageDefinition& message) {
    return std::ranges::any_of(message.fields, [](const MessageField& field) {
      return field.kind == FieldKind::string && field.array != MessageField::Array::none &&
             is_list_of_names(field.name);
    });
  }

  // The text by which an element of an array is named; empty if it has none.
  std::string_view name(const MessageDefinition& element, PayloadCursor payload) const {
    for (const MessageField& field : element.fields) {
      const bool is_text = field.kind == FieldKind::string && field.array == MessageField::Array::none;
      if (is_text && is_name_of_element(field.name)) return payload.text();
      skip(field, payload);
    }
    return {};
  }

 private:
  // In ROS 1 a message without fields has no bytes, and neither have any number of them.
  static bool has_no_bytes(const MessageDefinition& message, const PayloadCursor& payload) {
    return message.least_bytes == 0 && !payload.is_cdr();
  }

  const Definitions& definitions_;
};

class Finder {
 public:
  Finder(const Definitions& definitions, const FieldPath& path) : walk_(definitions), path_(path) {}

  std::optional<FieldValue> run(PayloadCursor payload) { return in_message(walk_.root(), payload, 0); }

 private:
  std::optional<FieldValue> in_message(const MessageDefinition& message, PayloadCursor payload, std::size_t step) {
    const PayloadCursor begin = payload;
    if (const auto stamp = walk_.stamp(message, payload)) stamp_ns_ = stamp;
    for (const MessageField& field : message.fields) {
      if (field.name == path_[step].field) return in_field(message, begin, field, payload, step);
      walk_.skip(field, payload);
    }
    return std::nullopt;
  }

  std::optional<FieldValue> in_field(const MessageDefinition& message, const PayloadCursor& begin,
                                     const MessageField& field, PayloadCursor payload, std::size_t step) {
    const std::uint64_t elements = Walk::count(field, payload);
    const PathStep& wanted = path_[step];
    std::uint64_t index = wanted.index.value_or(0);
    if (!wanted.key.empty()) {
      if (field.kind == FieldKind::message) return in_element_named(field, elements, payload, step);
      const std::vector<std::string_view> names = walk_.names(message, begin);
      index = static_cast<std::uint64_t>(std::ranges::find(names, wanted.key) - names.begin());
    }
    if (index >= elements) return std::nullopt;
    walk_.skip(field, index, payload);
    return in_element(field, payload, step);
  }

  std::optional<FieldValue> in_element_named(const MessageField& field, std::uint64_t elements, PayloadCursor payload,
                                             std::size_t step) {
    walk_.check_count(field, elements, payload);
    if (walk_.of(field).least_bytes == 0) return std::nullopt;
    for (std::uint64_t i = 0; i < elements; ++i) {
      if (walk_.name(walk_.of(field), payload) == path_[step].key) return in_element(field, payload, step);
      walk_.skip(walk_.of(field), payload);
    }
    return std::nullopt;
  }

  std::optional<FieldValue> in_element(const MessageField& field, PayloadCursor payload, std::size_t step) {
    if (step + 1 < path_.size()) return in_message(walk_.of(field), payload, step + 1);
    return FieldValue{payload.number(field.kind), stamp_ns_};
  }

  Walk walk_;
  const FieldPath& path_;
  std::optional<std::int64_t> stamp_ns_;
};

class Lister {
 public:
  Lister(const Definitions& definitions, const TakeField& take) : walk_(definitions), take_(take) {}

  void run(PayloadCursor payload) { list_message(walk_.root(), payload, "", std::nullopt); }

 private:
  using Stamp = std::optional<std::int64_t>;

  void list_message(const MessageDefinition& message, PayloadCursor& payload, const std::string& before, Stamp stamp) {
    const PayloadCursor begin = payload;
    if (const Stamp own = walk_.stamp(message, payload)) stamp = own;
    const std::vector<std::string_view> names =
        Walk::has_names(message) ? walk_.names(message, begin) : std::vector<std::string_view>();
    if (message.fields.empty()) walk_.skip(message, payload);
    for (const MessageField& field : message.fields) {
      if (listed_ >= kMostListed) return;
      list_field(field, payload, before, names, stamp);
    }
  }

  void list_field(const MessageField& field, PayloadCursor& payload, const std::string& before,
                  const std::vector<std::string_view>& names, Stamp stamp) {
    const std::uint64_t elements = Walk::count(field, payload);
    const bool is_array = field.array != MessageField::Array::none;
    walk_.check_count(field, is_array && field.kind == FieldKind::message ? elements : 0, payload);
    if (field.kind == FieldKind::string || field.kind == FieldKind::wstring)
      return walk_.skip(field, elements, payload);
    const std::uint64_t listed = std::min(elements, kMostListedOfArray);
    for (std::uint64_t i = 0; i < listed && listed_ < kMostListed; ++i) {
      const std::string path = before + (is_array ? element_path(field, i, payload, names) : field.name);
      if (field.kind == FieldKind::message) {
        list_message(walk_.of(field), payload, path + ".", stamp);
      } else {
        ++listed_;
        take_(path, {payload.number(field.kind), stamp});
      }
    }
    if (listed_ < kMostListed) walk_.skip(field, elements - listed, payload);
  }

  std::string element_path(const MessageField& field, std::uint64_t index, const PayloadCursor& payload,
                           const std::vector<std::string_view>& names) const {
    std::string_view key;
    if (field.kind == FieldKind::message)
      key = walk_.name(walk_.of(field), payload);
    else if (index < names.size())
      key = names[index];
    const bool usable =
        !key.empty() && key.find_first_of("[]") == key.npos && key.find_first_not_of("0123456789") != key.npos;
    return with_key(field.name, usable ? std::string(key) : std::to_string(index));
  }

  Walk walk_;
  const TakeField& take_;
  std::size_t listed_ = 0;
};

}  // namespace

std::string wrong_with_path(const Definitions& definitions, const FieldPath& path) {
  const MessageDefinition* message = &definitions.messages[definitions.root];
  for (std::size_t i = 0; i < path.size(); ++i) {
    const MessageField* field = field_named(*message, path[i].field);
    if (field == nullptr) return fmt::format("{} has no field '{}'", message->name, path[i].field);
    const bool selects = path[i].index || !path[i].key.empty();
    const bool is_array = field->array != MessageField::Array::none;
    if (selects != is_array)
      return fmt::format("the field '{}' of {} is {} array", field->name, message->name, is_array ? "an" : "no");
    const bool is_last = i + 1 == path.size();
    if (is_last && !is_number(field->kind))
      return fmt::format("the field '{}' of {} is no number", field->name, message->name);
    if (!is_last && field->kind != FieldKind::message)
      return fmt::format("the field '{}' of {} has no fields", field->name, message->name);
    if (!is_last) message = &definitions.messages[field->message];
  }
  return {};
}

std::optional<FieldValue> find_field(const Definitions& definitions, PayloadCursor payload, const FieldPath& path) {
  return Finder(definitions, path).run(payload);
}

void list_fields(const Definitions& definitions, PayloadCursor payload, const TakeField& take) {
  Lister(definitions, take).run(payload);
}

}  // namespace kenaf::gap::recordings
