// The program kenaf-draw: pictures of the size asked for, and clear words where the input is wrong.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "formats/runs/dataset.hpp"
#include "tests/support/outcome.hpp"

using namespace kenaf;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

namespace {

test::Outcome kenaf_draw(const TemporaryFolder& folder, const std::string& arguments) {
  // Fontconfig keeps what it read until the process ends, which a leak sanitizer would report.
  write_file(folder / "leaks.txt", "leak:libfontconfig\n");
  return test::outcome_in(folder,
                          "LSAN_OPTIONS=suppressions=leaks.txt:print_suppressions=0 '" KENAF_DRAW "' " + arguments);
}

unsigned big_endian(const std::string& bytes, std::size_t offset) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(offset + i));
  return value;
}

// PNG: eight bytes of signature, then the IHDR chunk: length, name, width, height.
void check_png(const std::string& bytes, unsigned width, unsigned height) {
  REQUIRE(bytes.starts_with("\x89PNG\r\n\x1a\n"));
  CHECK(big_endian(bytes, 16) == width);
  CHECK(big_endian(bytes, 20) == height);
}

// 1 m ahead, then back to 3 mm beside the start: 2 m and a bit in 2 s.
const std::string kThereAndBack = "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,1,0,0\n2,0,0.003,0\n";
const std::string kOverStep =
    "t_s,x_m,y_m,z_m,pitch_rad,flipper_fl_rad\n0,0,0,0.09,0,1\n1,0.7,0,0.15,-0.5,\n2,1.5,0,0.29,0,0\n";

}  // namespace

TEST_CASE("A run becomes a PNG of the default size, and its end error is printed") {
  const TemporaryFolder folder;
  write_file(folder / "square.csv", kThereAndBack);
  const test::Outcome outcome = kenaf_draw(folder, "square.csv --out square.png");
  CHECK(outcome.error.empty());
  CHECK(outcome.status == 0);
  CHECK(outcome.out == "square: 2.000 m in 2.0 s; end 3.0 mm and 0.0° from the start\n");
  check_png(read_file(folder / "square.png"), 1920, 1200);
  CHECK_FALSE(std::filesystem::exists(folder / "square.png.part"));
}

TEST_CASE("The size asked for, every view, another run, another robot and world") {
  const TemporaryFolder folder;
  write_file(folder / "step.csv", kOverStep);
  write_file(folder / "other.csv", kThereAndBack);
  for (const std::string view : {"top", "side", "auto"}) {
    const test::Outcome outcome =
        kenaf_draw(folder, "step.csv --run other.csv --world step-200 --view " + view +
                               " --size 800x500 --title 'Over the step' --out " + view + ".png");
    CHECK(outcome.error.empty());
    CHECK(outcome.status == 0);
    check_png(read_file(folder / (view + ".png")), 800, 500);
  }
  CHECK(read_file(folder / "top.png") != read_file(folder / "side.png"));
  CHECK(kenaf_draw(folder, "step.csv --robot p2dx --world boxes --out p2dx.png").status == 0);
}

TEST_CASE("An SVG by its extension") {
  const TemporaryFolder folder;
  write_file(folder / "run.csv", kThereAndBack);
  CHECK(kenaf_draw(folder, "run.csv --out run.svg").status == 0);
  const std::string svg = read_file(folder / "run.svg");
  CHECK_THAT(svg, Catch::Contains("<svg") && Catch::EndsWith("</svg>\n"));
}

TEST_CASE("Degenerate runs are drawn: one row, no movement, a turn on the spot") {
  const TemporaryFolder folder;
  write_file(folder / "one.csv", "t_s,x_m,y_m\n0,1,1\n");
  write_file(folder / "still.csv", "t_s,x_m,y_m\n0,1,1\n1,1,1\n2,,\n");
  write_file(folder / "turn.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0,0,3\n2,0,0,-1\n");
  for (const std::string run : {"one", "still", "turn"}) {
    for (const std::string view : {"auto", "side"}) {
      const test::Outcome outcome = kenaf_draw(folder, run + ".csv --out " + run + ".png --view " + view);
      CHECK(outcome.error.empty());
      CHECK(outcome.status == 0);
    }
  }
}

TEST_CASE("A turn on the spot is said as a turn, and its noise is no way driven") {
  // 720 degrees to the left about the origin in 20 s; the position alternates by 2 mm: 4 m in all, from row to row.
  std::string rows = "t_s,x_m,y_m,yaw_rad\n";
  for (int i = 0; i <= 2000; ++i) {
    const double yaw_rad = std::remainder(i * 4 * std::numbers::pi / 2000, 2 * std::numbers::pi);
    rows += fmt::format("{:.2f},{},0,{:.6f}\n", i * 0.01, i % 2 == 0 ? 0.001 : -0.001, yaw_rad);
  }
  const TemporaryFolder folder;
  write_file(folder / "turn.csv", rows);
  CHECK(kenaf_draw(folder, "turn.csv --out a.png").out ==
        "turn: 0.0 mm in 20.0 s, turned 720.0° left; end 0.0 mm and 0.0° from the start\n");
}

TEST_CASE("A run of a dataset is drawn with the dataset's robot and world") {
  const TemporaryFolder folder;
  write_file(folder / "run-000.csv", kThereAndBack);
  runs::write_dataset(folder.path(), {"sim", "kenaf", "no-such-world", "", {}, {{"run-000.csv", "", ""}}});
  const test::Outcome outcome = kenaf_draw(folder, "run-000.csv --out a.png");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("no-such-world"));
  CHECK(kenaf_draw(folder, "run-000.csv --world flat --out a.png").status == 0);
}

TEST_CASE("Wrong input: exit status 2, what is wrong and where, and no picture") {
  const TemporaryFolder folder;
  write_file(folder / "run.csv", kThereAndBack);
  write_file(folder / "broken.csv", "t_s,x_m,y_m\n0,0,zero\n");
  write_file(folder / "blind.csv", "t_s,battery_v\n0,24\n");
  write_file(folder / "far.csv", "t_s,x_m,y_m\n0,0,0\n1.5,1e18,0\n");
  struct Case {
    std::string arguments, words;
  };
  for (const Case& c : {Case{"none.csv --out a.png", "none.csv: cannot be opened"},
                        {"broken.csv --out a.png", "broken.csv:2:5: 'zero' in column 'y_m'"},
                        {"run.csv --run broken.csv --out a.png", "broken.csv:2:5"},
                        {"blind.csv --out a.png", "blind: no row has both x_m and y_m"},
                        {"far.csv --out a.png", "far: at t_s = 1.5 the robot is more than 1000 km"},
                        {"run.csv --out a.gif", "a.gif: the picture's name must end in .png or .svg"},
                        {"run.csv --out no/such/folder/a.png", "no/such/folder/a.png"},
                        {"run.csv --out a.png --size 10x10", "--size 10x10"},
                        {"run.csv --out a.png --size wide", "--size wide"},
                        {"run.csv --out a.png --size 1920x1200x3", "--size 1920x1200x3"},
                        {"run.csv --out a.png --view below", "--view"},
                        {"run.csv --out a.png --robot no-such-robot", "no-such-robot"},
                        {"run.csv --out a.png --world no-such-world", "no-such-world"},
                        {"run.csv", "--out"},
                        {"--out a.png", "file is required"}}) {
    INFO(c.arguments);
    const test::Outcome outcome = kenaf_draw(folder, c.arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains(c.words));
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
  }
}

TEST_CASE("The option --help ends with 0") {
  const TemporaryFolder folder;
  CHECK(kenaf_draw(folder, "--help").status == 0);
}
