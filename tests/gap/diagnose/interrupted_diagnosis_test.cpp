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
using namespace kenaf::gap::diagnose;

TEST_CASE(
    "Progress moves within a stage and never falls, results up to an interruption are reported, the rest is not") {
  const test::TemporaryFolder folder;
  REQUIRE(test::kenaf_gap(folder, "simulate --manoeuvre straight-fast --repeats 2 --out real").status == 0);
  std::vector<double> done;
  std::atomic<bool> stop = false;
  DiagnosisOptions options;
  options.stop = &stop;
  options.progress = [&](const Progress& progress) {
    done.push_back(progress.done);
    stop = stop || (progress.doing == "drive to body" && progress.done > 0.4);
  };
  const Diagnosis d = diagnose_dataset(folder / "real", options);
  CHECK(std::ranges::is_sorted(done));
  CHECK(std::ranges::count_if(done, [](double part) { return part > 0.001 && part < 0.02; }) > 1);
  CHECK(std::ranges::count_if(done, [](double part) { return part > 0.02 && part < 0.34; }) > 3);

  CHECK(d.interrupted == "drive to body");
  CHECK(d.verdict == Verdict::unknown);
  CHECK(d.repeats.size() == 1);
  REQUIRE(d.stages.size() == 1);  // the one that was done by then
  CHECK(d.stages[0].passage == Passage::command_to_drive);
  CHECK(d.stages[0].nominal_floor.from_repeats);
  CHECK_FALSE(d.largest_stage.has_value());
  CHECK_THAT(diagnosis_text(d), Catch::StartsWith("UNFINISHED: interrupted while drive to body") &&
                                    Catch::Contains("2 runs of 1 manoeuvres; noise from the spread of repeated runs") &&
                                    Catch::Contains("From command to drive"));
}
