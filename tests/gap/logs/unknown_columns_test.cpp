// Columns whose names are nearly those of the format.
#include "gap/logs/unknown_columns.hpp"

#include <catch2/catch.hpp>

using namespace kenaf;

namespace {

std::string said(const std::vector<std::string>& headers) {
  gap::logs::UnknownColumns unknown;
  char name = 'a';
  for (const std::string& header : headers) {
    const std::string file = std::string(1, name++) + ".csv";
    unknown.look_at(runs::parse_run(header + "\n", file), file);
  }
  std::string words;
  for (const auto& finding : unknown.findings()) {
    CHECK(finding.severity == gap::logs::Finding::Severity::warn);
    words += in_words(finding) + "\n";
  }
  return words;
}

}  // namespace

TEST_CASE("Columns nearly called as known ones are warned of once for all runs, with what was probably meant") {
  CHECK(said({"t_s,yaw_deg", "t_s,yaw_deg,gyro_z_rads"}) ==
        "a.csv: yaw_deg: is no known column and not used; did you mean yaw_rad? Its name says its unit; nor are "
        "gyro_z_rads (gyro_z_radps?) (as in 1 more)\n");
  CHECK_THAT(said({"t_s,x_mm"}), Catch::Contains("did you mean x_m?"));
  CHECK_THAT(said({"t_s,cmd_left_track_mps,track_lft_mps"}), Catch::Contains("track_left_mps"));
}

TEST_CASE("Columns of one's own are nobody's mistake, nor is another unit beside the known one") {
  CHECK(said({"t_s,yaw_rad,yaw_deg,temperature_c,recorded_x_m,frame,robot_time_s,mode"}) == "");
  CHECK(said({"t_s,track_left_m,track_left_mps,track_left_a,track_left_v"}) == "");
}
