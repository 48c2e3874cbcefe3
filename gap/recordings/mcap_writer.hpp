// Writes MCAP files (mcap.dev/spec, version 0) of messages in JSON, which PlotJuggler and Foxglove open: chunks packed
// by zstd, with checksums, indexes and a summary.
//
// Thread safety: one thread at a time uses a writer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

class McapWriter {
 public:
  // Writes to `<file>.part`, which finish() renames. Throws runs::RunFileError if it cannot be created.
  explicit McapWriter(std::filesystem::path file);
  ~McapWriter();  // without finish(): the part file stays for inspection
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // `json_schema` (json-schema.org) describes the messages; its root is an object. At most 65535 channels.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name, const std::string& json_schema);
  // Messages may come in any order; readers sort. Throws runs::RunFileError if the file cannot be written.
  void add_message(std::uint16_t channel, std::uint64_t log_ns, std::string_view json);
  // Throws runs::RunFileError if the file is incomplete. No message may follow.
  void finish();

 private:
  struct Channel {
    std::string topic, schema_name, json_schema;
    std::uint64_t count = 0;
    bool in_data = false;  // its description was written before its first message
  };
  struct ChunkPlace {
    std::uint64_t first_ns, last_ns, offset, length;
    std::map<std::uint16_t, std::uint64_t> index_offsets;  // by channel
    std::uint64_t index_length, packed_size, unpacked_size;
  };
  std::string descriptions(std::uint16_t channel) const;
  void append(std::string_view bytes);
  void end_chunk();
  std::string statistics() const;

  std::filesystem::path file_;
  int descriptor_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // of all that was written
  std::vector<Channel> channels_;
  // The chunk that is being filled: its records, and where in them each channel's messages are.
  std::string chunk_;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_index_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<ChunkPlace> chunks_;
};

}  // namespace kenaf::gap::recordings
