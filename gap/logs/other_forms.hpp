// Says how files were read that are not in the format of docs/logs.md, once for all files of one form.
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

class OtherForms {
 public:
  void look_at(const runs::Run& run, const std::string& file);
  // A warning for each form (Run::reading), with the first file that has it and how many more.
  std::vector<Finding> findings() const;

 private:
  struct Form {
    std::string reading, file;
    std::size_t files;
  };
  std::vector<Form> forms_;
};

}  // namespace kenaf::gap::logs
