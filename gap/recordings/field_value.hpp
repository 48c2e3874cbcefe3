// A number found in a message. Thread safety: a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace kenaf::gap::recordings {

struct FieldValue {
  double value;  // may be infinite or NaN, as the message has it
  // `header.stamp` of the innermost message around it that has one, also where it is zero: nobody set it.
  std::optional<std::int64_t> stamp_ns;
};

// Takes a path as parse_field_path() reads it, and the number there.
using TakeField = std::function<void(const std::string& path, const FieldValue& value)>;

// Takes what was found at one of several paths.
using TakeFound = std::function<void(std::size_t path, const std::optional<FieldValue>& found)>;

// Most numbers of one message that are listed, chosen: pictures and clouds of points have millions.
inline constexpr std::size_t kMostListed = 500;
inline constexpr std::uint64_t kMostListedOfArray = 64;

}  // namespace kenaf::gap::recordings
