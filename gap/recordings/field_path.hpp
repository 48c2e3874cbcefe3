// The place of a number in a message: "twist.twist.linear.x", "position[2]", "velocity[front_left_wheel]",
// "transforms[base_link].transform.translation.x".
//
// Thread safety: values and pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

struct PathStep {
  std::string field;
  std::optional<std::uint64_t> index{};  // of an element of an array, from 0
  // Names the element. In an array of numbers: by the message's own list of names (`name` of a JointState). In an array
  // of messages: by their text (`child_frame_id` of a TransformStamped).
  std::string key{};
};
using FieldPath = std::vector<PathStep>;

// Throws RecordingError if `text` is no path. A key may hold anything but a bracket.
FieldPath parse_field_path(std::string_view text);

// "field[key]" as a path has it.
std::string with_key(std::string_view field, std::string_view key);

// Fields that name the elements of the arrays beside them, and fields by which a message in an array is named.
bool is_list_of_names(std::string_view field);
bool is_name_of_element(std::string_view field);

}  // namespace kenaf::gap::recordings
