// Files that other projects' writers made (fixtures/make-mcap.mjs, fixtures/make-bag.py, which have the values).
#include <catch2/catch.hpp>
#include <map>

#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/recording.hpp"

using namespace kenaf::gap::recordings;

namespace {

const std::filesystem::path kFixtures = KENAF_SOURCE_DIR "/tests/gap/recordings/fixtures";

struct Series {
  std::vector<double> values;
  std::vector<std::int64_t> log_ns, stamp_ns;
};

// The numbers at a path of a topic, message by message.
Series series(const Recording& recording, const std::string& topic, const std::string& path) {
  Series found;
  const FieldPath steps = parse_field_path(path);
  std::map<std::size_t, MessageReader> readers;
  for (std::size_t i = 0; i < recording.topics.size(); ++i) readers.emplace(i, MessageReader(recording.topics[i], {}));
  const auto remarks = recording.visit(
      [&](const Message& message) {
        if (recording.topics[message.topic].name != topic) return true;
        const MessageReader& reader = readers.at(message.topic);
        REQUIRE(reader.wrong_with(steps).empty());
        const auto field = reader.find(message.bytes, steps);
        REQUIRE(field);
        found.values.push_back(field->value);
        found.log_ns.push_back(message.log_ns);
        found.stamp_ns.push_back(field->stamp_ns.value_or(-1));
        return true;
      },
      {});
  CHECK(remarks.empty());
  return found;
}

}  // namespace

TEST_CASE("MCAP files of @mcap/core with CDR of rosmsg2-serialization are read, however they are packed") {
  for (const char* file : {"foreign-plain.mcap", "foreign-bare.mcap", "foreign-zstd.mcap", "foreign-lz4.mcap"}) {
    INFO(file);
    const Recording recording = open_recording(kFixtures / file);
    CHECK(recording.form == "MCAP");
    for (const std::string& remark : recording.remarks) FAIL_CHECK(remark);
    REQUIRE(recording.topics.size() == 6);
    for (const Topic& topic : recording.topics) CHECK(topic.count == 20);
    CHECK(recording.first_ns == 1700000000002000000);
    CHECK(recording.last_ns == 1700000001902000000);

    const Series speed = series(recording, "/cmd_vel", "linear.x");
    REQUIRE(speed.values.size() == 20);
    CHECK(speed.values[7] == Approx(0.7).epsilon(1e-15));
    CHECK(speed.log_ns[7] == 1700000000702000000);
    CHECK(speed.stamp_ns[7] == -1);  // a Twist has no header

    const Series right = series(recording, "/joint_states", "velocity[right_track]");
    CHECK(right.values[3] == -13);
    CHECK(right.stamp_ns[3] == 1700000000300000000);
    CHECK(series(recording, "/imu/data", "angular_velocity.z").values[19] == Approx(0.57).epsilon(1e-15));
    CHECK(series(recording, "/imu/data", "linear_acceleration.z").values[0] == 9.81);
    CHECK(series(recording, "/odom", "twist.twist.angular.z").values[0] == 0.1);
    CHECK(series(recording, "/odom", "pose.pose.position.y").values[4] == -4);
    CHECK(series(recording, "/tf", "transforms[base_link].transform.translation.y").values[6] == 12);
    CHECK(series(recording, "/battery", "voltage").values[0] == 25.5);
    CHECK(series(recording, "/battery", "cell_voltage[1]").values[0] == 4.25);
  }
}

TEST_CASE("Bags of Debian's python3-rosbag are read, however they are packed") {
  for (const char* file : {"foreign-none.bag", "foreign-bz2.bag", "foreign-lz4.bag"}) {
    INFO(file);
    const Recording recording = open_recording(kFixtures / file);
    CHECK(recording.form == "rosbag 1");
    for (const std::string& remark : recording.remarks) FAIL_CHECK(remark);
    REQUIRE(recording.topics.size() == 3);
    for (const Topic& topic : recording.topics) CHECK(topic.count == 20);
    CHECK(recording.first_ns == 1600000000003000000);

    const Series speed = series(recording, "/cmd_vel", "twist.linear.x");
    REQUIRE(speed.values.size() == 20);
    CHECK(speed.values[5] == 0.5);
    CHECK(speed.log_ns[5] == 1600000000253000000);
    CHECK(speed.stamp_ns[5] == 1600000000250000000);
    CHECK(series(recording, "/joint_states", "velocity[left_wheel]").values[4] == 5);
    CHECK(series(recording, "/tf", "transforms[base_link].transform.translation.x").values[9] == 9);
  }
}
