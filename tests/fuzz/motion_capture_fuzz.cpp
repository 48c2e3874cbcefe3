// Any run and motion capture, one after the other with a zero byte between: both are refused with a place, or merged or
// checked; what is merged can be written, and every pose is finite.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "gap/logs/merge_pose.hpp"
#include "gap/logs/plausibility.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t between = text.find('\0');
  if (between == text.npos || size > 8192) return 0;
  try {
    const runs::Run run = runs::parse_run(text.substr(0, between), "run");
    for (const gap::logs::Finding& finding : gap::logs::check_run(run, "run", nullptr))
      if (finding.text.empty() || finding.line >= run.first_line + std::max<std::size_t>(run.row_count(), 1))
        __builtin_trap();
    const auto capture =
        gap::logs::parse_motion_capture(text.substr(between + 1), "capture", gap::logs::LengthUnit::metres);
    for (const bool given : {true, false}) {
      gap::logs::MergeOptions options;
      if (given) options.offset_s = 0;
      const gap::logs::MergedRun merged = gap::logs::merge_pose(run, capture, options);
      if (merged.rows_with_pose == 0 || merged.run.row_count() != run.row_count()) __builtin_trap();
      if (!given && !(merged.offset.standard_error_s >= 0)) __builtin_trap();
      for (const double value : merged.run.column("x_m"))
        if (std::isinf(value)) __builtin_trap();
    }
  } catch (const runs::RunFileError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  } catch (const gap::logs::NoOffset& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
