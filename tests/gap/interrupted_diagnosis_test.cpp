// A diagnosis that is under way: what it tells of its progress, and what it knows when it is stopped.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "gap/diagnose/report.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using namespace kenaf::gap;

TEST_CASE("Progress moves within a stage and never falls, what is known when it is stopped is told, the rest is not") {
  const test::TemporaryFolder folder;
  REQUIRE(test::kenaf_gap(folder, "simulate --manoeuvre straight-fast --repeats 2 --out real").status == 0);
  std::vector<double> done;
  std::atomic<bool> stop = false;
  DiagnosisOptions options;
  options.stop = &stop;
  options.progress = [&](const Progress& progress) {
    done.push_back(progress.done);
    stop = stop || (progress.doing == "comparing effects" && progress.done > 0.2);
  };
  const Diagnosis d = diagnose(folder / "real", options);
  CHECK(std::ranges::is_sorted(done));
  CHECK(std::ranges::count_if(done, [](double part) { return part > 0.01 && part < 0.1; }) > 3);
  CHECK(std::ranges::count_if(done, [](double part) { return part > 0.1 && part < 0.5; }) > 3);

  CHECK(d.interrupted == "comparing effects");
  CHECK(d.decision.verdict == Verdict::unknown);
  CHECK(d.repeats.size() == 1);
  CHECK(d.floor.from_repeats);
  CHECK(d.stages.size() == 3);
  CHECK_FALSE(d.next_interrupted);
  for (const double unknown :
       {d.decision.p_gap, d.decision.p_left, d.decision.p_agree, d.gap.before, d.gap.shrink.value})
    CHECK(std::isnan(unknown));
  CHECK_THAT(diagnosis_text(d), Catch::StartsWith("UNFINISHED: interrupted while comparing effects") &&
                                    Catch::Contains("2 runs of 1 manoeuvres; noise from their repeats") &&
                                    Catch::Contains("command to drive"));
}
