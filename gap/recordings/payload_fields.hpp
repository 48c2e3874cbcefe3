// Finds and lists the numbers of a serialised message by its definition.
//
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/recordings/field_path.hpp"
#include "gap/recordings/field_value.hpp"
#include "gap/recordings/message_definition.hpp"
#include "gap/recordings/payload_cursor.hpp"

namespace kenaf::gap::recordings {

// Returns why `path` cannot lead to a number, by the definition alone; empty if it can.
std::string wrong_with_path(const Definitions& definitions, const FieldPath& path);

// Returns the number at `path`, with which nothing is wrong; empty if this message has no such element. Reads no
// further than there. Throws RecordingError if the message is shorter than its definition and its own lengths say.
std::optional<FieldValue> find_field(const Definitions& definitions, PayloadCursor payload, const FieldPath& path);

// Calls `take` for the numbers of a message in their order: of arrays the first kMostListedOfArray elements, by name
// where they have names; kMostListed in all. Throws as find_field().
void list_fields(const Definitions& definitions, PayloadCursor payload, const TakeField& take);

}  // namespace kenaf::gap::recordings
