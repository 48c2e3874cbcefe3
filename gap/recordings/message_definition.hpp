// Definitions of messages as ROS writes them (.msg), parsed so that a payload can be walked by them.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

enum class FieldKind {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  wstring,
  time,      // of ROS 1: seconds and nanoseconds in 32 bits each, unsigned
  duration,  // of ROS 1: the same, signed
  message,
};

// Bytes of a number in a payload; 0 of texts and messages.
std::size_t size_of(FieldKind kind);

struct MessageField {
  enum class Array { none, fixed, sequence };
  std::string name;
  FieldKind kind;
  std::size_t message = 0;  // in Definitions::messages, of FieldKind::message
  Array array = Array::none;
  std::uint64_t length = 0;  // of a fixed array
};

struct MessageDefinition {
  std::string name;  // "geometry_msgs/Twist"
  std::vector<MessageField> fields;
  std::uint64_t least_bytes = 0;  // a payload without any padding has at least so many
};

struct Definitions {
  std::vector<MessageDefinition> messages;
  std::size_t root = 0;
};

enum class RosVersion { ros1, ros2 };  // of a definition: "time" and "Header" differ

// "geometry_msgs/msg/Twist" and "geometry_msgs/Twist" are one type: the latter.
std::string short_type(std::string_view type);

// Texts of definitions by short type, without the definitions that they depend on.
using DefinitionTexts = std::map<std::string, std::string>;

// Splits a recording's definition of `type` at its lines of "=" into those of `type` and of all that it depends on.
// Throws RecordingError if one of them is an IDL definition.
DefinitionTexts split_definitions(std::string_view text, std::string_view type);

// Parses `type` and all that it depends on. Throws RecordingError with the type and the line if a line is no field, a
// type is missing in `texts`, depends on itself or lies more than 32 levels deep.
Definitions parse_definitions(const DefinitionTexts& texts, std::string_view type, RosVersion version);

}  // namespace kenaf::gap::recordings
