// The score of a challenge: its figures beside their targets, and what went wrong where.
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/challenge/judge.hpp"
#include "gap/challenge/key.hpp"
#include "gap/challenge/shrinks.hpp"

namespace kenaf::gap {

struct ScoredCase {
  SealedCase sealed;
  std::optional<Told> told;
  CaseShrinks shrinks;
};

struct Figure {
  std::string_view id, what, target;
  std::size_t cases = 0;
  double value = 0, from = 0, to = 0;  // with its 95 % interval; means nothing without cases
  bool met = false;                    // the value itself, whatever the interval
  bool is_share = false;               // told in percent
};

// 95 % interval of a share, after Wilson (1927).
struct Share {
  double value, from, to;
};
Share wilson(std::size_t hits, std::size_t cases);

// The 95 % interval of a hidden effect that a report names, beside what is hidden, as a model has it (value_in_model).
struct ScoredInterval {
  std::string name;  // as reports name it
  double hidden, value, from, to;

  bool holds() const { return from <= hidden && hidden <= to; }
  // How far beside the value what is hidden lies, in half widths of the interval: of that side, as ranges cut intervals
  // off.
  double off() const;
};
std::vector<ScoredInterval> scored_intervals(const ScoredCase& scored);

// Each target of the challenge, and after them what has none.
std::vector<Figure> figures(const std::vector<ScoredCase>& cases);

// Of one effect, over all cases that hide it and leave it in the catalogue; of one that is withheld or foreign, by verdict.
struct EffectScore {
  std::string name;
  std::size_t hidden = 0, named = 0, ambiguous = 0, missed = 0, wrong = 0;
  double smallest_found_floors = 0;  // 0: never found
};
std::vector<EffectScore> scores_by_effect(const std::vector<ScoredCase>& cases);

struct OutsideScore {
  std::string name;  // "without mass" or a foreign effect's
  std::size_t cases = 0, unknown = 0, none = 0, ambiguous = 0, named = 0;
};
std::vector<OutsideScore> scores_outside(const std::vector<ScoredCase>& cases);

// Singles by size.
struct SizeScore {
  double from_floors, to_floors;
  std::size_t cases = 0, seen = 0, found = 0, named_alone = 0, names_wrong = 0;  // seen: not called `none`
};
std::vector<SizeScore> scores_by_size(const std::vector<ScoredCase>& cases);

std::string score_markdown(const std::vector<ScoredCase>& cases);
// Of the format kenaf-gap-score/1, docs/gap-challenge.md.
std::string score_json(const std::vector<ScoredCase>& cases);

}  // namespace kenaf::gap
