// Records of recordings, made byte by byte.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "gap/recordings/recording.hpp"

namespace kenaf::test {

using namespace std::string_literals;

// Little endian.
template <class Number>
std::string bytes_of(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
inline std::string u16(std::uint16_t value) {
  return bytes_of(value);
}
inline std::string u32(std::uint32_t value) {
  return bytes_of(value);
}
inline std::string u64(std::uint64_t value) {
  return bytes_of(value);
}
inline std::string f64(double value) {
  return bytes_of(value);
}
inline std::string sized(std::string_view text) {
  return u32(static_cast<std::uint32_t>(text.size())).append(text);
}

namespace made_mcap {

inline const std::string kMagic = "\x89MCAP0\r\n"s;

inline std::string record(char kind, const std::string& content) {
  return kind + u64(content.size()) + content;
}
inline std::string head() {
  return kMagic + record(1, sized("") + sized(""));
}
// Without a summary.
inline std::string end() {
  return record(15, u32(0)) + record(2, u64(0) + u64(0) + u32(0)) + kMagic;
}
inline std::string schema(std::uint16_t id, const std::string& name, const std::string& encoding,
                          const std::string& text) {
  return record(3, u16(id) + sized(name) + sized(encoding) + sized(text));
}
inline std::string channel(std::uint16_t id, std::uint16_t schema_id, const std::string& topic,
                           const std::string& encoding) {
  return record(4, u16(id) + u16(schema_id) + sized(topic) + sized(encoding) + sized(""));
}
inline std::string message(std::uint16_t channel_id, std::uint64_t log_ns, const std::string& data) {
  return record(5, u16(channel_id) + u32(0) + u64(log_ns) + u64(log_ns) + data);
}
struct ChunkSays {
  std::string compression;
  std::uint64_t unpacked_size;
  std::uint32_t crc;
};
inline std::uint32_t crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}
inline std::string chunk(std::uint64_t first_ns, std::uint64_t last_ns, const std::string& packed,
                         const ChunkSays& says) {
  return record(6, u64(first_ns) + u64(last_ns) + u64(says.unpacked_size) + u32(says.crc) + sized(says.compression) +
                       u64(packed.size()) + packed);
}
inline std::string chunk(std::uint64_t first_ns, std::uint64_t last_ns, const std::string& records) {
  return chunk(first_ns, last_ns, records, {"", records.size(), crc(records)});
}

}  // namespace made_mcap

// A message as a visit gave it.
struct Taken {
  std::string topic;
  std::int64_t log_ns;
  std::string bytes;
  bool operator==(const Taken&) const = default;
};

struct Visited {
  std::vector<Taken> messages;
  std::vector<std::string> remarks;
};

inline Visited visited(const gap::recordings::Recording& recording) {
  Visited all;
  all.remarks = recording.visit(
      [&](const gap::recordings::Message& message) {
        all.messages.push_back({recording.topics.at(message.topic).name, message.log_ns, std::string(message.bytes)});
        return true;
      },
      {});
  return all;
}

}  // namespace kenaf::test
