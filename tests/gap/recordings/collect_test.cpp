// Samples of a recording: which time they have, which part of it counts, what was not understood.
#include <catch2/catch.hpp>

#include "gap/recordings/mcap_reader.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/samples.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf::gap::recordings;

namespace collect_test {
namespace {

using namespace kenaf::test;
using namespace kenaf::test::made_mcap;

constexpr std::uint64_t kSecond = 1000000000;

// A speed with a header; `sec` is its stamp.
std::string stamped(std::uint32_t sec, double speed) {
  return "\0\1\0\0"s + u32(sec) + u32(0) + u32(1) + "\0ppp"s + f64(speed);  // 0, 4, 8, 12 with padding to 16
}

// Recorded at 100, 101, 102 and 103 s; stamps 50 s earlier, the third is not set, the fourth message is cut off.
Recording made() {
  const std::string records = schema(1, "pkg/msg/Speed", "ros2msg", "std_msgs/Header header\nfloat64 speed\n") +
                              schema(2, "pkg/msg/Odd", "ros2idl", "module pkg {};") + channel(1, 1, "/speed", "cdr") +
                              channel(2, 2, "/odd", "cdr") + message(1, 100 * kSecond, stamped(50, 1)) +
                              message(1, 101 * kSecond, stamped(51, 2)) + message(1, 102 * kSecond, stamped(0, 3)) +
                              message(1, 103 * kSecond, stamped(53, 4).substr(0, 20)) + message(2, 103 * kSecond, "x");
  return open_mcap(bytes_in_memory(head() + chunk(100 * kSecond, 103 * kSecond, records) + end()));
}

Collected collected(const std::vector<Source>& sources, const CollectOptions& options = {}) {
  return collect(made(), sources, options, {});
}

}  // namespace

TEST_CASE("A sample has the time of its stamp, or of its recording where nobody set the stamp") {
  const Source by_header{"/speed/speed", TimeFrom::header}, by_log{"/speed/speed", TimeFrom::log};
  const Collected all = collected({by_header, by_log});
  CHECK(all.samples.at(by_header).t_s == std::vector<double>{-50, -49, 2});
  CHECK(all.samples.at(by_header).value == std::vector<double>{1, 2, 3});
  CHECK(all.samples.at(by_log).t_s == std::vector<double>{0, 1, 2});
}

TEST_CASE("What was not understood is counted with its first reason, what was not used with type and count") {
  const Collected all = collected({{"/speed/speed", TimeFrom::log}});
  REQUIRE(all.not_understood.size() == 1);
  CHECK(all.not_understood[0].count == 1);
  CHECK(all.not_understood[0].first_reason.find("beyond its end") != std::string::npos);
  REQUIRE(all.unused.size() == 1);
  CHECK(all.unused[0].name == "/odd");
  CHECK(all.unused[0].type == "pkg/msg/Odd");
  CHECK(all.unused[0].count == 1);
  CHECK(all.used[0].count == 4);
}

TEST_CASE("A part of a recording is taken by its log time") {
  const Source source{"/speed/speed", TimeFrom::log};
  const Collected part = collected({source}, {{}, 0.5, 1.5});
  CHECK(part.samples.at(source).value == std::vector<double>{2});
  CHECK(part.used[0].count == 1);
}

TEST_CASE("Sources that the recording cannot have are refused with what it has") {
  CHECK_THROWS_WITH(collected({{"/sped/speed", TimeFrom::log}}),
                    Catch::Contains("no such topic") && Catch::Contains("/speed"));
  CHECK_THROWS_WITH(collected({{"/speed/velocity", TimeFrom::log}}), Catch::Contains("has no field 'velocity'"));
  CHECK_THROWS_WITH(collected({{"/odd/x", TimeFrom::log}}), Catch::Contains("IDL"));
  CHECK_THROWS_WITH(collected({{"/speed/a[", TimeFrom::log}}), Catch::Contains("no path"));
}

TEST_CASE("Rows of a table have times since its first, and out of order they are sorted") {
  Table table;
  table.columns = {"t", "a"};
  table.values = {{3000, 1000, 2000, 2000}, {3, 1, 2, 4}};
  const Source source{"a", TimeFrom::header};
  const Collected all = collect(table, std::vector{source}, "t", 1e-3, CollectOptions{});
  CHECK(all.samples.at(source).t_s == std::vector<double>{-2, -1, 0});
  CHECK(all.samples.at(source).value == std::vector<double>{1, 4, 3});  // of two at one time the last
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].find("1 values have the time of another") != std::string::npos);
  CHECK_THROWS_WITH(collect(table, std::vector{source}, "time", 1, CollectOptions{}),
                    Catch::Contains("no such column"));
}

TEST_CASE("Two drives in one table are refused with the row at which the clock goes back, unless one is taken") {
  // 0 to 3 s and again 0 to 1 s, ten rows a second: the second drive begins in row 32
  Table table;
  table.columns = {"t", "a"};
  table.values.resize(2);
  for (const int last : {30, 10})
    for (int i = 0; i <= last; ++i) table.values[0].push_back(0.1 * i), table.values[1].push_back(last);
  const Source source{"a", TimeFrom::header};
  CHECK_THROWS_WITH(
      collect(table, std::vector{source}, "t", 1, CollectOptions{}),
      Catch::StartsWith("t goes back from 3.000 to 0.000 s in row 32 of the table") && Catch::Contains("--from"));
  const Collected first = collect(table, std::vector{source}, "t", 1, {{}, 1.05, 3});
  CHECK(first.samples.at(source).value == std::vector<double>(20, 30));
}

TEST_CASE("Rows of a table that are a little out of order are sorted, with a remark") {
  Table table;
  table.columns = {"t", "a"};
  table.values = {{0, 0.25, 0.125, 0.375}, {1, 3, 2, 4}};
  const Source source{"a", TimeFrom::header};
  const Collected all = collect(table, std::vector{source}, "t", 1, CollectOptions{});
  CHECK(all.samples.at(source).value == std::vector<double>{1, 2, 3, 4});
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0] == "a: 1 values come before the one before them, by up to 0.125 s, and are sorted");
}

TEST_CASE("Stamps of a topic that go back far are refused, with the time of recording as a way out") {
  std::string records =
      schema(1, "pkg/msg/Speed", "ros2msg", "std_msgs/Header header\nfloat64 speed\n") + channel(1, 1, "/speed", "cdr");
  std::uint64_t now = 100;
  for (const std::uint32_t sec : {50, 51, 52, 53, 54, 40, 41, 42})
    records += message(1, now++ * kSecond, stamped(sec, 1));
  const Recording recording = open_mcap(bytes_in_memory(head() + chunk(100 * kSecond, 107 * kSecond, records) + end()));
  const Source by_header{"/speed/speed", TimeFrom::header}, by_log{"/speed/speed", TimeFrom::log};
  CHECK_THROWS_WITH(collect(recording, std::vector{by_header}, CollectOptions{}, {}),
                    Catch::StartsWith("/speed/speed: its time goes back from -46.000 to -60.000 s") &&
                        Catch::Contains("time = \"log\""));
  CHECK(collect(recording, std::vector{by_log}, CollectOptions{}, {}).samples.at(by_log).t_s.size() == 8);
}

}  // namespace collect_test
