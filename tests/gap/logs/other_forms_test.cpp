// Files in other forms than the format's: read, and said once.
#include <catch2/catch.hpp>

#include "gap/logs/motion_capture.hpp"
#include "gap/logs/other_forms.hpp"

using namespace kenaf;

TEST_CASE("How files were read is said once for each form, with the first file that has it") {
  gap::logs::OtherForms forms;
  forms.look_at(runs::parse_run("t_s,x_m\n0,1\n", "a.csv"), "a.csv");
  CHECK(forms.findings().empty());
  forms.look_at(runs::parse_run("t_s;x_m\n0,5;1\n", "b.csv"), "b.csv");
  forms.look_at(runs::parse_run("t_s\tx_m\n0\t1\n", "c.csv"), "c.csv");
  forms.look_at(runs::parse_run("t_s;x_m\n0,5;2\n", "d.csv"), "d.csv");
  const auto findings = forms.findings();
  REQUIRE(findings.size() == 2);
  CHECK(in_words(findings[0]) == "b.csv: is read with semicolons between the cells, decimal commas (as are 1 more)");
  CHECK(in_words(findings[1]) == "c.csv: is read with tabs between the cells");
  CHECK_FALSE(gap::logs::any_refused(findings));
}

TEST_CASE("A motion capture with semicolons, decimal commas and a comment: its poses, and lines of its errors") {
  const std::string head = "# capture 7\nt_s;x_m;y_m;yaw_deg\n";
  const auto capture = gap::logs::parse_motion_capture(head + "12,5;0,25;-0,5;90\n13;0,5;-0,5;90\n", "m.csv",
                                                       gap::logs::LengthUnit::metres);
  REQUIRE(capture.poses.size() == 2);
  CHECK(capture.poses[0].t_s == 12.5);
  CHECK(capture.poses[0].p_m == Eigen::Vector3d(0.25, -0.5, 0));
  CHECK_THROWS_WITH(gap::logs::parse_motion_capture(head + "12,5;0,25;-0,5;90\n13;1e7;-0,5;90\n", "m.csv",
                                                    gap::logs::LengthUnit::metres),
                    "m.csv:4:1: an implausible time or position");
}

TEST_CASE("Times that cannot be seconds are named, and no other column for them") {
  // 20 rows 1000 apart: microseconds a thousand times a second if 0.2 m/s make the travel, else nobody knows
  const auto words = [](double travel_a_row_m) {
    std::string text =
        "t_s,cmd_track_left_mps,cmd_track_right_mps,track_left_mps,track_right_mps,track_left_m,x_m,y_m\n";
    for (int i = 0; i < 20; ++i)
      text += std::to_string(1000 * i) + ",0.2,0.2,0.2,0.2," + std::to_string(travel_a_row_m * i) + ",0,0\n";
    const auto findings = gap::logs::check_run(runs::parse_run(text, "run.csv"), "run.csv", nullptr);
    REQUIRE(findings.size() == 1);
    CHECK(gap::logs::any_refused(findings));
    return in_words(findings[0]);
  };
  CHECK_THAT(words(0.0002), Catch::StartsWith("run.csv: t_s: looks like microseconds: it steps by 1e+03"));
  CHECK_THAT(words(0), Catch::StartsWith("run.csv: t_s: steps by 1e+03, too long for seconds"));
}
