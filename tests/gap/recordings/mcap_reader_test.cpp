// MCAP files made record by record (mcap.dev/spec): what is read of whole, cut off and hostile ones.
#include "gap/recordings/mcap_reader.hpp"

#include <zstd.h>

#include <catch2/catch.hpp>

#include "gap/recordings/recording_error.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf::gap::recordings;
using namespace kenaf::test;

namespace mcap_reader_test {
using namespace kenaf::test::made_mcap;

namespace {

const std::string kDescribed =
    schema(1, "std_msgs/msg/Float64", "ros2msg", "float64 data\n") + channel(4, 1, "/a", "cdr");

Recording opened(const std::string& bytes) {
  return open_mcap(bytes_in_memory(bytes));
}

std::string zstd_of(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

}  // namespace

TEST_CASE("Messages of an MCAP file without an index come with topic, type, time and bytes") {
  const std::string records = kDescribed + message(4, 100, "one") + message(4, 200, "two");
  for (const std::string& data :
       {records, chunk(100, 200, records), chunk(100, 200, zstd_of(records), {"zstd", records.size(), crc(records)})}) {
    const Recording recording = opened(head() + data + end());
    REQUIRE(recording.topics.size() == 1);
    CHECK(recording.topics[0].type == "std_msgs/msg/Float64");
    CHECK(recording.topics[0].schema == "float64 data\n");
    CHECK(recording.topics[0].count == 2);
    CHECK(recording.first_ns == 100);
    CHECK(recording.last_ns == 200);
    CHECK(recording.remarks.empty());
    const Visited all = visited(recording);
    CHECK(all.messages == std::vector<Taken>{{"/a", 100, "one"}, {"/a", 200, "two"}});
    CHECK(all.remarks.empty());
  }
}

TEST_CASE("Chunks that overlap in time are visited in the order of time") {
  // Chunk 1 has 100 and 300, chunk 2 has 200 and 400, and the messages within chunk 2 are not in order.
  const std::string first = kDescribed + message(4, 100, "a") + message(4, 300, "c");
  const std::string second = message(4, 400, "d") + message(4, 200, "b");
  const Visited all = visited(opened(head() + chunk(100, 300, first) + chunk(200, 400, second) + end()));
  CHECK(all.messages == std::vector<Taken>{{"/a", 100, "a"}, {"/a", 200, "b"}, {"/a", 300, "c"}, {"/a", 400, "d"}});
}

TEST_CASE("A chunk without messages, which has the times 0, does not count for the begin of the recording") {
  const Recording recording =
      opened(head() + chunk(0, 0, kDescribed) + chunk(100, 200, message(4, 100, "a") + message(4, 200, "b")) + end());
  CHECK(recording.first_ns == 100);
  CHECK(recording.last_ns == 200);
  CHECK(visited(recording).messages.size() == 2);
}

TEST_CASE("An MCAP file that is cut off anywhere is read as far as it goes") {
  const std::string records = kDescribed + message(4, 100, "one");
  const std::string whole = head() + chunk(100, 100, records) + chunk(200, 200, message(4, 200, "two")) + end();
  const std::size_t first_end = (head() + chunk(100, 100, records)).size();
  const std::size_t second_end = first_end + chunk(200, 200, message(4, 200, "two")).size();
  for (std::size_t size = kMagic.size(); size < second_end; ++size) {
    const Recording recording = opened(whole.substr(0, size));
    const std::size_t expected = size >= first_end ? 1 : 0;
    REQUIRE(visited(recording).messages.size() == expected);
    REQUIRE(recording.remarks.size() == 1);
    REQUIRE(recording.remarks[0].starts_with("the file is cut off within the record at byte"));
  }
}

TEST_CASE("A chunk whose checksum is wrong is left out and named, the others are read") {
  const std::string bad = message(4, 100, "bad");
  const std::string file = head() + kDescribed + chunk(100, 100, bad, {"", bad.size(), crc(bad) + 1}) +
                           chunk(200, 200, message(4, 200, "good")) + end();
  const Visited all = visited(opened(file));
  CHECK(all.messages == std::vector<Taken>{{"/a", 200, "good"}});
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].find("its checksum is wrong") != std::string::npos);
}

TEST_CASE("Chunks that say more than they hold are left out before anything of that size is allocated") {
  const std::string records = message(4, 100, "a");
  const std::string packed = zstd_of(records);
  constexpr std::uint64_t kExabyte = std::uint64_t{1} << 60;
  const std::pair<std::string, std::string> cases[] = {
      {chunk(100, 100, packed, {"zstd", kExabyte, 0}), "more than"},
      {chunk(100, 100, packed, {"zstd", records.size() + 1, 0}), "instead of"},
      {chunk(100, 100, packed, {"zstd", records.size() - 1, 0}), "unpacks to more than"},
      {chunk(100, 100, packed.substr(0, packed.size() - 1), {"zstd", records.size(), 0}), "ends too early"},
      {chunk(100, 100, packed, {"lz4", records.size(), 0}), "lz4 data is damaged"},
      {chunk(100, 100, packed, {"snappy", records.size(), 0}), "packed by 'snappy', which is unknown"},
  };
  for (const auto& [data, why] : cases) {
    const Visited all = visited(opened(head() + kDescribed + data + end()));
    CHECK(all.messages.empty());
    REQUIRE(all.remarks.size() == 1);
    INFO(all.remarks[0]);
    CHECK(all.remarks[0].find(why) != std::string::npos);
  }
}

TEST_CASE("A record in a chunk that goes beyond it ends the chunk, with a remark") {
  const std::string records = message(4, 100, "whole") + '\x05' + u64(1000) + "short";
  const Visited all = visited(opened(head() + kDescribed + chunk(100, 100, records) + end()));
  CHECK(all.messages == std::vector<Taken>{{"/a", 100, "whole"}});
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].find("its last 14 bytes") != std::string::npos);  // 9 of the head and "short"
}

TEST_CASE("Messages of a channel that nothing describes are counted") {
  const std::string records = kDescribed + message(9, 100, "x") + message(9, 101, "y") + message(4, 102, "z");
  const Visited all = visited(opened(head() + chunk(100, 102, records) + end()));
  CHECK(all.messages == std::vector<Taken>{{"/a", 102, "z"}});
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].starts_with("2 messages of channel 9"));
}

TEST_CASE("Attachments are named, other records pass") {
  const std::string attachment = record(9, u64(0) + u64(0) + sized("map.yaml") + sized("") + u64(0) + u32(0));
  const Recording recording =
      opened(head() + attachment + record('\x80', "private") + kDescribed + message(4, 1, "a") + end());
  CHECK(recording.remarks == std::vector<std::string>{"1 attachments are not read"});
  CHECK(visited(recording).messages.size() == 1);
}

TEST_CASE("What is no MCAP file is refused, and a chunk longer than its record") {
  CHECK_THROWS_AS(opened(""), RecordingError);
  CHECK_THROWS_AS(opened("\x89MCAP1\r\n"s), RecordingError);
  const std::string lying = record(6, u64(0) + u64(0) + u64(5) + u32(0) + sized("") + u64(1 << 30) + "hello");
  CHECK_THROWS_WITH(opened(head() + lying + end()), Catch::Contains("longer than its record"));
}

TEST_CASE("An MCAP file is read through a source that gives no more than a chunk at once") {
  // 64 chunks of 128 kB; no read is larger than a chunk and its head.
  std::string file = head() + kDescribed;
  for (std::uint64_t i = 0; i < 64; ++i) {
    std::string records;
    for (std::uint64_t k = 0; k < 32; ++k) records += message(4, 1000 * i + k, std::string(4096, 'x'));
    file += chunk(1000 * i, 1000 * i + 31, records);
  }
  ByteSource source = bytes_in_memory(file + end());
  std::size_t largest = 0;
  source.read = [&largest, read = source.read](std::uint64_t offset, std::span<char> into) {
    largest = std::max(largest, into.size());
    read(offset, into);
  };
  std::uint64_t count = 0;
  open_mcap(source).visit([&count](const Message&) { return ++count > 0; }, {});
  CHECK(count == 64 * 32);
  CHECK(largest < 140000);
}

}  // namespace mcap_reader_test
