#include "physics/files/sdf_notes.hpp"

#include <fmt/format.h>

#include "formats/description/description_error.hpp"

namespace kenaf::physics {

std::string place_of(const std::string& file, int line) {
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

std::string place_of(const sdf::ElementPtr& element) {
  return place_of(element->FilePath(), element->LineNumber().value_or(0));
}

std::string message_of(const sdf::Error& error) {
  const std::string message = error.Message();
  return message.substr(0, message.find_last_not_of(" \n") + 1);
}

void fail_at(const sdf::ElementPtr& element, const std::string& what) {
  throw description::DescriptionError(fmt::format("{}: {}", place_of(element), what));
}

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
