// Finds and lists the numbers of a message in JSON, with the same paths as payload_fields.hpp. `true` and `false` are 1
// and 0; `null` is no number.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string_view>

#include "gap/recordings/field_path.hpp"
#include "gap/recordings/field_value.hpp"

namespace kenaf::gap::recordings {

// Calls `take` with the number at each path; empty if there is none. Throws RecordingError if `text` is no JSON. A
// stamp is `header.stamp` or `timestamp` of the innermost object around it, with `sec` and `nsec` or `nanosec`.
void find_json_fields(std::string_view text, std::span<const FieldPath> paths, const TakeFound& take);
void list_json_fields(std::string_view text, const TakeField& take);

}  // namespace kenaf::gap::recordings
