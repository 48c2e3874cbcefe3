#include "gap/recordings/sqlite_bag.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <map>
#include <memory>
#include <utility>

#include "gap/recordings/decompress.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::uint64_t kTellEach = 1024;  // messages between two words on the progress

using Database = std::shared_ptr<sqlite3>;

[[noreturn]] void fail_in(sqlite3* database) {
  throw RecordingError(fmt::format("SQLite cannot read it: {}", sqlite3_errmsg(database)));
}

class Query {
 public:
  Query(const Database& database, const std::string& sql) : database_(database) {
    if (sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) fail_in(database.get());
  }
  ~Query() { sqlite3_finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  bool next() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail_in(database_.get());
    return result == SQLITE_ROW;
  }
  std::int64_t number(int column) { return sqlite3_column_int64(statement_, column); }
  std::string_view bytes(int column) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    return {data, data == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
  }

 private:
  Database database_;
  sqlite3_stmt* statement_ = nullptr;
};

// Switches off the features that a hostile file could use against its reader (sqlite.org/security.html).
Database guarded(sqlite3* made, int result) {
  Database database(made, &sqlite3_close_v2);
  if (result != SQLITE_OK) fail_in(made);
  sqlite3_db_config(made, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(made, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestBlock));
  sqlite3_exec(made, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0", nullptr, nullptr, nullptr);
  return database;
}

// A table whose rows are stored, and no view or module whose rows would be computed.
bool has_table(const Database& database, const std::string& name) {
  Query query(database, "SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = '" + name + "'");
  if (!query.next()) return false;
  const std::string_view sql = query.bytes(0);
  return sql.starts_with("CREATE TABLE");
}

std::map<std::string, Topic> definitions_of(const Database& database) {
  std::map<std::string, Topic> by_type;
  if (!has_table(database, "message_definitions")) return by_type;
  Query query(database, "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (query.next()) {
    Topic topic;
    topic.schema_encoding = query.bytes(1);
    topic.schema = query.bytes(2);
    if (!topic.schema.empty()) by_type[std::string(query.bytes(0))] = std::move(topic);
  }
  return by_type;
}

// The topics in the file, and the place of each by its number there.
std::map<std::int64_t, std::size_t> read_topics(const Database& database, std::vector<Topic>& topics) {
  std::map<std::int64_t, std::size_t> topic_of;
  const std::map<std::string, Topic> definitions = definitions_of(database);
  Query query(database, "SELECT id, name, type, serialization_format FROM topics");
  while (query.next()) {
    Topic topic{std::string(query.bytes(1)), std::string(query.bytes(2)), std::string(query.bytes(3)), "", "", 0};
    if (const auto definition = definitions.find(topic.type); definition != definitions.end()) {
      topic.schema_encoding = definition->second.schema_encoding;
      topic.schema = definition->second.schema;
    }
    topic_of[query.number(0)] = topic_index(topics, topic);
  }
  return topic_of;
}

// Counts the messages and finds the first and last time, as far as the file can be read.
std::uint64_t count_messages(const Database& database, const std::map<std::int64_t, std::size_t>& topic_of,
                             Recording& recording) {
  std::uint64_t all = 0;
  Query query(database, "SELECT topic_id, timestamp FROM messages");
  try {
    for (; query.next(); ++all) {
      if (const auto topic = topic_of.find(query.number(0)); topic != topic_of.end())
        ++recording.topics[topic->second].count;
      widen_times(recording, query.number(1), query.number(1));
    }
  } catch (const RecordingError&) {
    // The visit says how far it got.
  }
  return all;
}

// One visit of all messages.
class SqliteVisit {
 public:
  SqliteVisit(Database database, const std::map<std::int64_t, std::size_t>& topic_of, std::uint64_t all)
      : database_(std::move(database)), topic_of_(topic_of), all_(all) {}

  std::vector<std::string> run(const TakeMessage& take, const TellProgress& tell) {
    Query query(database_, "SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp");
    for (std::uint64_t i = 0; next(query, i); ++i) {
      if (tell && i % kTellEach == 0 && all_ > 0) tell(static_cast<double>(i) / static_cast<double>(all_));
      const auto topic = topic_of_.find(query.number(0));
      if (topic == topic_of_.end())
        ++unknown_;
      else if (!take_one(topic->second, query.number(1), query.bytes(2), take))
        break;
    }
    std::vector<std::string> remarks = std::move(remarks_);
    if (unknown_ > 0) remarks.push_back(fmt::format("{} messages of no topic of the file are left out", unknown_));
    if (damaged_ > 0)
      remarks.push_back(fmt::format("{} messages cannot be unpacked and are left out: {}", damaged_, why_));
    return remarks;
  }

 private:
  // Ends at what is damaged, with a remark.
  bool next(Query& query, std::uint64_t messages_before) {
    try {
      return query.next();
    } catch (const RecordingError& error) {
      remarks_.push_back(fmt::format("{} messages are read, then: {}", messages_before, error.what()));
      return false;
    }
  }

  bool take_one(std::size_t topic, std::int64_t log_ns, std::string_view bytes, const TakeMessage& take) {
    if (!begins_as_zstd(bytes)) return take({topic, log_ns, bytes});
    std::string unpacked;
    try {
      unpacked = decompressed(Compression::zstd, bytes);
    } catch (const RecordingError& error) {
      if (damaged_++ == 0) why_ = error.what();
      return true;
    }
    return take({topic, log_ns, unpacked});
  }

  Database database_;
  const std::map<std::int64_t, std::size_t>& topic_of_;
  std::uint64_t all_, unknown_ = 0, damaged_ = 0;
  std::string why_;
  std::vector<std::string> remarks_;
};

Recording recording_in(const Database& database) {
  for (const char* table : {"topics", "messages"})
    if (!has_table(database, table))
      throw RecordingError(fmt::format("an SQLite file without the table '{}' of rosbag2", table));
  Recording recording;
  recording.form = "rosbag2 (SQLite)";
  const auto topic_of =
      std::make_shared<const std::map<std::int64_t, std::size_t>>(read_topics(database, recording.topics));
  const std::uint64_t all = count_messages(database, *topic_of, recording);
  recording.visit = [database, topic_of, all](const TakeMessage& take, const TellProgress& tell) {
    return SqliteVisit(database, *topic_of, all).run(take, tell);
  };
  return recording;
}

// The file's name as SQLite's address of a file; `immutable` also reads one whose folder cannot be written.
std::string address(const std::filesystem::path& file, const char* how) {
  std::string text = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    text +=
        c == '%' || c == '?' || c == '#' ? fmt::format("%{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  return text + how;
}

Database open_file(const std::filesystem::path& file, const char* how) {
  sqlite3* made = nullptr;
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE;
  const int result = sqlite3_open_v2(address(file, how).c_str(), &made, flags, nullptr);
  return guarded(made, result);
}

}  // namespace

bool begins_as_sqlite(std::string_view bytes) {
  return bytes.starts_with(kSqliteMagic);
}

Recording open_sqlite_bag(const std::filesystem::path& file) {
  // A recorder that was killed leaves a log beside the file, which must be read with it: so not immutable at first.
  const Database database = open_file(file, "?mode=ro");
  const bool readable =
      sqlite3_exec(database.get(), "SELECT 1 FROM sqlite_schema", nullptr, nullptr, nullptr) == SQLITE_OK;
  return recording_in(readable ? database : open_file(file, "?mode=ro&immutable=1"));
}

Recording open_sqlite_bag_in_memory(std::string bytes) {
  sqlite3* made = nullptr;
  const int result = sqlite3_open_v2(":memory:", &made, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  const Database database = guarded(made, result);
  // SQLite frees the copy.
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(bytes.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, bytes.data(), bytes.size());
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(database.get(), "main", copy, size, size,
                          SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    fail_in(database.get());
  return recording_in(database);
}

}  // namespace kenaf::gap::recordings
