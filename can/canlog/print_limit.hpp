// Which errors to print where there are many of a kind, as of a log in the wrong format.
#pragma once

#include <cstddef>
#include <map>
#include <string_view>

namespace kenaf::canlog {

class PrintLimit {
 public:
  static constexpr std::size_t kOfAKind = 20;

  explicit PrintLimit(bool all) : all_(all) {}

  // To be asked for each error; true for the first 20 of its kind, or for all. `kind` must outlive this.
  bool allows(std::string_view kind) {
    if (all_ || printed_[kind] < kOfAKind) {
      ++printed_[kind];
      return true;
    }
    ++left_out_[kind];
    return false;
  }
  // Numbers of those that were not allowed, by kind.
  const std::map<std::string_view, std::size_t>& left_out() const { return left_out_; }

 private:
  bool all_;
  std::map<std::string_view, std::size_t> printed_, left_out_;
};

}  // namespace kenaf::canlog
