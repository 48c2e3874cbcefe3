// Bags of ROS 1 made record by record (wiki.ros.org/Bags/Format/2.0).
#include "gap/recordings/rosbag1_reader.hpp"

#include <catch2/catch.hpp>

#include "gap/recordings/recording_error.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf::gap::recordings;
using namespace kenaf::test;

namespace rosbag1_reader_test {

namespace {

const std::string kBegin = "#ROSBAG V2.0\n";

std::string field(const std::string& name, const std::string& value) {
  return sized(name + "=" + value);
}
std::string record(const std::string& head, const std::string& data) {
  return sized(head) + sized(data);
}
std::string bag_header(const std::string& more = "") {
  return record(field("op", "\3") + field("index_pos", u64(0)) + field("conn_count", u32(1)) +
                    field("chunk_count", u32(1)) + more,
                std::string(100, ' '));
}
std::string connection(std::uint32_t id, const std::string& topic) {
  return record(field("op", "\7") + field("conn", u32(id)) + field("topic", topic),
                field("topic", topic) + field("type", "std_msgs/Float64") + field("md5sum", "0") +
                    field("message_definition", "float64 data\n"));
}
std::string message(std::uint32_t id, std::uint32_t sec, std::uint32_t nsec, const std::string& data) {
  return record(field("op", "\2") + field("conn", u32(id)) + field("time", u32(sec) + u32(nsec)), data);
}
std::string chunk(const std::string& data, const std::string& compression = "none", std::size_t says = 0) {
  return record(field("op", "\5") + field("compression", compression) +
                    field("size", u32(static_cast<std::uint32_t>(says == 0 ? data.size() : says))),
                data);
}
// Of the chunk at byte `at`, with two messages of connection 0.
std::string info(std::uint64_t at, std::uint32_t from_s, std::uint32_t to_s) {
  return record(field("op", "\6") + field("ver", u32(1)) + field("chunk_pos", u64(at)) +
                    field("start_time", u32(from_s) + u32(0)) + field("end_time", u32(to_s) + u32(0)) +
                    field("count", u32(1)),
                u32(0) + u32(2));
}

Recording opened(const std::string& bytes) {
  return open_rosbag1(bytes_in_memory(bytes));
}

}  // namespace

TEST_CASE("A bag is read by its index, and without one by its chunks") {
  const std::string head = kBegin + bag_header();
  const std::string data = chunk(connection(0, "/a") + message(0, 10, 5, "one") + message(0, 12, 0, "two"));
  for (const bool indexed : {true, false}) {
    const std::string tail = connection(0, "/a") + info(head.size(), 10, 12);
    const Recording recording = opened(head + data + (indexed ? tail : ""));
    REQUIRE(recording.topics.size() == 1);
    CHECK(recording.topics[0].name == "/a");
    CHECK(recording.topics[0].type == "std_msgs/Float64");
    CHECK(recording.topics[0].schema == "float64 data\n");
    CHECK(recording.topics[0].count == 2);
    CHECK(recording.first_ns == (indexed ? 10000000000 : 10000000005));
    CHECK(recording.last_ns == 12000000000);
    CHECK(recording.remarks.size() == (indexed ? 0 : 1));  // one says that the index is missing
    CHECK(visited(recording).messages == std::vector<Taken>{{"/a", 10000000005, "one"}, {"/a", 12000000000, "two"}});
  }
}

TEST_CASE("A bag that is cut off anywhere is read as far as it goes") {
  const std::string first = kBegin + bag_header() + chunk(connection(0, "/a") + message(0, 10, 0, "one"));
  const std::string whole = first + chunk(message(0, 11, 0, "two"));
  for (std::size_t size = kBegin.size(); size < whole.size(); ++size) {
    const Visited all = visited(opened(whole.substr(0, size)));
    REQUIRE(all.messages.size() == (size >= first.size() ? 1 : 0));
  }
}

TEST_CASE("Damaged chunks of a bag are left out with a remark, the others are read") {
  const std::string good = chunk(connection(0, "/a") + message(0, 10, 0, "one"));
  const std::string cut = message(0, 11, 0, "two") + u32(1000) + "short";
  const std::pair<std::string, std::string> cases[] = {
      {chunk("no bz2", "bz2", 100), "bz2 data is damaged"},
      {chunk("no lz4 frame", "lz4", 2000000000), "to unpack to 2000000000 bytes"},
      {chunk("x", "rot13"), "packed by 'rot13'"},
      {chunk(cut), "is damaged; 1 messages before are read"},
      {chunk(message(7, 11, 0, "x")), "1 messages of connection 7"},
  };
  for (const auto& [bad, why] : cases) {
    const Visited all = visited(opened(kBegin + bag_header() + good + bad));
    REQUIRE(!all.messages.empty());
    INFO(why);
    REQUIRE(all.remarks.size() == 1);
    CHECK(all.remarks[0].find(why) != std::string::npos);
  }
}

TEST_CASE("Bags of another version, encrypted or with a head that is too long are refused") {
  CHECK_THROWS_WITH(opened("#ROSBAG V1.2\n"), Catch::Contains("version 1.2"));
  CHECK_THROWS_AS(opened("#ROSBAG"), RecordingError);
  CHECK_THROWS_WITH(opened(kBegin + bag_header(field("encryptor", "rosbag/AesCbcEncryptor"))),
                    Catch::Contains("encrypted"));
  CHECK_THROWS_WITH(opened(kBegin + sized(std::string(70000, 'x')) + u32(0)), Catch::Contains("too long"));
  CHECK_THROWS_AS(opened(kBegin + record("no field", "")), RecordingError);
}

}  // namespace rosbag1_reader_test
