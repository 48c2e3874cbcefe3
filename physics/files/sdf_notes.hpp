// What is said about an SDF file that loads: notes on what is not simulated.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace kenaf::physics {

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
