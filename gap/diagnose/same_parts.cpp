#include "gap/diagnose/same_parts.hpp"

#include <algorithm>

namespace kenaf::gap::diagnose {
namespace {

// Whole and part are compared at this share of the way to the end of the range (chosen).
constexpr double kOfRange = 0.25;
// Largest difference between the shifts of a whole and of a part that does the same, as a share of the whole's
// (chosen).
constexpr double kSame = 0.01;

struct PartOfWhole {
  std::size_t part, whole;
};

std::vector<PartOfWhole> parts_of_wholes(std::span<const candidates::Candidate> candidates,
                                         std::span<const std::size_t> possible) {
  std::vector<PartOfWhole> result;
  for (const std::size_t part : possible)
    for (const std::size_t whole : possible)
      if (candidates::is_part_of(candidates[part], candidates[whole])) result.push_back({part, whole});
  return result;
}

}  // namespace

std::vector<std::size_t> without_same_parts(const StageData& data, std::span<const candidates::Candidate> candidates,
                                            std::span<const std::size_t> possible, const Simulate& simulate) {
  std::vector<std::size_t> kept(possible.begin(), possible.end());
  const std::vector<PartOfWhole> pairs = parts_of_wholes(candidates, possible);
  if (pairs.empty()) return kept;
  std::vector<Settings> asked;
  for (const auto& [p, w] : pairs) {
    const candidates::Candidate &part = candidates[p], &whole = candidates[w];
    const double value = whole.present + kOfRange * (whole.max - whole.present);
    asked.push_back({{w, value}});
    asked.push_back({{p, part.present * value / whole.present}});
  }
  const std::vector<GroupVectors> shifts = simulate(asked, Fidelity::coarse);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const GroupVectors& of_whole = shifts[2 * i];
    if (length_in_noise(data, less(of_whole, shifts[2 * i + 1])) <= kSame * length_in_noise(data, of_whole))
      std::erase(kept, pairs[i].part);
  }
  return kept;
}

}  // namespace kenaf::gap::diagnose
