// Dates with times of day as text (ISO 8601), which pandas and spreadsheets write.
//
// Thread safety: a pure function.
#pragma once

#include <optional>
#include <string_view>

namespace kenaf::gap::recordings {

// "2024-05-01 12:00:00.25" or with T, and with Z or an offset "+02:00" behind it, as seconds since 1970; without an
// offset as UTC. Empty if the text is none.
std::optional<double> seconds_of_date(std::string_view text);

}  // namespace kenaf::gap::recordings
