#include "tools/studies/validation/comparison_row.hpp"

#include <fmt/format.h>

namespace kenaf::validation {

std::string markdown(const ComparisonRow& row) {
  return fmt::format("| {} | {} | {:.4g} {} | {:.4g} {} | {:.3f} |\n", row.what, row.reference, row.expected, row.unit,
                     row.simulated, row.unit, row.simulated / row.expected);
}

}  // namespace kenaf::validation
