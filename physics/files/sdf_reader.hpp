// Shared by the parts of the SDF reader: the place of an element, and how elements are refused or skipped.
#pragma once

#include <sdf/Element.hh>
#include <string>
#include <vector>

namespace kenaf::physics {

inline constexpr double kMaxCoordinate_m = 1e5;

struct SdfPlaces {
  std::string file;
  std::vector<std::string>& unsupported;

  std::string place(const sdf::ElementPtr& element) const;
  // Throws DescriptionError: "file:line: what".
  [[noreturn]] void fail(const sdf::ElementPtr& element, const std::string& what) const;
  // Adds "file:line: what" to `unsupported`.
  void skip(const sdf::ElementPtr& element, const std::string& what) const;
};

// Lists, one line each, the elements of the world that this simulator does not support.
void list_unknown(const SdfPlaces& places, const sdf::ElementPtr& element);

}  // namespace kenaf::physics
