#include "physics/files/sdf_notes.hpp"

#include <fmt/format.h>

namespace kenaf::physics {

void SdfNotes::add(const std::string& place, const std::string& what) {
  if (said_.size() >= kMost) {
    ++more_;
    return;
  }
  const auto [text, is_new] = said_.insert(fmt::format("{}: {}", place, what));
  if (is_new) lines_.push_back(*text);
}

void SdfNotes::finish() {
  if (more_ > 0) lines_.push_back(fmt::format("{} more notes of this kind are left out", more_));
}

}  // namespace kenaf::physics
