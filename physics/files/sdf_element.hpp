// An element of an SDF file (http://sdformat.org) as a value, and the places that errors name.
//
// Thread safety: values and pure functions, but for the notes.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kenaf::physics {

struct SdfElement {
  std::shared_ptr<const std::string> file;  // for errors; never null
  int line = 0;                             // in the file; 0: not known
  std::string name;
  std::string text;  // before the first child, without blanks around it
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<SdfElement> children{};
};

// Returns the first child of that name, or null.
const SdfElement* child_of(const SdfElement& element, std::string_view name);

// Returns an attribute's value; empty if there is none.
std::string_view attribute_of(const SdfElement& element, std::string_view name);

// Sets an attribute, in place of one of that name.
void set_attribute(SdfElement& element, std::string_view name, std::string_view value);

// "file:line", or the file alone if the line is not known (0).
std::string place_of(const std::string& file, int line);
std::string place_of(const SdfElement& element);

// Throws DescriptionError: "file:line: what".
[[noreturn]] void fail_at(const SdfElement& element, const std::string& what);

}  // namespace kenaf::physics
