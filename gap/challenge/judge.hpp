// Whether a report is right about a case.
//
// A report claims as many effects as it has names and ambiguity sets together. It is right about hidden effects where it
// claims as many as there are and each is named or a member of a set, no two of the same set; right about nothing hidden
// where it says `none`; right about what its catalogue did not have where it says `unknown`.
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/challenge/plan.hpp"
#include "gap/challenge/told.hpp"
#include "gap/diagnose/isolability.hpp"

namespace kenaf::gap {

// Smaller effects need not be found: `none` is no error then.
constexpr double kSurelySeen_floors = 2;

enum class Found {
  named,      // by its name
  ambiguous,  // as a member of an ambiguity set
  wrong,      // it is not among those claimed, and another is named that is not hidden
  missed,     // neither
};

struct Judgement {
  std::vector<std::string> hidden;  // names as reports have them; of the catalogue that the diagnosis had
  std::vector<Found> found;         // of each of `hidden`
  bool is_small = false;            // something is hidden, below kSurelySeen_floors
  bool right = false;
  bool named_alone = false;         // the only effect hidden, and the only one claimed, by its name
  bool names_wrong = false;         // a name in `named` that is not hidden
  bool can_be_told_apart = false;   // the only effect hidden, and the report's own table says so; or outside the catalogue,
                                    // and nothing in it looks like that
};

// The name of an effect in reports: with its parameter only where it has several.
std::string reported_name(const std::string& effect, const std::string& parameter);

// No report is wrong about everything, but names nothing.
Judgement judge(const CasePlan& plan, const std::optional<Told>& told);

}  // namespace kenaf::gap
