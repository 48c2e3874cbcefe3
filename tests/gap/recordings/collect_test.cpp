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

}  // namespace collect_test
