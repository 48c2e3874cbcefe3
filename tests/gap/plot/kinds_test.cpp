// Rows with intervals, strips of time, discs, and dense lines: what is drawn where.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gap/plot/chart.hpp"
#include "gap/plot/row_chart.hpp"
#include "gap/plot/simplify.hpp"
#include "gap/plot/strip_chart.hpp"
#include "tests/gap/svg_attributes.hpp"
#include "tests/gap/well_formed.hpp"

using namespace kenaf::gap::plot;
using kenaf::test::fault_of_xml;

namespace {

std::vector<double> numbers(const std::string& svg, const std::string& attribute) {
  std::vector<double> all;
  for (const std::string& value : kenaf::test::attributes(svg, attribute)) all.push_back(std::stod(value));
  return all;
}

}  // namespace

TEST_CASE("Rows lie on one axis: marks at their values, beyond the view an arrow") {
  RowChart chart;
  chart.label_px = 86;
  chart.note_px = 100;
  chart.width_px = 1200;  // 1000 for the plot
  chart.view = Range{0, 100};
  chart.rows = {
      {"a", {{25, Shape::disc, Ink::real, Range{10, 40}}}, "25 %"}, {"b & c", {{150}}, ""}, {"d", {{-7}}, ""}};
  const std::string svg = to_svg(chart);
  CHECK(fault_of_xml(svg).empty());
  CHECK(numbers(svg, "cx") == std::vector<double>{250});
  CHECK_THAT(svg, Catch::Contains("M1000.0 36.0l-9") && Catch::Contains("<title>150, beyond the axis</title>"));
  CHECK_THAT(svg, Catch::Contains("M0.0 60.0l9") && Catch::Contains("<title>-7, beyond the axis</title>"));
  CHECK_THAT(svg, Catch::Contains("M100.0 12.0H400.0") && Catch::Contains("b &amp; c") && Catch::Contains("25 %"));
}

TEST_CASE("An interval that goes on beyond the view has an arrow there instead of an end") {
  RowChart chart;
  chart.label_px = 86;
  chart.width_px = 1100;
  chart.view = Range{0, 100};
  chart.rows = {{"a", {{50, Shape::disc, Ink::real, Range{20, 300}}}, ""}};
  const std::string svg = to_svg(chart);
  CHECK_THAT(svg, Catch::Contains("M200.0 12.0H1000.0M200.0 8.0v8\"/>"));
  CHECK_THAT(svg, Catch::Contains("<title>to 300, beyond the axis</title>"));
}

TEST_CASE("Labels and notes of rows are inside the chart, however long they are") {
  RowChart chart;
  chart.label_px = 80;
  chart.width_px = 540;
  chart.rows = {{std::string(30, 'a'), {{1}}, "12.3 to 45.6"}};
  CHECK_THAT(to_svg(chart), Catch::Contains(">" + std::string(30, 'a') + "</text>"));  // 216 px and the gaps
  chart.rows[0].label = std::string(100, 'a') + "the end";
  CHECK_THAT(to_svg(chart), Catch::Contains("athe end</text>") && !Catch::Contains(std::string(40, 'a')));
  chart.guides = {{1, "a guide with many words"}};
  chart.view = Range{0, 1};  // at the right edge
  const std::string svg = to_svg(chart);
  CHECK(fault_of_xml(svg).empty());
}

TEST_CASE("On a logarithmic axis a factor of ten is as long everywhere, and what is not positive is at the left") {
  RowChart chart;
  chart.label_px = 86;
  chart.width_px = 1100;
  chart.logarithmic = true;
  chart.view = Range{0.1, 100};  // three factors of ten on 1000 px
  chart.rows = {{"a", {{1}, {10}}, ""}, {"b", {{0}}, ""}};
  const std::vector<double> at = numbers(to_svg(chart), "cx");
  REQUIRE(at.size() == 2);
  CHECK(at[0] == Approx(1000 / 3.0).margin(0.06));  // written with one decimal
  CHECK(at[1] == Approx(2000 / 3.0).margin(0.06));
  CHECK_THAT(to_svg(chart), Catch::Contains("M0.0 36.0l9") && Catch::Contains("<title>0, beyond the axis</title>"));
}

TEST_CASE("Rows without a number, and no rows at all") {
  RowChart chart;
  chart.title = "nothing <yet>";
  CHECK_THAT(to_svg(chart), Catch::Contains("nothing to show") && Catch::Contains("nothing &lt;yet&gt;"));
  chart.rows = {{"a", {{std::numeric_limits<double>::quiet_NaN()}}, "-"}};
  const std::string svg = to_svg(chart);
  CHECK(fault_of_xml(svg).empty());
  CHECK_THAT(svg, !Catch::Contains("nan") && !Catch::Contains("inf"));
}

TEST_CASE("Strips share their axis, a name without room is still found under the pointer") {
  StripChart chart;
  chart.label_px = 86;
  chart.width_px = 1100;
  chart.strips = {{"first", {{0, 5, 1, "cruise", "90 %"}, {5, 5.1, 0.1, "contact", "10 %"}}},
                  {"second", {{0, 10, 0, "stand", "0 %"}}}};
  const std::string svg = to_svg(chart);
  CHECK(fault_of_xml(svg).empty());
  CHECK_THAT(svg, Catch::Contains("width=\"500.0\"") && Catch::Contains("width=\"10.0\"") &&
                      Catch::Contains("width=\"1000.0\""));
  CHECK_THAT(svg, Catch::Contains(">cruise</text>") && !Catch::Contains(">contact</text>") &&
                      Catch::Contains("<title>contact 10 %, 5.0 to 5.1</title>"));
  CHECK_THAT(to_svg(StripChart{}), Catch::Contains("nothing to show"));

  // a span may lead somewhere
  chart.strips[0].spans[0].link = "#a&b";
  const std::string linked = to_svg(chart);
  CHECK(fault_of_xml(linked).empty());
  CHECK_THAT(linked, Catch::Contains("<a href=\"#a&amp;b\"><rect"));
  // links inside a picture would not be there for a screen reader
  CHECK_THAT(linked, Catch::Contains("role=\"group\"") && !Catch::Contains("role=\"img\""));
}

TEST_CASE("Names of strips get the room that they need, up to half of the chart, then their ends are shown") {
  StripChart chart;
  chart.strips = {{"step-200-flippers (run-001.csv)", {{0, 1, 1, "climb", ""}}}};
  CHECK_THAT(to_svg(chart), Catch::Contains(">step-200-flippers (run-001.csv)</text>"));
  chart.strips[0].label = std::string(200, 'a') + "the-end.csv";
  CHECK_THAT(to_svg(chart), Catch::Contains("athe-end.csv</text>") && !Catch::Contains(chart.strips[0].label));
  // letters of two bytes are kept whole
  for (const double width_px : {60.0, 63.0, 66.0, 69.0, 72.0}) {
    chart.strips[0].label = "\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9";
    chart.label_px = width_px;
    chart.width_px = 2 * width_px;
    CHECK(fault_of_xml(to_svg(chart)).empty());
  }
}

TEST_CASE("Discs stand at their places with their words, one without a place is left out") {
  Chart chart;
  chart.lines = {{{{0, 0}, {1, 1}}, Ink::faint, Stroke::solid, ""}};
  chart.discs = {{{0.5, 0.5}, 9, Ink::sim, false, "tip", "before", "tip 3 %", "#run-1"},
                 {{std::numeric_limits<double>::quiet_NaN(), 0}, 7, Ink::third, true, "nowhere", ""}};
  const std::string svg = to_svg(chart);
  CHECK(fault_of_xml(svg).empty());
  CHECK_THAT(svg, Catch::Contains("class=\"ring sim\"") && Catch::Contains("r=\"9.0\"") && Catch::Contains(">tip<") &&
                      Catch::Contains(">before<"));
  CHECK_THAT(svg, Catch::Contains("<a href=\"#run-1\"><circle") && Catch::Contains("<title>tip 3 %</title>"));
  CHECK_THAT(svg, !Catch::Contains("nan") && !Catch::Contains("nowhere"));
}

TEST_CASE("A dense line keeps what a picture shows of it: the extremes of every column") {
  std::vector<Point> noise;
  for (int i = 0; i <= 10000; ++i) noise.emplace_back(i, i % 2 == 0 ? 1 : -1);
  noise[5000].y() = 50;  // a single spike
  const auto few = envelope(noise, 100);
  CHECK(few.size() <= 4 * 101);
  CHECK(few.front() == noise.front());
  CHECK(few.back() == noise.back());
  CHECK(std::ranges::count(few, 50, [](const Point& p) { return p.y(); }) == 1);
  CHECK(std::ranges::is_sorted(few, {}, [](const Point& p) { return p.x(); }));
  CHECK(envelope(std::span(noise).first(50), 100).size() == 50);
  // a break stays one, and hides nothing beside it
  noise[5001].y() = std::numeric_limits<double>::quiet_NaN();
  const auto broken = envelope(noise, 100);
  CHECK(std::ranges::count_if(broken, [](const Point& p) { return std::isnan(p.y()); }) == 1);
  CHECK(std::ranges::count(broken, 50, [](const Point& p) { return p.y(); }) == 1);
}
