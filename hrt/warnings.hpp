// Warnings of several causes, on the one line that hrt_get_warning gives.
//
// Thread safety: pure functions.
#pragma once

#include <string>

namespace kenaf::hrt {

// "one; other", or the one that is not empty.
inline std::string joined(const std::string& one, const std::string& other) {
  return one + (one.empty() || other.empty() ? "" : "; ") + other;
}

}  // namespace kenaf::hrt
