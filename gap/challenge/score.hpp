// The score of a challenge: its figures with their targets, and the cases that went wrong.
//
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/challenge/figure.hpp"
#include "gap/challenge/judge.hpp"
#include "gap/challenge/key.hpp"
#include "gap/challenge/shrinks.hpp"

namespace kenaf::gap::challenge {

struct ScoredCase {
  SealedCase sealed;
  std::optional<ReadReport> report;
  CaseShrinks shrinks;
};

// The 95 % interval of a hidden effect that a report names, and the hidden value in the model (value_in_model).
struct ScoredInterval {
  std::string name;  // as reports name it
  double hidden, value, from, to;

  bool holds() const { return from <= hidden && hidden <= to; }
  // Distance of the hidden value from the reported one, in half widths of the interval on that side: ranges may cut
  // one side off.
  double off() const;
};
std::vector<ScoredInterval> scored_intervals(const ScoredCase& scored);

// The share of a stage's gap that a hidden effect explains, as stated in the report and in truth.
struct ScoredShare {
  std::string name, stage;
  double stated, truth;
};
// In the imperfect challenge, for effects that are named or in a set.
std::vector<ScoredShare> scored_shares(const ScoredCase& scored);

// Returns the figures that have targets, then those that have none. The imperfect challenge has its own.
std::vector<Figure> figures(const std::vector<ScoredCase>& cases);
bool is_imperfect(const std::vector<ScoredCase>& cases);
std::vector<Figure> figures_of_imperfect(const std::vector<ScoredCase>& cases);

// One effect over all cases that hide it and leave it in the catalogue.
struct EffectScore {
  std::string name;
  std::size_t hidden = 0, named = 0, ambiguous = 0, missed = 0, wrong = 0;
  double smallest_found_floors = 0;  // 0: never found
};
std::vector<EffectScore> scores_by_effect(const std::vector<ScoredCase>& cases);

// One withheld or foreign effect, by verdict.
struct OutsideScore {
  std::string name;  // "without mass" or a foreign effect's
  std::size_t cases = 0, unknown = 0, none = 0, ambiguous = 0, named = 0;
};
std::vector<OutsideScore> scores_outside(const std::vector<ScoredCase>& cases);

// Singles by size.
struct SizeScore {
  double from, to;  // floors; of the imperfect challenge times the background
  std::size_t cases = 0, seen = 0, found = 0, named_alone = 0, names_wrong = 0;  // seen: not called `none`
};
std::vector<SizeScore> scores_by_size(const std::vector<ScoredCase>& cases);

std::string score_markdown(const std::vector<ScoredCase>& cases);
// Returns the score in the format kenaf-gap-score/1, with the terms of docs/gap-challenge.md. A figure without cases
// has no value, one that is no share no hits, and one without a target is neither met nor missed.
//   {"format": "kenaf-gap-score/1",
//    "figures": [{"id", "what", "cases", "hits", "value", "ci95", "target", "met"}],
//    "cases": [{"name", "stratum", "hidden", "looks_like", "report", "small", "right", "named_alone",
//               "can_be_told_apart", "names_wrong", "intervals": [{"name", "hidden", "value", "ci95"}],
//               "shares": [{"name", "stage", "stated", "truth"}],
//               "shrink_heldout": [{"before", "floor", "report", "truth"}],
//               "shrink_unseen": {"before", "floor", "report", "truth"}}]}
std::string score_json(const std::vector<ScoredCase>& cases);

}  // namespace kenaf::gap::challenge
