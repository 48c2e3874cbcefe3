// Charts: round ticks, lines of fewer points, and SVG that any reader takes.
#include "gap/plot/chart.hpp"

#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <limits>

#include "gap/plot/axis.hpp"
#include "gap/plot/simplify.hpp"
#include "tests/gap/svg_attributes.hpp"

using namespace kenaf::gap::plot;

namespace {

using Labels = std::vector<std::string>;

double attribute(const std::string& svg, const std::string& name) {
  const std::vector<std::string> values = kenaf::test::attributes(svg, name);
  REQUIRE(!values.empty());
  return std::stod(values.front());
}

}  // namespace

TEST_CASE("Ticks are multiples of 1, 2 or 5 times a power of ten, with the decimals that they need") {
  CHECK(round_ticks({0, 12}, 8).labels == Labels{"0", "2", "4", "6", "8", "10", "12"});
  CHECK(round_ticks({-0.2, 2.2}, 6).labels == Labels{"0", "0.5", "1.0", "1.5", "2.0"});
  CHECK(round_ticks({-0.031, 0.012}, 5).labels == Labels{"-0.03", "-0.02", "-0.01", "0", "0.01"});
  CHECK(round_ticks({0, 1}, 2).labels == Labels{"0", "1"});
  CHECK(round_ticks({0, 0.3}, 4).labels == Labels{"0", "0.1", "0.2", "0.3"});
  CHECK(round_ticks({1990, 2010}, 5).labels == Labels{"1990", "1995", "2000", "2005", "2010"});
}

TEST_CASE("Ticks of any range: never more than asked for, always within it") {
  for (const Range range : {Range{5, 5}, {0, 0}, {-1e6, -1e6}, {1e-12, 2e-12}, {-1e9, 1e9}, {0.999999, 1.000001}}) {
    for (int at_most = 2; at_most < 12; ++at_most) {
      const Ticks ticks = round_ticks(range, at_most);
      const Range shown = with_extent(range);
      CHECK(ticks.at.size() <= static_cast<std::size_t>(at_most));
      CHECK(ticks.at.size() == ticks.labels.size());
      for (const double at : ticks.at) {
        CHECK(at >= shown.low - 1e-6 * shown.span());
        CHECK(at <= shown.high + 1e-6 * shown.span());
      }
    }
  }
}

TEST_CASE("A straight line keeps its ends, a corner stays, and no point was farther than the tolerance") {
  std::vector<Point> line;
  for (int i = 0; i <= 100; ++i) line.emplace_back(i, std::abs(i - 50));
  const auto few = simplified(line, 0.1);
  REQUIRE(few.size() == 3);
  CHECK(few[1] == Point(50, 0));

  std::vector<Point> wave;
  for (int i = 0; i <= 1000; ++i) wave.emplace_back(i, 30 * std::sin(0.02 * i));
  const auto kept = simplified(wave, 0.2);
  CHECK(kept.size() < 200);
  CHECK(simplified(wave, 0).size() > 900);
  std::size_t next = 1;
  for (const Point& p : wave) {
    while (kept[next].x() < p.x()) ++next;
    const Point along = (kept[next] - kept[next - 1]).normalized(), away = p - kept[next - 1];
    CHECK(std::abs(along.x() * away.y() - along.y() * away.x()) <= 0.2 + 1e-9);
  }
}

TEST_CASE("Words are escaped, and colours come by role") {
  Chart chart;
  chart.title = "a < b & \"c\"";
  chart.x_label = "x <m>";
  chart.lines = {{{{0, 0}, {1, 1}}, Ink::sim, Stroke::dashed, "R&D"}};
  const std::string svg = to_svg(chart);
  CHECK_THAT(svg, Catch::Contains("a &lt; b &amp; &quot;c&quot;") && Catch::Contains("x &lt;m&gt;") &&
                      Catch::Contains("R&amp;D") && Catch::Contains("class=\"line sim dashed\""));
  CHECK_THAT(svg, !Catch::Contains("R&D"));
  CHECK_THAT(std::string(style_sheet()), Catch::Contains(".line.sim") && Catch::Contains("prefers-color-scheme: dark"));
}

TEST_CASE("A break parts a line, without a finite point the chart says so") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Chart chart;
  chart.lines = {{{{0, 0}, {1, 1}, {nan, 0}, {2, 0}, {3, nan}}, Ink::real, Stroke::solid, ""}};
  const std::string svg = to_svg(chart);
  const std::size_t line = svg.find("class=\"line real solid\" d=\"");
  REQUIRE(line != std::string::npos);
  std::string strokes = kenaf::test::attributes(svg.substr(line), "d").front();
  CHECK_THAT(strokes, Catch::EndsWith("h0.1"));
  std::erase_if(strokes, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) == 0; });
  CHECK(strokes == "MLMh");
  CHECK_THAT(svg, !Catch::Contains("nan") && !Catch::Contains("inf"));

  chart.lines = {{{{nan, nan}}, Ink::real, Stroke::solid, "pitch"}};
  CHECK_THAT(to_svg(chart), Catch::Contains("not measured"));
  chart.lines.clear();
  CHECK_THAT(to_svg(chart), Catch::Contains("not measured"));
}

TEST_CASE("With equal scales a metre is as long in both directions") {
  Chart chart;
  chart.equal_scales = true;
  chart.width_px = 1084;  // 1000 for the plot
  chart.lines = {{{{0, 0}, {4, 1}}, Ink::real, Stroke::solid, ""}};
  // 4 m on 1000 px: 1 m is 250 px
  CHECK_THAT(to_svg(chart), Catch::Contains("d=\"M0.0 250.0L1000.0 0.0\""));

  chart.lines = {{{{0, 0}, {1, 4}}, Ink::real, Stroke::solid, ""}};  // high: still to scale, about its middle
  CHECK_THAT(to_svg(chart), Catch::Contains("d=\"M457.5 340.0L542.5 0.0\""));
  CHECK(attribute(to_svg(chart), "height") == Approx(340 + 92));
}
