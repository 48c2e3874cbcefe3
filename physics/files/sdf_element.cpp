#include "physics/files/sdf_element.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "formats/description/description_error.hpp"

namespace kenaf::physics {

const SdfElement* child_of(const SdfElement& element, std::string_view name) {
  const auto found = std::ranges::find(element.children, name, &SdfElement::name);
  return found == element.children.end() ? nullptr : &*found;
}

std::string_view attribute_of(const SdfElement& element, std::string_view name) {
  for (const auto& [key, value] : element.attributes)
    if (key == name) return value;
  return {};
}

void set_attribute(SdfElement& element, std::string_view name, std::string_view value) {
  for (auto& [key, old] : element.attributes) {
    if (key != name) continue;
    old = value;
    return;
  }
  element.attributes.emplace_back(name, value);
}

std::string place_of(const std::string& file, int line) {
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

std::string place_of(const SdfElement& element) {
  return place_of(*element.file, element.line);
}

void fail_at(const SdfElement& element, const std::string& what) {
  throw description::DescriptionError(fmt::format("{}: {}", place_of(element), what));
}

}  // namespace kenaf::physics
