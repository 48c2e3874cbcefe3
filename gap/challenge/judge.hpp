// Whether a report is right about a case.
//
// Each stage claims as many effects as it has names and ambiguity sets together, and each claim of a stage stands for a
// hidden effect of its own that it has. A report is right about hidden effects where all claims of all stages do, and
// each hidden effect has one; right about nothing hidden where it says `none`; right about what its catalogue did not
// have where it says `unknown`. In the imperfect challenge the report is right, too, that the background deviates:
// there only its names count, but of a baseline, since which it is the same. A number of the description stands for the
// effect that does the same (stand_ins.hpp).
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

// Smaller effects need not be found: `none` is no error then.
constexpr double kSurelySeen_floors = 2;
// Beside the background, an effect so many times its size dominates: smaller ones need not be found.
constexpr double kDominates = 3;
// Since a baseline, whose noise is in the difference as well.
constexpr double kSurelySeenSince_floors = 2.7;  // a tenth less than the smallest that is planned

enum class Found {
  named,      // by its name
  ambiguous,  // as a member of an ambiguity set
  wrong,      // it is not among those claimed, and another is named that is not hidden
  missed,     // neither
};

struct Judgement {
  std::vector<std::string> hidden;  // names as reports have them; of the catalogue that the diagnosis had
  std::vector<Found> found;         // of each of `hidden`
  bool is_small = false;            // something is hidden, below kSurelySeen_floors or kDominates
  bool right = false;
  bool all_found = false;          // each hidden effect has a name or set of its own, whatever else is claimed
  bool named_alone = false;        // the only effect hidden, and the only one claimed, by its name
  bool names_wrong = false;        // a name in `named` that is not hidden
  bool can_be_told_apart = false;  // the only effect hidden, and the report's own table says so; or outside the
                                   // catalogue, and nothing in it looks like that
};

// The name of an effect in reports: with its parameter only where it has several.
std::string reported_name(const std::string& effect, const std::string& parameter);

// No report is wrong about everything, but names nothing.
Judgement judge(const CasePlan& plan, const std::optional<ReadReport>& report);

}  // namespace kenaf::gap::challenge
