// Any message by any definition, a zero byte between: the first byte says the encoding. What is listed can be found.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/recording_error.hpp"

using namespace kenaf::gap::recordings;

namespace {

// Finds each number that was listed, by its path, with the same value.
void find_what_is_listed(const MessageReader& reader, std::string_view message) {
  std::size_t listed = 0;
  reader.list(message, [&](const std::string& path, const FieldValue& value) {
    if (++listed > 50) return;
    const FieldPath steps = parse_field_path(path);
    if (!reader.wrong_with(steps).empty()) __builtin_trap();
    const auto found = reader.find(message, steps);
    // Two elements of one name are listed both, and found as the first.
    const bool by_name = std::ranges::any_of(steps, [](const PathStep& step) { return !step.key.empty(); });
    if (!by_name && (!found || (found->value != value.value && !std::isnan(value.value)))) __builtin_trap();
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t between = text.find('\0');
  if (size < 2 || between == text.npos || size > 65536) return 0;
  const bool is_ros1 = text[0] == '1', is_json = text[0] == 'j';
  Topic topic{"/topic",
              "pkg/msg/Type",
              is_json   ? "json"
              : is_ros1 ? "ros1"
                        : "cdr",
              is_ros1 ? "ros1msg" : "ros2msg",
              std::string(text.substr(1, between - 1)),
              1};
  if (between == 1) topic.type = "sensor_msgs/msg/JointState", topic.schema_encoding.clear();
  try {
    find_what_is_listed(MessageReader(topic, {}), text.substr(between + 1));
  } catch (const RecordingError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
