#include <algorithm>
#include <iterator>
#include <utility>

#include "gap/candidates/candidate.hpp"

namespace kenaf::gap::candidates {

bool is_part_of(const Candidate& part, const Candidate& whole) {
  return !part.part_of.empty() && part.part_of == whole.effect;
}

std::vector<Candidate> all_candidates(const physics::RobotDescription& robot, bool has_obstacles) {
  std::vector<Candidate> all = catalogue_candidates(robot, has_obstacles);
  std::ranges::move(description_candidates(robot), std::back_inserter(all));
  return all;
}

std::vector<Candidate> leave_out(std::vector<Candidate> all, std::span<const std::string> left_out) {
  const auto is_left_out = [&](const std::string& name) { return std::ranges::count(left_out, name) > 0; };
  std::vector<Candidate> kept;
  for (Candidate& candidate : all) {
    if (is_left_out(candidate.effect) || is_left_out(candidate.same_as)) continue;
    const auto same = std::ranges::find(kept, candidate.same_as, &Candidate::effect);
    if (same == kept.end())
      kept.push_back(std::move(candidate));
    else if (same->whole == 0)
      same->whole = same->neutral != 0 ? same->neutral : candidate.whole;  // a ratio; else an offset
  }
  return kept;
}

}  // namespace kenaf::gap::candidates
