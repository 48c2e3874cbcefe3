// The size of what is hidden in a case.
#include "gap/challenge/case_scale.hpp"

#include <catch2/catch.hpp>

namespace kenaf::gap::challenge {

TEST_CASE("What an effect adds beside another one is nothing where that one hides it", "[long]") {
  // commands of at least 0.25 m/s, times 0.9 or not, are limited to 0.1 m/s
  CasePlan plan;
  plan.name = "case-007";
  plan.manoeuvres = {"straight"};
  plan.unseen = "arc";
  plan.seed = 3;
  CaseScale scale(plan, 1, nullptr);
  physics::Effects gain, limit;
  gain.command_gain = 0.9;
  limit.command_limit_forward_spm = 10;
  physics::Effects both = limit;
  both.command_gain = 0.9;
  CHECK(scale.size_of(gain).floors > 1);
  CHECK(scale.size_beside({}, gain).floors == Approx(scale.size_of(gain).floors));
  CHECK(scale.size_beside(limit, both).floors == Approx(0).margin(1e-9));
  CHECK(scale.size_beside(gain, both).floors > 1);
}

}  // namespace kenaf::gap::challenge
