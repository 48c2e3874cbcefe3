// A real robot's gap: KENAF_MARMOTTE_DATA names the folder of the recorded runs. docs/gap-marmotte.md has the whole of
// them.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "gap/diagnose/diagnosis.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

TEST_CASE("The gap of a real robot in a forest: at the drives and at the ground") {
  const char* folder = std::getenv("KENAF_MARMOTTE_DATA");
  if (folder == nullptr) {
    WARN("skipped: KENAF_MARMOTTE_DATA does not name the folder of the recorded runs");
    return;
  }
  DiagnosisOptions options;
  options.robot = "marmotte";
  options.most_runs = 6;  // of 120, drawn evenly: a minute instead of twenty
  const Diagnosis d = diagnose_dataset(folder, options);
  REQUIRE(d.observations.runs.size() == 6);
  // what its drives and poses show without any model: a step of the drives takes half a second, poses come a quarter
  // of a second late, and how far the body slips differs from run to run
  REQUIRE(d.stages.size() >= 2);
  for (const StageDiagnosis& stage : d.stages) {
    if (stage.passage == Passage::body_to_sensor) continue;
    INFO(passage_name(stage.passage));
    CHECK(stage.decision.verdict != Verdict::none);
    CHECK(stage.gap.before > 2 * stage.gap.floor);
    CHECK(stage.gap.after < stage.gap.before);
  }
}
