// Names columns that nothing uses although they look like one of docs/logs.md under another name: "yaw_deg".
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

class UnknownColumns {
 public:
  void look_at(const runs::Run& run, const std::string& file);
  // At most one warning for all runs, with each column and the one that was probably meant: of the same quantity in
  // another unit, or of nearly the same name (settings::nearest_word()). A run that has the known column, too, may call
  // others as it likes.
  std::vector<Finding> findings() const;

 private:
  struct Unknown {
    std::string name, meant;
  };
  std::string file_;  // the first one that has any
  std::vector<Unknown> unknown_;
  std::size_t files_ = 0;
};

}  // namespace kenaf::gap::logs
