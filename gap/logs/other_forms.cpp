#include "gap/logs/other_forms.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kenaf::gap::logs {

void OtherForms::look_at(const runs::Run& run, const std::string& file) {
  if (run.reading.empty()) return;
  const auto known = std::ranges::find(forms_, run.reading, &Form::reading);
  if (known == forms_.end())
    forms_.push_back({run.reading, file, 1});
  else
    ++known->files;
}

std::vector<Finding> OtherForms::findings() const {
  std::vector<Finding> findings;
  for (const Form& form : forms_)
    findings.push_back(
        {Finding::Severity::warn, form.file, 0, "",
         "is read with " + form.reading + (form.files > 1 ? fmt::format(" (as are {} more)", form.files - 1) : "")});
  return findings;
}

}  // namespace kenaf::gap::logs
