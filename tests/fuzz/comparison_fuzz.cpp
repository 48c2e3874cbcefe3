// Any two runs, one after the other with a zero byte between, can be compared or it is said why not; the report of
// those that can is whole.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "gap/compare/report.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t between = text.find('\0');
  if (between == text.npos || size > 8192) return 0;
  gap::compare::PoseFrames real, sim;
  try {
    real = gap::compare::pose_frames(runs::parse_run(text.substr(0, between), "real"));
    sim = gap::compare::pose_frames(runs::parse_run(text.substr(between + 1), "sim"));
  } catch (const runs::RunFileError&) {
    return 0;
  }
  for (const gap::compare::PoseFrames* side : {&real, &sim})
    if (side->unusable.empty() != (side->frames.size() >= 2)) __builtin_trap();
  if (!real.unusable.empty() || !sim.unusable.empty()) return 0;

  gap::compare::ComparedRun run{};
  run.plane = gap::compare::plane_of(real.frames, sim.frames);
  for (gap::compare::PoseFrames* side : {&real, &sim})
    side->frames = gap::compare::frames_in(run.plane, std::move(side->frames));
  if (real.frames.size() < 2 || sim.frames.size() < 2) return 0;
  run.real_world = "none.sdf";  // said on the page; one that is there would only be slow
  run.start_offset = gap::compare::align_start(real.frames, sim.frames, 0.5);
  run.matching = gap::compare::match_paths(gap::compare::path_in(run.plane, real.frames),
                                           gap::compare::path_in(run.plane, sim.frames));
  run.errors = gap::compare::run_errors(run.plane, real.frames, sim.frames, run.matching.pairs);
  run.real = real.frames;
  run.sim = sim.frames;
  if (!(run.matching.cost_m >= 0) || run.errors.matched.size() != run.real.size()) __builtin_trap();
  gap::compare::Comparison comparison{};
  comparison.runs.push_back(run);
  if (!gap::compare::comparison_html(comparison).ends_with("</html>\n") ||
      gap::compare::comparison_json(comparison).empty() || gap::compare::comparison_text(comparison).empty() ||
      gap::compare::matched_csv(run).empty())
    __builtin_trap();
  return 0;
}
