// What is said about an SDF file: the place of an element, errors, and notes on what is not simulated.
#pragma once

#include <cstddef>
#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <string>
#include <unordered_set>
#include <vector>

namespace kenaf::physics {

inline constexpr double kMaxCoordinate_m = 1e5;

// "file:line", or the file alone if the line is not known (0).
std::string place_of(const std::string& file, int line);
std::string place_of(const sdf::ElementPtr& element);

// What libsdformat says, without the line break that some of it ends in.
std::string message_of(const sdf::Error& error);

// Throws DescriptionError: "file:line: what".
[[noreturn]] void fail_at(const sdf::ElementPtr& element, const std::string& what);

// Collects "place: what" in a list of the caller's, each text once: a model that is included a hundred times says the
// same a hundred times.
class SdfNotes {
 public:
  static constexpr std::size_t kMost = 1000;

  explicit SdfNotes(std::vector<std::string>& lines) : lines_(lines) {}

  void add(const std::string& place, const std::string& what);
  // The last line, if there are more than kMost: how many more.
  void finish();

 private:
  std::vector<std::string>& lines_;
  std::unordered_set<std::string> said_;
  std::size_t more_ = 0;
};

}  // namespace kenaf::physics
