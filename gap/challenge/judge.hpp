// Judges whether a report is right about a case.
//
// Each stage claims as many effects as it has names and ambiguity sets together. A claim must stand for a hidden effect
// that it contains, and two claims of a stage for different ones. A report is right about hidden effects if all claims
// of all stages stand and each hidden effect has one; about nothing hidden if it says `none`; about an effect outside
// its catalogue if it says `unknown`. In the imperfect challenge the background does deviate, so that there only names
// count, except since a baseline, which has the same background. A number of the description stands for the effect that
// does the same (stand_ins.hpp).
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/challenge/plan.hpp"
#include "gap/challenge/read_report.hpp"
#include "gap/diagnose/isolability.hpp"

namespace kenaf::gap::challenge {

// Smaller effects need not be found; `none` is no error for them.
constexpr double kSurelySeen_floors = 2;
// An effect dominates from this many times the background's size; smaller ones need not be found.
constexpr double kDominates = 3;
// Likewise since a baseline, whose noise is part of the difference, too.
constexpr double kSurelySeenSince_floors = 2.7;  // a tenth less than the smallest planned size

enum class Found {
  named,      // by its name
  ambiguous,  // as a member of an ambiguity set
  wrong,      // not claimed, and another effect is named that is not hidden
  missed,     // neither
};

struct Judgement {
  std::vector<std::string> hidden;  // names as in reports; only effects in the catalogue of the diagnosis
  std::vector<Found> found;         // for each of `hidden`
  bool is_small = false;            // something is hidden, below kSurelySeen_floors or kDominates
  bool right = false;
  bool all_found = false;        // each hidden effect has a name or set of its own, whatever else is claimed
  bool named_alone = false;      // the only effect hidden, and the only one claimed, by its name
  bool names_wrong = false;      // a name in `named` that is not hidden
  bool distinguishable = false;  // the only effect hidden, and the report's own table says so; or outside the
                                 // catalogue, and no effect in it looks alike
};

// Returns the name of an effect in reports: with its parameter only if it has several.
std::string reported_name(const std::string& effect, const std::string& parameter);

// Without a report everything is missed, and nothing wrong is named.
Judgement judge(const CasePlan& plan, const std::optional<ReadReport>& report);

}  // namespace kenaf::gap::challenge
