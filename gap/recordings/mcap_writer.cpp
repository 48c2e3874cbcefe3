#include "gap/recordings/mcap_writer.hpp"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "formats/runs/whole_file.hpp"
#include "gap/recordings/decompress.hpp"
#include "gap/recordings/mcap_records.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::size_t kChunkSize = 1 << 20;  // chosen, as recorders have it

// Numbers little endian, texts after their length.
class RecordBytes {
 public:
  template <class Number>
  RecordBytes& number(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
    return *this;
  }
  RecordBytes& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  RecordBytes& raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string mcap_record(mcap::Kind kind, const std::string& content) {
  return RecordBytes()
      .number(static_cast<std::uint8_t>(kind))
      .number(static_cast<std::uint64_t>(content.size()))
      .raw(content)
      .bytes();
}

std::uint32_t crc_with(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

McapWriter::McapWriter(std::filesystem::path file) : file_(std::move(file)), descriptor_(runs::open_part_file(file_)) {
  append(mcap::kMagic);
  append(mcap_record(mcap::header, RecordBytes().text("").text("kenaf").bytes()));
}

McapWriter::~McapWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void McapWriter::append(std::string_view bytes) {
  runs::append_to_part_file(descriptor_, file_, bytes);
  size_ += bytes.size();
  crc_ = crc_with(crc_, bytes);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      const std::string& json_schema) {
  if (channels_.size() == std::numeric_limits<std::uint16_t>::max())
    throw std::length_error("too many channels of an MCAP file");
  channels_.push_back({topic, schema_name, json_schema});
  return static_cast<std::uint16_t>(channels_.size());
}

// The records of a channel and its schema; both have its number, as 0 is no schema's.
std::string McapWriter::descriptions(std::uint16_t channel) const {
  const Channel& described = channels_.at(channel - 1U);
  return mcap_record(mcap::schema, RecordBytes()
                                       .number(channel)
                                       .text(described.schema_name)
                                       .text("jsonschema")
                                       .text(described.json_schema)
                                       .bytes()) +
         mcap_record(mcap::channel,
                     RecordBytes().number(channel).number(channel).text(described.topic).text("json").text("").bytes());
}

void McapWriter::add_message(std::uint16_t channel, std::uint64_t log_ns, std::string_view json) {
  Channel& described = channels_.at(channel - 1U);
  if (!std::exchange(described.in_data, true)) chunk_ += descriptions(channel);
  const bool is_first = chunk_index_.empty();
  chunk_first_ns_ = is_first ? log_ns : std::min(chunk_first_ns_, log_ns);
  chunk_last_ns_ = is_first ? log_ns : std::max(chunk_last_ns_, log_ns);
  chunk_index_[channel].emplace_back(log_ns, chunk_.size());
  chunk_ += mcap_record(mcap::message, RecordBytes()
                                           .number(channel)
                                           .number(static_cast<std::uint32_t>(described.count++))
                                           .number(log_ns)
                                           .number(log_ns)
                                           .raw(json)
                                           .bytes());
  if (chunk_.size() >= kChunkSize) end_chunk();
}

void McapWriter::end_chunk() {
  // The chunk with its messages, packed.
  if (chunk_.empty()) return;
  const std::string packed = compressed_zstd(chunk_);
  ChunkPlace place{chunk_first_ns_, chunk_last_ns_, size_, 0, {}, 0, packed.size(), chunk_.size()};
  append(mcap_record(mcap::chunk, RecordBytes()
                                      .number(chunk_first_ns_)
                                      .number(chunk_last_ns_)
                                      .number(static_cast<std::uint64_t>(chunk_.size()))
                                      .number(crc_with(0, chunk_))
                                      .text("zstd")
                                      .number(static_cast<std::uint64_t>(packed.size()))
                                      .raw(packed)
                                      .bytes()));
  place.length = size_ - place.offset;

  // Behind it an index for each channel; the summary at the file's end points to both.
  for (const auto& [channel, messages] : chunk_index_) {
    place.index_offsets[channel] = size_;
    RecordBytes entries;
    for (const auto& [log_ns, offset] : messages) entries.number(log_ns).number(offset);
    append(mcap_record(mcap::message_index, RecordBytes().number(channel).text(entries.bytes()).bytes()));
  }
  place.index_length = size_ - place.offset - place.length;
  chunks_.push_back(std::move(place));
  chunk_.clear();
  chunk_index_.clear();
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, first_ns = 0, last_ns = 0;
  RecordBytes counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    messages += channels_[i].count;
    counts.number(static_cast<std::uint16_t>(i + 1)).number(channels_[i].count);
  }
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    first_ns = i == 0 ? chunks_[i].first_ns : std::min(first_ns, chunks_[i].first_ns);
    last_ns = std::max(last_ns, chunks_[i].last_ns);
  }
  return mcap_record(mcap::statistics, RecordBytes()
                                           .number(messages)
                                           .number(static_cast<std::uint16_t>(channels_.size()))
                                           .number(static_cast<std::uint32_t>(channels_.size()))
                                           .number(std::uint32_t{0})  // attachments
                                           .number(std::uint32_t{0})  // metadata
                                           .number(static_cast<std::uint32_t>(chunks_.size()))
                                           .number(first_ns)
                                           .number(last_ns)
                                           .text(counts.bytes())
                                           .bytes());
}

void McapWriter::finish() {
  end_chunk();
  append(mcap_record(mcap::data_end, RecordBytes().number(crc_).bytes()));

  // The summary: all descriptions, counts and chunks, so that a reader need not go through the file.
  const std::uint64_t summary = size_;
  std::string described, places;
  for (std::size_t i = 0; i < channels_.size(); ++i) described += descriptions(static_cast<std::uint16_t>(i + 1));
  for (const ChunkPlace& place : chunks_) {
    RecordBytes offsets;
    for (const auto& [channel, offset] : place.index_offsets) offsets.number(channel).number(offset);
    places += mcap_record(mcap::chunk_index, RecordBytes()
                                                 .number(place.first_ns)
                                                 .number(place.last_ns)
                                                 .number(place.offset)
                                                 .number(place.length)
                                                 .text(offsets.bytes())
                                                 .number(place.index_length)
                                                 .text("zstd")
                                                 .number(place.packed_size)
                                                 .number(place.unpacked_size)
                                                 .bytes());
  }
  // The footer's own checksum is of the summary and of itself up to there.
  const std::string records = described + statistics() + places;
  const std::string footer_begin = RecordBytes()
                                       .number(static_cast<std::uint8_t>(mcap::footer))
                                       .number(mcap::kFooterSize)
                                       .number(summary)
                                       .number(std::uint64_t{0})  // no offsets of the summary's groups
                                       .bytes();
  append(records);
  append(footer_begin);
  append(RecordBytes().number(crc_with(crc_with(0, records), footer_begin)).bytes());
  append(mcap::kMagic);
  runs::finish_part_file(std::exchange(descriptor_, -1), file_);
}

}  // namespace kenaf::gap::recordings
