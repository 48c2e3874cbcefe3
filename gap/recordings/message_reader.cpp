#include "gap/recordings/message_reader.hpp"

#include <fmt/format.h>

#include "gap/recordings/json_fields.hpp"
#include "gap/recordings/payload_fields.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/standard_definitions.hpp"

namespace kenaf::gap::recordings {
namespace {

Definitions definitions_for(const Topic& topic, RosVersion version, const DefinitionTexts& more) {
  if (topic.schema_encoding == "ros2idl")
    throw RecordingError("its definition is in IDL (ros2idl), which is not supported");
  const bool has_own = !topic.schema.empty() || !topic.schema_encoding.empty();
  if (has_own && topic.schema_encoding != "ros2msg" && topic.schema_encoding != "ros1msg")
    throw RecordingError(fmt::format("its definition is in '{}', which is not supported", topic.schema_encoding));
  DefinitionTexts texts;
  if (has_own) texts = split_definitions(topic.schema, topic.type);
  // The recording's own definition takes precedence.
  texts.insert(more.begin(), more.end());
  if (version == RosVersion::ros2) texts.insert(standard_definitions().begin(), standard_definitions().end());
  if (!texts.contains(short_type(topic.type)))
    throw RecordingError(fmt::format("no definition of the type {}; give a folder with its .msg file by --definitions",
                                     topic.type.empty() ? "of its messages" : topic.type));
  return parse_definitions(texts, topic.type, version);
}

PayloadCursor payload_of(std::string_view message, RosVersion version) {
  return version == RosVersion::ros1 ? PayloadCursor::of_ros1(message) : PayloadCursor::of_cdr(message);
}

}  // namespace

MessageReader::MessageReader(const Topic& topic, const DefinitionTexts& more) {
  if (topic.message_encoding == "json") return;
  const bool is_ros1 = topic.message_encoding == "ros1";
  if (!is_ros1 && topic.message_encoding != "cdr")
    throw RecordingError(
        fmt::format("its messages are encoded in '{}', which is not supported", topic.message_encoding));
  const RosVersion version = is_ros1 ? RosVersion::ros1 : RosVersion::ros2;
  how_ = Serialised{definitions_for(topic, version, more), version};
}

std::string MessageReader::wrong_with(const FieldPath& path) const {
  const auto* serialised = std::get_if<Serialised>(&how_);
  return serialised == nullptr ? std::string() : wrong_with_path(serialised->definitions, path);
}

void MessageReader::find(std::string_view message, std::span<const FieldPath> paths, const TakeFound& take) const {
  const auto* serialised = std::get_if<Serialised>(&how_);
  if (serialised == nullptr) return find_json_fields(message, paths, take);
  const PayloadCursor payload = payload_of(message, serialised->version);
  for (std::size_t i = 0; i < paths.size(); ++i) take(i, find_field(serialised->definitions, payload, paths[i]));
}

std::optional<FieldValue> MessageReader::find(std::string_view message, const FieldPath& path) const {
  std::optional<FieldValue> found;
  find(message, std::span(&path, 1), [&found](std::size_t, const std::optional<FieldValue>& field) { found = field; });
  return found;
}

void MessageReader::list(std::string_view message, const TakeField& take) const {
  const auto* serialised = std::get_if<Serialised>(&how_);
  if (serialised == nullptr) return list_json_fields(message, take);
  list_fields(serialised->definitions, payload_of(message, serialised->version), take);
}

}  // namespace kenaf::gap::recordings
