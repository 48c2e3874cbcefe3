// Mapping files: keys, units, signs, and what is refused.
#include "gap/recordings/mapping.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "formats/description/description_error.hpp"

using namespace kenaf::gap::recordings;
using kenaf::description::DescriptionError;

namespace mapping_test {
namespace {

const std::string kHead = "format = \"kenaf-mapping/1\"\n[recording]\nform = \"MCAP\"\n";
const std::string kRows = "[rows]\nof = \"track_left_mps\"\n";
const std::string kLeft = "[[column]]\ncolumn = \"track_left_mps\"\nfrom = \"/a/b\"\n";

Mapping parsed(const std::string& text) {
  return parse_mapping(text, "m.toml");
}

}  // namespace

TEST_CASE("A mapping's numbers are factors to SI, with sign and further factor") {
  const Mapping mapping =
      parsed(kHead + kRows + kLeft +
             "unit = \"rpm\"\nradius_m = 0.06\nsign = -1\nfactor = 0.5\ndelay_s = 0.02\nmax_gap_s = 0.3\n"
             "sample = \"nearest\"\ntime = \"log\"\n"
             "[[column]]\ncolumn = \"cmd_flipper_fl_rad\"\nfrom = \"/c/d[0]\"\nunit = \"deg\"\n"
             "[[column]]\ncolumn = \"of_my_own\"\nfrom = \"/c/e\"\nfactor = 3\n");
  REQUIRE(mapping.columns.size() == 3);
  const ColumnMapping& left = mapping.columns[0];
  // 1 rpm is 2 pi / 60 rad/s; at 0.06 m half of it backwards
  CHECK(left.factor == Approx(-0.5 * 0.06 * 2 * std::numbers::pi / 60).epsilon(1e-15));
  CHECK(left.timing.delay_s == 0.02);
  CHECK(left.timing.sampling == Sampling::nearest);
  CHECK(left.timing.time == TimeFrom::log);
  CHECK(left.timing.max_gap_s == 0.3);
  CHECK(mapping.columns[1].factor == Approx(std::numbers::pi / 180).epsilon(1e-15));
  CHECK(mapping.columns[1].timing.sampling == Sampling::hold);  // as all commands
  CHECK(mapping.columns[2].factor == 3);
  CHECK(mapping.columns[2].timing.sampling == Sampling::linear);
  CHECK(sources_of(mapping).size() == 3);
}

TEST_CASE("Drives and poses of a mapping") {
  const Mapping mapping =
      parsed(kHead +
             "[rows]\nof = \"pose\"\n[[drive]]\nv = \"/cmd/linear.x\"\nw = \"/cmd/angular.z\"\n"
             "w_unit = \"deg/s\"\nw_sign = -1\ngauge_m = 0.4\n"
             "[pose]\nposition = [\"x\", \"y\", \"z\"]\nangles = [\"a\", \"b\", \"c\"]\norder = \"xyz\"\n"
             "angle_unit = \"deg\"\nunit = \"mm\"\nup = \"-z\"\nframe = \"world\"\n");
  REQUIRE(mapping.drives.size() == 1);
  CHECK(mapping.drives[0].commanded);
  CHECK(columns_of(mapping.drives[0])[1] == "cmd_track_right_mps");
  CHECK(mapping.drives[0].w_factor == Approx(-std::numbers::pi / 180).epsilon(1e-15));
  REQUIRE(mapping.pose);
  CHECK(mapping.pose->length_factor == 0.001);
  CHECK(mapping.pose->up == kenaf::gap::logs::Up::minus_z);
  CHECK(mapping.pose->keep_frame);
}

TEST_CASE("A wrong mapping is refused with line, column and what is wrong") {
  const std::pair<std::string, std::string> cases[] = {
      {"format = \"x\"\n", "must be \"kenaf-mapping/1\""},
      {kHead + kRows + kLeft + "unit = \"furlong\"\n", "must be one of m/s, mm/s"},
      {kHead + kRows + kLeft + "unit = \"rad/s\"\n", "needs radius_m"},
      {kHead + kRows + kLeft + "sign = 0\n", "must be 1 or -1"},
      {kHead + kRows + kLeft + "sgin = -1\n", "sgin"},
      {kHead + kRows + kLeft + kLeft, "another entry writes"},
      {kHead + kRows + kLeft + "[[drive]]\ncolumns = \"measured\"\nv = \"/a/b\"\nw = \"/a/c\"\n",
       "another entry writes"},
      {kHead + "[rows]\nof = \"battery_v\"\n" + kLeft, "must be a column that an entry writes"},
      {kHead + "[rows]\n" + kLeft, "every_s"},
      {kHead + "[rows]\nevery_s = 0.01\n", "nothing is mapped"},
      {kHead + kRows + "[[column]]\ncolumn = \"t_s\"\nfrom = \"/a/b\"\n", "must not be t_s"},
      {kHead + kRows + kLeft + "time = \"stamp\"\n", "\"header\", \"log\""},
      {kHead + kRows + kLeft + "[pose]\nposition = [\"x\"]\nquaternion = [\"a\", \"b\", \"c\", \"d\"]\n",
       "list of 2 to 3"},
      {kHead + kRows + kLeft + "[pose]\nposition = [\"x\", \"y\"]\nquaternion = [\"a\", \"b\"]\n", "list of 4"},
      {kHead + kRows + kLeft + "[pose]\nposition = [\"x\", \"y\"]\nangles = [\"a\"]\norder = \"zy\"\n",
       "axis of each angle"},
      {kHead + kRows + kLeft + "[pose]\nposition = [\"x\", \"y\"]\n", "rotation_vector or angles"},
  };
  for (const auto& [text, why] : cases) {
    INFO(text);
    CHECK_THROWS_WITH(parsed(text), Catch::StartsWith("m.toml:") && Catch::Contains(why));
  }
}

}  // namespace mapping_test
