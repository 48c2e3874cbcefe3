// The table of a run's columns, and the page that shows it.
#include "robot/columns.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "robot/parts.hpp"

using namespace kenaf;
using robot::Column;
using robot::Quantity;

namespace {

struct Row {
  std::string name, unit;
};

// The rows of the page's table of columns, one for each name in their first cell.
std::vector<Row> rows_of_page() {
  std::ifstream page(KENAF_SOURCE_DIR "/docs/logs.md");
  const std::regex name("`([a-z0-9_]+)`"), cells(R"(\| (`[^|]*) \| ([^|]*) \|.*)");
  std::vector<Row> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) inside = line == "### Columns";
    std::smatch match;
    if (!inside || !std::regex_match(line, match, cells)) continue;
    const std::string names = match[1], unit = match[2];
    for (std::sregex_iterator each(names.begin(), names.end(), name), end; each != end; ++each)
      rows.push_back({(*each)[1], unit});
  }
  return rows;
}

}  // namespace

TEST_CASE("Names are there once and end with their unit") {
  const std::map<std::string_view, std::string_view> ending{{"s", "_s"},        {"m", "_m"},     {"m/s", "_mps"},
                                                            {"m/s^2", "_mps2"}, {"rad", "_rad"}, {"rad/s", "_radps"},
                                                            {"A", "_a"},        {"V", "_v"},     {"1", ""}};
  std::set<std::string_view> names;
  for (const Column& column : robot::columns()) {
    CAPTURE(column.name);
    CHECK(names.insert(column.name).second);
    REQUIRE(ending.contains(column.unit));
    CHECK(column.name.ends_with(ending.at(column.unit)));
    CHECK((column.by_robot || column.by_simulator));
    if (column.wraps) CHECK(column.unit == "rad");
  }
}

TEST_CASE("Columns of a quantity stand side by side, in the order of tracks, flippers and axes") {
  const auto names = [](Quantity quantity) {
    std::vector<std::string_view> result;
    for (const Column& column : robot::columns_of(quantity)) result.push_back(column.name);
    return result;
  };
  std::size_t count = 0;
  for (auto quantity = Quantity::time; quantity <= Quantity::late_commands;
       quantity = static_cast<Quantity>(static_cast<int>(quantity) + 1))
    count += robot::columns_of(quantity).size();
  CHECK(count == robot::columns().size());
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    CHECK(names(Quantity::track_travel).at(i) == "track_" + std::string(robot::kTrackNames[i]) + "_m");
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    CHECK(names(Quantity::flipper_current).at(i) == "flipper_" + std::string(robot::kFlipperNames[i]) + "_a");
  CHECK(names(Quantity::turn_rate) == std::vector<std::string_view>{"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"});
}

TEST_CASE("Columns of one kind are seen at one place, in one unit, with one resolution") {
  std::map<std::string_view, const Column*> first;
  for (const Column& column : robot::columns()) {
    if (!column.is_compared()) continue;
    const auto [of_kind, is_new] = first.emplace(column.comparison.kind, &column);
    CAPTURE(column.name);
    CHECK_FALSE(column.comparison.kind.empty());
    CHECK(column.unit == of_kind->second->unit);
    CHECK(column.comparison.seen == of_kind->second->comparison.seen);
    CHECK(column.comparison.resolution == of_kind->second->comparison.resolution);
  }
}

TEST_CASE("The page has every column that robot and simulator record, in their order and with their units") {
  const std::vector<Row> rows = rows_of_page();
  std::size_t next = 0;
  for (const Column& column : robot::columns()) {
    if (!column.by_robot || !column.by_simulator) continue;
    REQUIRE(next < rows.size());
    CHECK(rows[next].name == column.name);
    CHECK(rows[next].unit == (column.unit == "m/s^2" ? "m/s²" : column.unit));
    ++next;
  }
  CHECK(next == rows.size());
}
