// Runs whose columns are given functions of time.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::test {

using ColumnOfTime = std::pair<std::string, std::function<double(double t_s)>>;

inline runs::Run made_run(double duration_s, double period_s, const std::vector<ColumnOfTime>& columns) {
  runs::Run run{{"t_s"}, {{}}};
  const auto rows = static_cast<std::size_t>(std::lround(duration_s / period_s));
  for (std::size_t i = 0; i < rows; ++i) run.values[0].push_back(static_cast<double>(i) * period_s);
  for (const auto& [name, value_at] : columns) {
    run.columns.push_back(name);
    run.values.emplace_back();
    for (const double t_s : run.values[0]) run.values.back().push_back(value_at(t_s));
  }
  return run;
}

}  // namespace kenaf::test
