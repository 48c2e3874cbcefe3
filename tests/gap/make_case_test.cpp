// The data of a challenge's cases: what is hidden is as large as asked, and is not to be read anywhere.
#include "gap/challenge/make_case.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/challenge/shrinks.hpp"
#include "runs/dataset.hpp"
#include "tests/runs/temporary_folder.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::TemporaryFolder;

TEST_CASE("A case is made: its effect is as large as asked, and its folder does not say which it is", "[long]") {
  const TemporaryFolder folder;
  CasePlan plan;
  plan.name = "case-007";
  plan.stratum = Stratum::single;
  plan.effects = {{"encoder_scale", "scale", 4, 0}};
  plan.manoeuvres = {"straight-fast"};
  plan.unseen = "arc";
  plan.physics.time_step_s /= 2;
  plan.seed = 3;
  make_case(plan, folder / "case", 1);
  const HiddenEffect& hidden = plan.effects.front();
  CHECK(plan.manoeuvres == std::vector<std::string>{"straight-fast"});
  CHECK(hidden.value != 1);
  CHECK(hidden.floors == Approx(4).epsilon(0.06));  // made at most a twentieth larger

  // Gap and floor are independent, so that their squares add: before^2 = floor^2 + (size floor)^2. Start pose and noise
  // are others than those by which the size was made.
  const Shrinks shrinks = shrinks_on(folder / "case", {}, hidden_effects(plan), 1);
  const double ratio = shrinks.before / shrinks.floor;
  CHECK(std::sqrt(ratio * ratio - 1) == Approx(4).epsilon(0.2));
  CHECK(shrinks.told == Approx(0).margin(1e-9));  // by no effect at all

  const runs::Dataset dataset = runs::read_dataset(folder / "case");
  CHECK(dataset.source == "real");
  CHECK(dataset.runs.size() == 2);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "case")) {
    CHECK(entry.path().string().find("encoder") == std::string::npos);
    const std::string bytes = test::read_file(entry.path());
    CHECK(bytes.find("encoder") == std::string::npos);
    CHECK(bytes.find("single") == std::string::npos);
    CHECK(bytes.find("challenge") == std::string::npos);
  }
}
