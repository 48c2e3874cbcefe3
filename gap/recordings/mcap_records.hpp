// The kinds of records of an MCAP file and its magic bytes (mcap.dev/spec, version 0), for the reader and the writer.
#pragma once

#include <cstdint>
#include <string_view>

namespace kenaf::gap::recordings::mcap {

using namespace std::string_view_literals;

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n"sv;
inline constexpr std::uint64_t kHead = 9;  // of each record: its kind in a byte, the length of its content in 8

enum Kind : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::uint64_t kFooterSize = 20;   // content of the footer
inline constexpr std::uint64_t kMessageHead = 22;  // of a message's content before its data

}  // namespace kenaf::gap::recordings::mcap
