#include "gap/recordings/rosbag1_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "gap/recordings/byte_cursor.hpp"
#include "gap/recordings/decompress.hpp"
#include "gap/recordings/time_order.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::string_view kBagBegin = "#ROSBAG V", kBagMagic = "#ROSBAG V2.0\n";

// The operations of records.
enum BagOp : std::uint8_t {
  message_data = 0x02,
  bag_header = 0x03,
  index_data = 0x04,
  chunk_record = 0x05,
  chunk_info = 0x06,
  connection_record = 0x07,
};

// Limits of memory, chosen.
constexpr std::size_t kMostBagChunks = 1 << 20;
constexpr std::uint64_t kLongestHead = 1 << 16;        // of a record
constexpr std::uint64_t kLongestConnection = 1 << 24;  // its message's definition is in it

// The fields of a record's head, or of a connection: "name=value" each after its length. Refers to the bytes.
class BagFields {
 public:
  explicit BagFields(std::string_view bytes) {
    for (ByteCursor cursor(bytes); cursor.left() > 0;) {
      const std::string_view field = cursor.text();
      const std::size_t equals = field.find('=');
      if (equals == field.npos) throw RecordingError("a field without '='");
      if (fields_.size() == kMostFields) throw RecordingError("a record with too many fields");
      fields_.push_back({field.substr(0, equals), field.substr(equals + 1)});
    }
  }
  std::string text(std::string_view name) const {
    const auto field = std::ranges::find(fields_, name, &Field::name);
    return field == fields_.end() ? std::string() : std::string(field->value);
  }
  template <class Number>
  Number number(std::string_view name) const {
    const auto field = std::ranges::find(fields_, name, &Field::name);
    if (field == fields_.end()) throw RecordingError(fmt::format("a record without its field '{}'", name));
    return ByteCursor(field->value).number<Number>();
  }
  std::int64_t time_ns(std::string_view name) const {  // seconds and nanoseconds, 32 bits each
    const auto both = number<std::uint64_t>(name);
    return static_cast<std::int64_t>((both & 0xFFFFFFFF) * 1000000000 + (both >> 32));
  }

 private:
  static constexpr std::size_t kMostFields = 100;  // chosen; the format has five
  struct Field {
    std::string_view name, value;
  };
  std::vector<Field> fields_;
};

// A record: its head, and where its data is.
struct BagRecord {
  std::string head_bytes;
  std::uint64_t data, size;
  BagFields head() const { return BagFields(head_bytes); }
};

struct BagChunk {
  std::uint64_t record;        // where its record begins, by which the index names it
  std::uint64_t offset, size;  // of its data in the file, packed
  std::uint64_t unpacked_size;
  std::string compression;
  std::int64_t first_ns = 0, last_ns = 0;
};

struct BagIndex {
  ByteSource source;
  std::vector<BagChunk> chunks;
  std::map<std::uint32_t, Topic> connections;
  std::map<std::uint32_t, std::size_t> topic_of;  // by connection
  std::vector<std::string> remarks;
};

Topic topic_of_connection(const BagFields& head, std::string_view data) {
  const BagFields fields(data);
  Topic topic{head.text("topic"), fields.text("type"), "ros1", "ros1msg", fields.text("message_definition"), 0};
  if (topic.name.empty()) topic.name = fields.text("topic");
  return topic;
}

// A chunk, by its chunk info record or by reading it.
struct BagChunkInfo {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  std::map<std::uint32_t, std::uint64_t> counts;  // by connection
};

std::string chunk_data(const BagIndex& index, const BagChunk& chunk) {
  const std::optional<Compression> compression = compression_of(chunk.compression);
  if (!compression) throw RecordingError(fmt::format("it is packed by '{}', which is unknown", chunk.compression));
  if (chunk.size > kLargestBlock)
    throw RecordingError(fmt::format("it has {} bytes, more than {}", chunk.size, kLargestBlock));
  std::string data = read_bytes(index.source, chunk.offset, chunk.size);
  return *compression == Compression::none ? data : decompressed(*compression, data, chunk.unpacked_size);
}

// Calls `take` with each record in the data of a chunk. Throws RecordingError at a record that is cut off.
template <class Take>
void for_each_in_chunk(std::string_view data, const Take& take) {
  ByteCursor cursor(data);
  while (cursor.left() > 0) {
    const BagFields head(cursor.text());
    const std::string_view content = cursor.text();
    take(head, head.number<std::uint8_t>("op"), content);
  }
}

class BagScan {
 public:
  explicit BagScan(const ByteSource& source) { index_.source = source; }

  BagIndex run() {
    std::uint64_t at = kBagMagic.size();
    while (at < size()) {
      const std::optional<BagRecord> record = record_at(at);
      if (!record) {
        index_.remarks.push_back(fmt::format("the file is cut off within the record at byte {} of {}", at, size()));
        break;
      }
      take(*record, at);
      at = record->data + record->size;
    }
    finish();
    return std::move(index_);
  }

 private:
  std::uint64_t size() const { return index_.source.size; }

  // Empty if the record goes beyond the file.
  std::optional<BagRecord> record_at(std::uint64_t at) {
    if (size() - at < 4) return std::nullopt;
    const auto head_size = ByteCursor(ahead_.at(at, 4)).number<std::uint32_t>();
    if (head_size > size() - at - 4 || size() - at - 4 - head_size < 4) return std::nullopt;
    if (head_size > kLongestHead)
      throw RecordingError(
          fmt::format("the head of the record at byte {} has {} bytes, which is too long", at, head_size));
    std::string head(ahead_.at(at + 4, head_size));
    const std::uint64_t data = at + 4 + head_size + 4;
    const auto data_size = ByteCursor(ahead_.at(data - 4, 4)).number<std::uint32_t>();
    if (data_size > size() - data) return std::nullopt;
    return BagRecord{std::move(head), data, data_size};
  }

  void take(const BagRecord& record, std::uint64_t at) {
    const BagFields head = record.head();
    switch (head.number<std::uint8_t>("op")) {
      case bag_header:
        if (!head.text("encryptor").empty()) throw RecordingError("it is encrypted; decrypt it first");
        break;
      case chunk_record:
        if (index_.chunks.size() >= kMostBagChunks)
          throw RecordingError(fmt::format("it has more than {} chunks", kMostBagChunks));
        index_.chunks.push_back(
            {at, record.data, record.size, head.number<std::uint32_t>("size"), head.text("compression")});
        break;
      case connection_record: {
        if (record.size > kLongestConnection) throw RecordingError("the definition of a message is too long");
        const std::string data = read_bytes(index_.source, record.data, record.size);
        index_.connections[head.number<std::uint32_t>("conn")] = topic_of_connection(head, data);
        break;
      }
      case chunk_info:
        take_info(record);
        break;
      case message_data:
        ++loose_;
        break;
      default:
        break;  // the index of a chunk, which is read whole
    }
  }

  void take_info(const BagRecord& record) {
    if (record.size > kLongestConnection) return;
    const BagFields head = record.head();
    BagChunkInfo info{head.time_ns("start_time"), head.time_ns("end_time"), {}};
    const std::string data = read_bytes(index_.source, record.data, record.size);
    for (ByteCursor cursor(data); cursor.left() >= 8;) {
      const auto connection = cursor.number<std::uint32_t>();
      info.counts[connection] += cursor.number<std::uint32_t>();
    }
    infos_[head.number<std::uint64_t>("chunk_pos")] = std::move(info);
  }

  void finish() {
    if (loose_ > 0)
      index_.remarks.push_back(fmt::format("{} messages outside of chunks, which version 2.0 does not have", loose_));
    std::size_t without_info = 0;
    for (BagChunk& chunk : index_.chunks) {
      auto info = infos_.find(chunk.record);
      if (info == infos_.end()) {
        ++without_info;
        info = infos_.emplace(chunk.record, read_for_info(chunk)).first;
      }
      chunk.first_ns = std::min(info->second.first_ns, info->second.last_ns);
      chunk.last_ns = std::max(info->second.first_ns, info->second.last_ns);
      for (const auto& [connection, count] : info->second.counts)
        if (const auto topic = index_.connections.find(connection); topic != index_.connections.end())
          topic->second.count += count;
    }
    if (without_info > 0)
      index_.remarks.push_back(
          fmt::format("{} of {} chunks are not in its index, as when the recorder was killed; "
                      "they are read nevertheless",
                      without_info, index_.chunks.size()));
  }

  BagChunkInfo read_for_info(const BagChunk& chunk) {
    BagChunkInfo info;
    try {
      const std::string data = chunk_data(index_, chunk);
      for_each_in_chunk(data, [&](const BagFields& head, std::uint8_t op, std::string_view content) {
        if (op == connection_record)
          index_.connections[head.number<std::uint32_t>("conn")] = topic_of_connection(head, content);
        if (op != message_data) return;
        ++info.counts[head.number<std::uint32_t>("conn")];
        info.first_ns = std::min(info.first_ns, head.time_ns("time"));
        info.last_ns = std::max(info.last_ns, head.time_ns("time"));
      });
    } catch (const RecordingError&) {
      // The visit names the chunk.
    }
    if (info.counts.empty()) info.first_ns = info.last_ns = 0;
    return info;
  }

  BagIndex index_;
  ReadAhead ahead_{index_.source};
  std::map<std::uint64_t, BagChunkInfo> infos_;  // by the chunk's place
  std::size_t loose_ = 0;
};

class BagVisit {
 public:
  explicit BagVisit(const BagIndex& index) : index_(index) {}

  std::vector<std::string> run(const TakeMessage& take, const TellProgress& tell) {
    std::vector<BlockTimes> times;
    for (const BagChunk& chunk : index_.chunks)
      times.push_back({chunk.first_ns, chunk.last_ns, std::min(chunk.unpacked_size, kLargestBlock)});
    const std::uint64_t late = visit_in_time_order(
        times, [this](std::size_t chunk) { return open(index_.chunks[chunk]); }, take, tell);
    if (late > 0) remarks_.push_back(fmt::format("{} messages are not in the order of their log times", late));
    for (const auto& [connection, count] : unknown_)
      remarks_.push_back(fmt::format("{} messages of connection {}, which the bag does not describe, are left out",
                                     count, connection));
    return std::move(remarks_);
  }

 private:
  OpenBlock open(const BagChunk& chunk) {
    OpenBlock opened;
    try {
      opened.bytes = chunk_data(index_, chunk);
    } catch (const RecordingError& error) {
      remarks_.push_back(
          fmt::format("the chunk at byte {}, {} bytes, is left out: {}", chunk.record, chunk.size, error.what()));
      return {};
    }
    try {
      for_each_in_chunk(opened.bytes, [&](const BagFields& head, std::uint8_t op, std::string_view content) {
        if (op == message_data) take_place(opened, head, content);
      });
    } catch (const RecordingError& error) {
      remarks_.push_back(fmt::format("the chunk at byte {} is damaged; {} messages before are read: {}", chunk.record,
                                     opened.messages.size(), error.what()));
    }
    return opened;
  }

  void take_place(OpenBlock& opened, const BagFields& head, std::string_view content) {
    const auto connection = head.number<std::uint32_t>("conn");
    const auto topic = index_.topic_of.find(connection);
    if (topic == index_.topic_of.end()) {
      ++unknown_[connection];
      return;
    }
    const auto offset = static_cast<std::size_t>(content.data() - opened.bytes.data());
    opened.messages.push_back({head.time_ns("time"), topic->second, offset, content.size()});
  }

  const BagIndex& index_;
  std::map<std::uint32_t, std::uint64_t> unknown_;
  std::vector<std::string> remarks_;
};

}  // namespace

bool begins_as_rosbag1(std::string_view bytes) {
  return bytes.starts_with(kBagBegin);
}

Recording open_rosbag1(const ByteSource& source) {
  const std::string begin = read_bytes(source, 0, std::min<std::uint64_t>(source.size, kBagMagic.size()));
  if (begin != kBagMagic)
    throw RecordingError(begins_as_rosbag1(begin)
                             ? fmt::format("it is a bag of version {}; convert it to 2.0: rosrun rosbag fix",
                                           begin.substr(kBagBegin.size(), begin.find('\n') - kBagBegin.size()))
                             : std::string("it does not begin as a rosbag"));
  const auto index = std::make_shared<BagIndex>(BagScan(source).run());
  Recording recording;
  recording.form = "rosbag 1";
  for (const auto& [id, topic] : index->connections) {
    const std::size_t at = topic_index(recording.topics, topic);
    recording.topics[at].count += topic.count;
    index->topic_of[id] = at;
  }
  recording.remarks = index->remarks;
  for (const BagChunk& chunk : index->chunks) widen_times(recording, chunk.first_ns, chunk.last_ns);
  recording.visit = [index](const TakeMessage& take, const TellProgress& tell) {
    return BagVisit(*index).run(take, tell);
  };
  return recording;
}

}  // namespace kenaf::gap::recordings
