// Tracks that do not do what a small command asks: dragged by the other one, or within the drive's dead band.
#include <catch2/catch.hpp>

#include "gap/logs/plausibility.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;

namespace {

// 6 s, from 0.5 s on with steady speeds. The pose goes ahead at the mean of both tracks.
std::string refused(double command_left, double command_right, double left, double right) {
  const auto steady = [](double mps) { return [=](double t_s) { return t_s < 0.5 ? 0 : mps; }; };
  const auto way = [=](double t_s) { return t_s < 0.5 ? 0 : 0.5 * (left + right) * (t_s - 0.5); };
  const runs::Run run = test::made_run(6, 0.05,
                                       {{"cmd_track_left_mps", steady(command_left)},
                                        {"cmd_track_right_mps", steady(command_right)},
                                        {"track_left_mps", steady(left)},
                                        {"track_right_mps", steady(right)},
                                        {"x_m", way},
                                        {"y_m", [](double) { return 0.0; }},
                                        {"yaw_rad", [](double t_s) { return 0.001 * t_s; }}});
  std::string text;
  for (const auto& finding : gap::logs::check_run(run, "run.csv", nullptr))
    if (finding.severity == gap::logs::Finding::Severity::refuse) text += in_words(finding) + "\n";
  return text;
}

}  // namespace

TEST_CASE("A track that is dragged back faster than it is commanded is no turned sign") {
  // 0.03 m/s commanded, dragged back at 0.3 m/s by a track that does as commanded, or by a slope
  CHECK(refused(0.5, 0.03, 0.5, -0.3) == "");
  CHECK(refused(0.05, 0.05, -0.3, -0.3) == "");
  CHECK_THAT(refused(0.3, 0.3, -0.3, 0.3), Catch::StartsWith("run.csv: track_left_mps: has the opposite sign"));
  CHECK_THAT(refused(0.3, 0.2, 0.3, -0.1), Catch::StartsWith("run.csv: track_right_mps: has the opposite sign"));
}

TEST_CASE("A track that stands while it is commanded next to nothing has no dead encoder") {
  CHECK(refused(0.5, 0.03, 0.5, 0) == "");  // 0.165 m commanded
  CHECK(refused(0.04, 0.5, 0, 0.5) == "");
  CHECK_THAT(refused(0.5, 0.2, 0.5, 0), Catch::Contains("run.csv: track_right_mps: never changes, although 1.1 m"));
}
