// Shared by the parts of the check: where they report findings, and their common inputs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "can/canlog/rules.hpp"
#include "can/canopen/object.hpp"

namespace kenaf::canlog {

class Findings {
 public:
  enum class Keep : std::uint8_t { all, none };
  explicit Findings(Keep keep = Keep::all) : keep_(keep) {}

  template <class... Args>
  void add(const LogFrame& at, const Rule& rule, fmt::format_string<Args...> format, Args&&... args) {
    if (keep_ == Keep::all) found_.push_back({at.line, at.at, rule, fmt::format(format, std::forward<Args>(args)...)});
  }
  std::vector<Violation> take() { return std::move(found_); }

 private:
  Keep keep_;
  std::vector<Violation> found_;
};

// An SDO write confirmed by the node.
struct WrittenObject {
  canopen::NodeId node;
  canopen::ObjectAddress object;
  canopen::ObjectBytes value;

  // Little-endian, four bytes at most.
  std::uint32_t number() const { return canopen::get_unsigned(value, 0, std::min<std::size_t>(value.size(), 4)); }
};

}  // namespace kenaf::canlog
