// What the parts of the SDF reader share: where an element stands, how it is refused and how it is left out.
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

// Lists what the world's elements hold and this simulator does not know, an element a line.
void list_unknown(const SdfPlaces& places, const sdf::ElementPtr& element);

}  // namespace kenaf::physics
