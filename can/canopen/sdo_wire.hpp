// The bytes of SDO frames, for both ends in this room and for readers of a log. CiA 301, 7.2.4.3.3 to 7.2.4.3.7 and
// 7.2.4.3.17.
//
//   byte 0, bits 7 to 5: command specifier
//   initiate:  bits 3 and 2 = bytes of 4 to 7 without data, bit 1 = expedited (the value is in bytes 4 to 7),
//              bit 0 = the size is indicated (by bits 3 and 2, or, if not expedited, by bytes 4 to 7)
//              bytes 1 to 3 = index and sub-index
//   segment:   bit 4 = toggle, bits 3 to 1 = bytes of 1 to 7 without data, bit 0 = no more segments
#pragma once

#include <algorithm>
#include <optional>

#include "can/canopen/frame.hpp"
#include "can/canopen/sdo.hpp"

namespace kenaf::canopen::sdo {

// A download writes, an upload reads. The same specifier has different meanings in a request and in an answer.
inline constexpr std::uint8_t kDownloadSegment = 0x00, kDownload = 0x20, kUpload = 0x40, kUploadSegment = 0x60,
                              kAbort = 0x80;
inline constexpr std::uint8_t kUploadSegmentAnswer = 0x00, kDownloadSegmentAnswer = 0x20, kUploadAnswer = 0x40,
                              kDownloadAnswer = 0x60;
inline constexpr std::uint8_t kExpedited = 0x02, kSizeIndicated = 0x01, kToggle = 0x10, kNoMoreSegments = 0x01;
inline constexpr std::size_t kExpeditedBytes = 4, kSegmentBytes = 7;

inline std::uint8_t specifier(const Frame& frame) {
  return frame.data[0] & 0xe0;
}
inline std::uint8_t toggle(bool set) {
  return set ? kToggle : 0;
}

inline ObjectAddress address(const Frame& frame) {
  return {static_cast<std::uint16_t>(get_unsigned(frame.data, 1, 2)), frame.data[3]};
}

inline Frame initiate(std::uint16_t id, std::uint8_t command, ObjectAddress object, std::uint32_t data = 0) {
  Frame frame{.id = id, .length = 8};
  frame.data[0] = command;
  put(frame.data, 1, 2, object.index);
  frame.data[3] = object.sub;
  put(frame.data, 4, 4, data);
  return frame;
}

// Begins the transfer of `value`: expedited if it fits, otherwise with its size.
inline Frame initiate_with(std::uint16_t id, std::uint8_t command, ObjectAddress object, const ObjectBytes& value) {
  if (value.empty() || value.size() > kExpeditedBytes)
    return initiate(id, command | kSizeIndicated, object, static_cast<std::uint32_t>(value.size()));
  const auto unused = static_cast<std::uint8_t>(kExpeditedBytes - value.size());
  const std::uint8_t form = kExpedited | kSizeIndicated;
  return initiate(id, static_cast<std::uint8_t>(command | unused << 2 | form), object,
                  get_unsigned(value, 0, value.size()));
}

inline bool is_expedited(const Frame& frame) {
  return (frame.data[0] & kExpedited) != 0;
}

inline std::span<const std::uint8_t> expedited_value(const Frame& frame) {
  const bool indicated = (frame.data[0] & kSizeIndicated) != 0;
  return std::span(frame.data).subspan(4, kExpeditedBytes - (indicated ? frame.data[0] >> 2 & 3 : 0));
}

// The size announced by the first frame of a segmented transfer; nullopt if it has none.
inline std::optional<std::uint32_t> announced_size(const Frame& frame) {
  if ((frame.data[0] & kSizeIndicated) == 0) return std::nullopt;
  return get_unsigned(frame.data, 4, 4);
}

// A segment with as much of `rest` as fits.
inline Frame segment(std::uint16_t id, std::uint8_t command, std::span<const std::uint8_t> rest) {
  const std::size_t bytes = std::min(rest.size(), kSegmentBytes);
  Frame frame{.id = id, .length = 8};
  frame.data[0] = static_cast<std::uint8_t>(command | (kSegmentBytes - bytes) << 1);
  if (bytes == rest.size()) frame.data[0] |= kNoMoreSegments;
  std::copy_n(rest.begin(), bytes, frame.data.begin() + 1);
  return frame;
}

inline bool is_last(const Frame& frame) {
  return (frame.data[0] & kNoMoreSegments) != 0;
}

inline std::span<const std::uint8_t> segment_bytes(const Frame& frame) {
  return std::span(frame.data).subspan(1, kSegmentBytes - (frame.data[0] >> 1 & 7));
}

// Appends a segment's bytes to `value`, or returns why not. An empty segment that is not the last is refused: such
// segments could continue for ever.
inline std::optional<SdoAbort> append(ObjectBytes& value, std::optional<std::uint32_t> announced, const Frame& frame) {
  const std::span<const std::uint8_t> bytes = segment_bytes(frame);
  const std::size_t size = value.size() + bytes.size();
  if (announced && size > *announced) return SdoAbort::too_long;
  if (size > kMaxSdoBytes) return SdoAbort::out_of_memory;
  if (is_last(frame) ? announced && size < *announced : bytes.empty()) return SdoAbort::too_short;
  value.insert(value.end(), bytes.begin(), bytes.end());
  return std::nullopt;
}

}  // namespace kenaf::canopen::sdo
