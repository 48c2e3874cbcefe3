// Finds and lists the numbers of a message in JSON, with the same paths as payload_fields.hpp. `true` and `false` are 1
// and 0; `null` is no number.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string_view>

#include "gap/recordings/field_path.hpp"
#include "gap/recordings/field_value.hpp"

namespace kenaf::gap::recordings {

// Returns the number at `path`; empty if there is none. Throws RecordingError if `text` is no JSON. A stamp is
// `header.stamp` or `timestamp` of the innermost object around it, with `sec` and `nsec` or `nanosec`.
std::optional<FieldValue> find_json_field(std::string_view text, const FieldPath& path);
void list_json_fields(std::string_view text, const TakeField& take);

}  // namespace kenaf::gap::recordings
