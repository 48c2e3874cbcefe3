// SQLite files as rosbag2 makes them, and such as it never makes.
#include "gap/recordings/sqlite_bag.hpp"

#include <sqlite3.h>
#include <zstd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "gap/recordings/recording_error.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf::gap::recordings;
using namespace kenaf::test;

namespace {

// The tables of rosbag2_storage_sqlite3, schema version 3.
const std::string kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT "
    "NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
const std::string kRows =
    "INSERT INTO topics VALUES(1,'/speed','std_msgs/msg/Float64','cdr','');"
    "INSERT INTO messages VALUES(1,1,2000,x'02');INSERT INTO messages VALUES(2,1,1000,x'01');"
    "INSERT INTO messages VALUES(3,9,1500,x'09');";

void make(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &database) == SQLITE_OK);
  char* error = nullptr;
  const int result = sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &error);
  INFO((error == nullptr ? "" : error));
  REQUIRE(result == SQLITE_OK);
  sqlite3_close(database);
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes)
    text += "0123456789abcdef"[static_cast<unsigned char>(c) >> 4],
        text += "0123456789abcdef"[static_cast<unsigned char>(c) & 15];
  return text;
}

}  // namespace

TEST_CASE("Messages of an SQLite bag come in the order of time, those without a topic are counted") {
  const TemporaryFolder folder;
  make(folder / "bag with ?.db3", kTables + kRows);
  const Recording recording = open_recording(folder / "bag with ?.db3");
  CHECK(recording.form == "rosbag2 (SQLite)");
  REQUIRE(recording.topics.size() == 1);
  CHECK(recording.topics[0].count == 2);
  CHECK(recording.first_ns == 1000);
  CHECK(recording.last_ns == 2000);
  const Visited all = visited(recording);
  CHECK(all.messages == std::vector<Taken>{{"/speed", 1000, "\1"}, {"/speed", 2000, "\2"}});
  CHECK(all.remarks == std::vector<std::string>{"1 messages of no topic of the file are left out"});
}

TEST_CASE("Definitions that the recorder wrote are used") {
  const TemporaryFolder folder;
  make(folder / "a.db3",
       kTables + kRows +
           "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,encoding TEXT NOT NULL,"
           "encoded_message_definition TEXT NOT NULL,type_description_hash TEXT NOT NULL);"
           "INSERT INTO message_definitions VALUES(1,'std_msgs/msg/Float64','ros2msg','float64 data','');");
  const Recording recording = open_recording(folder / "a.db3");
  CHECK(recording.topics[0].schema == "float64 data");
  CHECK(recording.topics[0].schema_encoding == "ros2msg");
}

TEST_CASE("Messages and files that are packed by zstd are unpacked") {
  const TemporaryFolder folder;
  const std::string message = "\0\1\0\0"s + f64(2.5);
  std::string packed(ZSTD_compressBound(message.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), message.data(), message.size(), 3));
  make(folder / "a.db3", kTables + "INSERT INTO topics VALUES(1,'/a','std_msgs/msg/Float64','cdr','');" +
                             "INSERT INTO messages VALUES(1,1,1000,x'" + hex(packed) + "');" +
                             "INSERT INTO messages VALUES(2,1,2000,x'" + hex(packed.substr(0, packed.size() - 2)) +
                             "');");
  const Visited all = visited(open_recording(folder / "a.db3"));
  CHECK(all.messages == std::vector<Taken>{{"/a", 1000, message}});
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].starts_with("1 messages cannot be unpacked"));

  const std::string file = read_file(folder / "a.db3");
  std::string whole(ZSTD_compressBound(file.size()), '\0');
  whole.resize(ZSTD_compress(whole.data(), whole.size(), file.data(), file.size(), 3));
  write_file(folder / "a.db3.zstd", whole);
  CHECK(visited(open_recording(folder / "a.db3.zstd")).messages == all.messages);
  write_file(folder / "cut.db3.zstd", whole.substr(0, whole.size() / 2));
  CHECK_THROWS_AS(open_recording(folder / "cut.db3.zstd"), RecordingError);
}

TEST_CASE("A folder of rosbag2 is read piece by piece in the order of their numbers") {
  const TemporaryFolder folder;
  const std::string topic = "INSERT INTO topics VALUES(1,'/a','std_msgs/msg/Float64','cdr','');";
  const std::string other = "INSERT INTO topics VALUES(1,'/b','std_msgs/msg/Float64','cdr','');";
  make(folder / "drive_10.db3", kTables + topic + "INSERT INTO messages VALUES(1,1,3000,x'03');");
  make(folder / "drive_2.db3", kTables + other + "INSERT INTO messages VALUES(1,1,2000,x'02');");
  make(folder / "drive_1.db3", kTables + topic + "INSERT INTO messages VALUES(1,1,1000,x'01');");
  write_file(folder / "metadata.yaml", "rosbag2_bagfile_information:\n");
  const Recording recording = open_recording(folder.path());
  CHECK(recording.topics.size() == 2);
  CHECK(visited(recording).messages == std::vector<Taken>{{"/a", 1000, "\1"}, {"/b", 2000, "\2"}, {"/a", 3000, "\3"}});
}

TEST_CASE("An SQLite bag with a damaged page is read up to there, with a remark") {
  const TemporaryFolder folder;
  // 40 messages of 3000 bytes on pages of their own, in the order of time
  std::string rows = "INSERT INTO topics VALUES(1,'/a','std_msgs/msg/Float64','cdr','');";
  for (int i = 0; i < 40; ++i)
    rows += "INSERT INTO messages VALUES(" + std::to_string(i) + ",1," + std::to_string(1000 + i) + ",zeroblob(3000));";
  make(folder / "a.db3", kTables + rows);
  std::string bytes = read_file(folder / "a.db3");
  REQUIRE(bytes.size() > 30 * 4096);
  const std::size_t page = 30;  // by its number one that holds messages of the second half
  bytes.replace(page * 4096, 4096, std::string(4096, '\xFF'));
  const Visited all = visited(open_sqlite_bag_in_memory(bytes));
  CHECK(all.messages.size() > 5);
  CHECK(all.messages.size() < 40);
  REQUIRE(all.remarks.size() == 1);
  CHECK(all.remarks[0].find("messages are read, then: SQLite cannot read it") != std::string::npos);
}

TEST_CASE("An SQLite file that computes its rows, or is none of rosbag2, is refused") {
  const TemporaryFolder folder;
  make(folder / "view.db3",
       kTables +
           "ALTER TABLE messages RENAME TO m;CREATE VIEW messages AS WITH RECURSIVE c(i) AS "
           "(SELECT 1 UNION ALL SELECT i+1 FROM c) SELECT i id,1 topic_id,i timestamp,x'00' data FROM c;");
  CHECK_THROWS_WITH(open_recording(folder / "view.db3"), Catch::Contains("without the table 'messages'"));
  make(folder / "other.db3", "CREATE TABLE a(b);");
  CHECK_THROWS_WITH(open_recording(folder / "other.db3"), Catch::Contains("without the table 'topics'"));
  const std::string good = [&] {
    make(folder / "good.db3", kTables + kRows);
    return read_file(folder / "good.db3");
  }();
  for (std::size_t size = 16; size < good.size(); size += 509) {
    try {
      visited(open_sqlite_bag_in_memory(good.substr(0, size)));
    } catch (const RecordingError& error) {
      CHECK(std::string(error.what()).size() > 10);
    }
  }
}
