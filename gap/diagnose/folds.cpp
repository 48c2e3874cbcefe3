#include "gap/diagnose/folds.hpp"

#include <algorithm>
#include <map>

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostFolds = 5;

Folds dealt_out(const std::vector<std::vector<std::size_t>>& blocks, std::size_t count) {
  Folds folds(count);
  std::size_t next = 0;
  for (const auto& block : blocks) {
    folds[next % count].insert(folds[next % count].end(), block.begin(), block.end());
    ++next;
  }
  std::erase_if(folds, [](const Fold& fold) { return fold.empty(); });
  return folds;
}

}  // namespace

Folds folds_by_repeat(const std::vector<std::vector<std::size_t>>& repeats) {
  std::size_t most = 1;
  for (const auto& group : repeats) most = std::max(most, group.size());
  std::vector<std::vector<std::size_t>> single;
  for (const auto& group : repeats)
    for (const std::size_t run : group) single.push_back({run});
  return dealt_out(single, std::min(kMostFolds, most > 1 ? most : repeats.size()));
}

Folds folds_by_manoeuvre(const Observations& observations, const std::vector<std::vector<std::size_t>>& repeats) {
  const auto name = [&](std::size_t run) -> const std::string& { return observations.runs[run].manoeuvre; };
  const bool all_alike = std::ranges::all_of(
      observations.runs, [&](const Observation& run) { return run.manoeuvre == observations.runs.front().manoeuvre; });

  // without names that tell them apart, runs with different commands are different manoeuvres
  std::map<std::string, std::size_t> known;
  std::vector<std::vector<std::size_t>> manoeuvres;
  for (const std::vector<std::size_t>& group : repeats) {
    const bool is_named = !all_alike && !name(group.front()).empty();
    std::size_t place = manoeuvres.size();
    if (is_named) place = known.try_emplace(name(group.front()), place).first->second;
    if (place == manoeuvres.size()) manoeuvres.emplace_back();
    manoeuvres[place].insert(manoeuvres[place].end(), group.begin(), group.end());
  }
  for (std::vector<std::size_t>& manoeuvre : manoeuvres) std::ranges::sort(manoeuvre);
  return dealt_out(manoeuvres, std::min(kMostFolds, manoeuvres.size()));
}

Folds with_halves(Folds folds, std::span<const RunPart> first_halves) {
  if (folds.size() < 2) return folds;
  for (const RunPart& half : first_halves) {
    for (Fold& fold : folds) std::erase_if(fold, [&](const RunPart& part) { return part.run == half.run; });
    folds[0].push_back(half);
    folds[1].push_back({half.run, half.to_s});
  }
  std::erase_if(folds, [](const Fold& fold) { return fold.empty(); });
  return folds;
}

bool UsedParts::holds(std::size_t run, double t_s) const {
  const bool is_in_fold =
      std::ranges::any_of(fold_, [&](const RunPart& part) { return part.run == run && part.holds(t_s); });
  return is_in_fold == inside_;
}

}  // namespace kenaf::gap::diagnose
