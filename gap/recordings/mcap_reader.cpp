#include "gap/recordings/mcap_reader.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "gap/recordings/byte_cursor.hpp"
#include "gap/recordings/decompress.hpp"
#include "gap/recordings/mcap_records.hpp"
#include "gap/recordings/time_order.hpp"

namespace kenaf::gap::recordings {
namespace {

// Limits of memory, chosen.
constexpr std::size_t kMostBlocks = 1 << 20;
constexpr std::uint64_t kLongestText = 1 << 24;  // of a schema
constexpr std::uint64_t kLooseBlock = 1 << 20;   // messages outside of chunks are read so many bytes at once

struct McapSchema {
  std::string name, encoding, text;
};

struct McapChannel {
  std::uint16_t schema;
  std::string topic, message_encoding;
};

// The channels and schemas of the file, from its data or its summary.
struct Described {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
};

// A chunk, or a stretch of records outside of chunks.
struct McapBlock {
  std::uint64_t offset, size;  // of its records in the file, packed
  std::uint64_t unpacked_size;
  std::string compression;
  std::uint32_t crc = 0;  // of the unpacked records; 0: unknown
  std::int64_t first_ns, last_ns;
};

std::int64_t as_time(std::uint64_t ns) {
  return static_cast<std::int64_t>(std::min<std::uint64_t>(ns, INT64_MAX));
}

std::uint32_t crc_of(std::string_view bytes, std::uint32_t crc = 0) {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void take_schema(ByteCursor content, Described& described) {
  const auto id = content.number<std::uint16_t>();
  McapSchema schema{std::string(content.text()), std::string(content.text()), {}};
  schema.text = content.text();
  described.schemas[id] = std::move(schema);
}

void take_channel(ByteCursor content, Described& described) {
  const auto id = content.number<std::uint16_t>();
  const auto schema = content.number<std::uint16_t>();
  std::string topic(content.text());
  described.channels[id] = {schema, std::move(topic), std::string(content.text())};
}

struct McapRecord {
  std::uint8_t kind;
  std::string_view content;
};

// Calls `take` for each whole record; returns how many bytes at the end are none.
template <class Take>
std::size_t for_each_record(std::string_view bytes, const Take& take) {
  ByteCursor cursor(bytes);
  while (cursor.left() >= mcap::kHead) {
    const auto kind = cursor.number<std::uint8_t>();
    const auto length = cursor.number<std::uint64_t>();
    if (length > cursor.left()) return cursor.left() + mcap::kHead;
    take(McapRecord{kind, cursor.take(length)});
  }
  return cursor.left();
}

// All that is known of a file without its messages.
struct McapIndex {
  ByteSource source;
  std::vector<McapBlock> blocks;
  Described described;
  std::map<std::uint16_t, std::uint64_t> counts;
  std::map<std::uint16_t, std::size_t> topic_of;  // by channel
  std::vector<std::string> remarks;
};

// Goes from head to head through the records of a file.
class McapScan {
 public:
  explicit McapScan(const ByteSource& source) { index_.source = source; }

  McapIndex run() {
    std::uint64_t at = mcap::kMagic.size();
    while (!has_footer_ && at + mcap::kHead <= size()) {
      ByteCursor head(ahead_.at(at, mcap::kHead));
      const auto kind = head.number<std::uint8_t>();
      const auto length = head.number<std::uint64_t>();
      if (length > size() - at - mcap::kHead) break;
      take(kind, at + mcap::kHead, length);
      at += mcap::kHead + length;
    }
    if (!has_footer_)
      index_.remarks.push_back(fmt::format("the file is cut off within the record at byte {} of {}", at, size()));
    finish();
    return std::move(index_);
  }

 private:
  std::uint64_t size() const { return index_.source.size; }

  void take(std::uint8_t kind, std::uint64_t at, std::uint64_t length) {
    Described& described = data_ended_ ? of_summary_ : index_.described;
    switch (kind) {
      case mcap::schema:
        take_schema(ByteCursor(text(at, length)), described);
        break;
      case mcap::channel:
        take_channel(ByteCursor(text(at, length)), described);
        break;
      case mcap::message:
        take_message(at, length);
        break;
      case mcap::chunk:
        take_chunk(at, length);
        break;
      case mcap::attachment:
        ++attachments_;
        break;
      case mcap::statistics:
        take_statistics(text(at, length));
        break;
      case mcap::data_end:
        data_ended_ = true;
        break;
      case mcap::footer:
        take_footer(at, length);
        break;
      default:
        break;  // indexes, which the heads replace, metadata and kinds that are to be ignored
    }
  }

  std::string text(std::uint64_t at, std::uint64_t length) const {
    if (length > kLongestText)
      throw RecordingError(fmt::format("the record at byte {} has {} bytes, which is too long", at, length));
    return read_bytes(index_.source, at, length);
  }

  void add_block(McapBlock block) {
    if (index_.blocks.size() >= kMostBlocks)
      throw RecordingError(fmt::format("it has more than {} chunks", kMostBlocks));
    index_.blocks.push_back(std::move(block));
  }

  void take_message(std::uint64_t at, std::uint64_t length) {
    if (length < mcap::kMessageHead) return;
    ByteCursor head(ahead_.at(at, mcap::kMessageHead));
    head.take(6);  // channel and sequence
    const std::int64_t log_ns = as_time(head.number<std::uint64_t>());
    const std::uint64_t begin = at - mcap::kHead, end = at + length;
    if (!loose_ || end - index_.blocks.back().offset > kLooseBlock) {
      add_block({begin, 0, 0, "", 0, log_ns, log_ns});
      loose_ = true;
    }
    McapBlock& block = index_.blocks.back();
    block.size = block.unpacked_size = end - block.offset;
    block.first_ns = std::min(block.first_ns, log_ns);
    block.last_ns = std::max(block.last_ns, log_ns);
  }

  void take_chunk(std::uint64_t at, std::uint64_t length) {
    loose_ = false;
    ByteCursor head(ahead_.at(at, std::min<std::uint64_t>(length, 256)));
    const std::int64_t first_ns = as_time(head.number<std::uint64_t>());
    const std::int64_t last_ns = as_time(head.number<std::uint64_t>());
    const auto unpacked_size = head.number<std::uint64_t>();
    const auto crc = head.number<std::uint32_t>();
    const std::string compression(head.text());
    const auto records = head.number<std::uint64_t>();
    if (records > length - head.position())
      throw RecordingError(fmt::format("the chunk at byte {} says that it is longer than its record", at));
    add_block({at + head.position(), records, unpacked_size, compression, crc, first_ns, last_ns});
  }

  void take_statistics(const std::string& content) {
    ByteCursor cursor(content);
    cursor.take(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8);  // counts and times of all
    ByteCursor counts(cursor.text());
    while (counts.left() > 0) {
      const auto channel = counts.number<std::uint16_t>();
      index_.counts[channel] = counts.number<std::uint64_t>();
    }
    has_statistics_ = true;
  }

  void take_footer(std::uint64_t at, std::uint64_t length) {
    if (length < mcap::kFooterSize) return;
    has_footer_ = true;
    ByteCursor footer(ahead_.at(at, mcap::kFooterSize));
    const auto summary = footer.number<std::uint64_t>();
    footer.take(8);  // where the offsets of the summary begin
    const auto crc = footer.number<std::uint32_t>();
    const std::uint64_t end = at + mcap::kFooterSize - 4;  // the checksum is of all before itself
    // without a summary some writers give the checksum of the footer alone
    summary_is_wrong_ = summary != 0 && crc != 0 && (summary > end || crc_of_range(summary, end) != crc);
  }

  std::uint32_t crc_of_range(std::uint64_t from, std::uint64_t to) {
    std::uint32_t crc = 0;
    for (std::uint64_t at = from; at < to;) {
      const std::uint64_t count = std::min(ReadAhead::kMost, to - at);
      crc = crc_of(ahead_.at(at, count), crc);
      at += count;
    }
    return crc;
  }

  // Whether the summary names each channel that it counts.
  bool describes_all() const {
    const auto is_described = [this](const auto& count) {
      return of_summary_.channels.contains(count.first) || index_.described.channels.contains(count.first);
    };
    return has_statistics_ && std::ranges::all_of(index_.counts, is_described);
  }

  void finish() {
    if (attachments_ > 0) index_.remarks.push_back(fmt::format("{} attachments are not read", attachments_));
    if (summary_is_wrong_) index_.remarks.push_back("the checksum of its summary is wrong; the summary is not used");
    if (has_footer_ && !summary_is_wrong_ && describes_all()) {
      index_.described.schemas.merge(of_summary_.schemas);
      index_.described.channels.merge(of_summary_.channels);
    } else {
      index_.counts.clear();
      for (McapBlock& block : index_.blocks) read_for_topics(block);
    }
  }

  void read_for_topics(McapBlock& block);

  McapIndex index_;
  ReadAhead ahead_{index_.source};
  Described of_summary_;
  bool loose_ = false, data_ended_ = false, has_footer_ = false, has_statistics_ = false, summary_is_wrong_ = false;
  std::size_t attachments_ = 0;
};

// The records of a block. Throws RecordingError if they are damaged.
std::string records_of(const McapIndex& index, const McapBlock& block) {
  const std::optional<Compression> compression = compression_of(block.compression);
  if (!compression) throw RecordingError(fmt::format("it is packed by '{}', which is unknown", block.compression));
  if (std::max(block.size, block.unpacked_size) > kLargestBlock)
    throw RecordingError(
        fmt::format("it has {} bytes, more than {}", std::max(block.size, block.unpacked_size), kLargestBlock));
  std::string records = read_bytes(index.source, block.offset, block.size);
  if (*compression != Compression::none) records = decompressed(*compression, records, block.unpacked_size);
  if (block.crc != 0 && crc_of(records) != block.crc) throw RecordingError("its checksum is wrong");
  return records;
}

void McapScan::read_for_topics(McapBlock& block) try {
  const std::string records = records_of(index_, block);
  for_each_record(records, [this](const McapRecord& record) {
    if (record.kind == mcap::schema) take_schema(ByteCursor(record.content), index_.described);
    if (record.kind == mcap::channel) take_channel(ByteCursor(record.content), index_.described);
    if (record.kind == mcap::message) ++index_.counts[ByteCursor(record.content).number<std::uint16_t>()];
  });
} catch (const RecordingError&) {
  // The visit names the block.
}

std::vector<Topic> topics_of(McapIndex& index) {
  std::vector<Topic> topics;
  for (const auto& [id, channel] : index.described.channels) {
    Topic topic{channel.topic, "", channel.message_encoding, "", "", 0};
    if (const auto schema = index.described.schemas.find(channel.schema); schema != index.described.schemas.end()) {
      topic.type = schema->second.name;
      topic.schema_encoding = schema->second.encoding;
      topic.schema = schema->second.text;
    }
    const std::size_t at = topic_index(topics, topic);
    index.topic_of[id] = at;
    const auto count = index.counts.find(id);
    if (count != index.counts.end()) topics[at].count += count->second;
  }
  return topics;
}

// Visits the blocks of an index and keeps what is to be said of it.
class McapVisit {
 public:
  explicit McapVisit(const McapIndex& index) : index_(index) {}

  std::vector<std::string> run(const TakeMessage& take, const TellProgress& tell) {
    std::vector<BlockTimes> times;
    for (const McapBlock& block : index_.blocks)
      times.push_back({block.first_ns, block.last_ns, std::min(block.unpacked_size, kLargestBlock)});
    const std::uint64_t late = visit_in_time_order(
        times, [this](std::size_t block) { return open(index_.blocks[block]); }, take, tell);
    if (late > 0) remarks_.push_back(fmt::format("{} messages are not in the order of their log times", late));
    for (const auto& [channel, count] : unknown_)
      remarks_.push_back(
          fmt::format("{} messages of channel {}, which the file does not describe, are left out", count, channel));
    return std::move(remarks_);
  }

 private:
  OpenBlock open(const McapBlock& block) {
    OpenBlock opened;
    try {
      opened.bytes = records_of(index_, block);
      take_places(opened, block);
    } catch (const RecordingError& error) {
      remarks_.push_back(
          fmt::format("the chunk at byte {}, {} bytes of {:.3f} s, is left out: {}", block.offset, block.size,
                      1e-9 * (static_cast<double>(block.last_ns) - static_cast<double>(block.first_ns)), error.what()));
      opened = {};
    }
    return opened;
  }

  void take_places(OpenBlock& opened, const McapBlock& block) {
    const std::size_t cut = for_each_record(opened.bytes, [&](const McapRecord& record) {
      if (record.kind != mcap::message) return;
      ByteCursor content(record.content);
      const auto channel = content.number<std::uint16_t>();
      content.take(4);  // its number
      const std::int64_t log_ns = as_time(content.number<std::uint64_t>());
      content.take(8);  // when it was published
      const auto topic = index_.topic_of.find(channel);
      if (topic == index_.topic_of.end()) {
        ++unknown_[channel];
        return;
      }
      const auto offset = static_cast<std::size_t>(content.rest().data() - opened.bytes.data());
      opened.messages.push_back({log_ns, topic->second, offset, content.left()});
    });
    if (cut > 0)
      remarks_.push_back(
          fmt::format("the chunk at byte {} ends within a record; its last {} bytes are left out", block.offset, cut));
  }

  const McapIndex& index_;
  std::map<std::uint16_t, std::uint64_t> unknown_;
  std::vector<std::string> remarks_;
};

}  // namespace

bool begins_as_mcap(std::string_view bytes) {
  return bytes.starts_with(mcap::kMagic);
}

Recording open_mcap(const ByteSource& source) {
  if (source.size < mcap::kMagic.size() || !begins_as_mcap(read_bytes(source, 0, mcap::kMagic.size())))
    throw RecordingError("it does not begin as an MCAP file");
  const auto index = std::make_shared<McapIndex>(McapScan(source).run());
  Recording recording;
  recording.form = "MCAP";
  recording.topics = topics_of(*index);
  recording.remarks = index->remarks;
  for (const McapBlock& block : index->blocks) widen_times(recording, block.first_ns, block.last_ns);
  recording.visit = [index](const TakeMessage& take, const TellProgress& tell) {
    return McapVisit(*index).run(take, tell);
  };
  return recording;
}

}  // namespace kenaf::gap::recordings
