#include "gap/compare/pair_runs.hpp"

#include <map>

namespace kenaf::gap::compare {

namespace {

using Repeats = std::map<std::string, std::vector<std::size_t>>;

Repeats repeats_of(const runs::Dataset& dataset) {
  Repeats repeats;
  for (std::size_t i = 0; i < dataset.runs.size(); ++i) repeats[dataset.runs[i].manoeuvre].push_back(i);
  return repeats;
}

std::string why_alone(const std::string& manoeuvre, const std::string& other, std::size_t others) {
  return "the " + other + " dataset has " + (others == 0 ? "no run" : "only " + std::to_string(others)) +
         (manoeuvre.empty() ? " without a manoeuvre" : " of this manoeuvre");
}

}  // namespace

RunPairs pair_runs(const runs::Dataset& real, const runs::Dataset& sim) {
  const Repeats of_real = repeats_of(real), of_sim = repeats_of(sim);
  const auto count = [](const Repeats& repeats, const std::string& manoeuvre) {
    const auto found = repeats.find(manoeuvre);
    return found == repeats.end() ? std::size_t{0} : found->second.size();
  };

  // Each real run takes the simulated one of the same repeat, if there is one; then the simulated runs beyond the last
  // real repeat are left over.
  RunPairs result;
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < real.runs.size(); ++i) {
    const std::string& manoeuvre = real.runs[i].manoeuvre;
    const std::size_t repeat = seen[manoeuvre]++, others = count(of_sim, manoeuvre);
    if (repeat < others) {
      result.pairs.push_back({i, of_sim.at(manoeuvre)[repeat], repeat});
    } else {
      result.left_out.push_back({LeftOutRun::Side::real, i, why_alone(manoeuvre, "simulated", others)});
    }
  }

  seen.clear();
  for (std::size_t i = 0; i < sim.runs.size(); ++i) {
    const std::string& manoeuvre = sim.runs[i].manoeuvre;
    const std::size_t others = count(of_real, manoeuvre);
    if (seen[manoeuvre]++ >= others) {
      result.left_out.push_back({LeftOutRun::Side::sim, i, why_alone(manoeuvre, "real", others)});
    }
  }
  return result;
}

}  // namespace kenaf::gap::compare
