#include "can/canlog/describe_sdo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "can/canlog/object_names.hpp"
#include "can/canopen/sdo.hpp"
#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canlog {
namespace {

using canopen::Frame;
namespace sdo = canopen::sdo;

// The value in the first frame of a transfer: a number, or its announced length.
std::string initiated(const Frame& frame) {
  if (sdo::is_expedited(frame)) {
    const auto bytes = sdo::expedited_value(frame);
    return fmt::format("{:#0{}x}", canopen::get_unsigned(bytes, 0, bytes.size()), 2 + 2 * bytes.size());
  }
  const auto size = sdo::announced_size(frame);
  return size ? fmt::format("{} bytes in segments", *size) : "in segments";
}

constexpr std::size_t kMostShown = 32;

// Text in quotes, other bytes in hexadecimal; the beginning of long ones.
std::string content(std::span<const std::uint8_t> all) {
  const auto bytes = all.first(std::min(all.size(), kMostShown));
  const std::string_view more = bytes.size() < all.size() ? "..." : "";
  const bool text = std::ranges::all_of(bytes, [](std::uint8_t c) { return c >= 0x20 && c < 0x7f; });
  if (text) return fmt::format("\"{}{}\"", std::string(bytes.begin(), bytes.end()), more);
  return fmt::format("{:02X}{}", fmt::join(bytes, " "), more);
}

std::string segment(const Frame& frame) {
  return content(sdo::segment_bytes(frame)) + (sdo::is_last(frame) ? ", the last" : "");
}

std::string abort_words(const Frame& frame) {
  const auto code = canopen::get_unsigned(frame.data, 4, 4);
  return fmt::format("aborts {}: {:#010x} {}", object_words(sdo::address(frame)), code,
                     describe(static_cast<canopen::SdoAbort>(code)));
}

// Bits of a block transfer's frames, but for segments: CiA 301, 7.2.4.3.9 to 7.2.4.3.15.
constexpr std::uint8_t kBlockSender = 0xc0, kBlockReceiver = 0xa0, kBlockSize = 0x02, kBlockEnd = 0x01;

std::string block_size_words(const Frame& frame) {
  return (frame.data[0] & kBlockSize) != 0 ? fmt::format("{} bytes", canopen::get_unsigned(frame.data, 4, 4))
                                           : std::string("size unknown");
}

// Bits 1 and 0 of a receiver's frame.
std::string receiver_words(const Frame& frame, const std::string& initiated) {
  switch (frame.data[0] & 3) {
    case 0:
      return initiated;
    case 1:
      return "end confirmed";
    case 2:
      return fmt::format("up to segment {} taken, next block of {}", frame.data[1], frame.data[2]);
    default:
      return "start";
  }
}

}  // namespace

std::string block_segment_words(const Frame& frame, const std::string& node, bool by_node) {
  return fmt::format("SDO block segment {} {} {}: {}{}", frame.data[0] & 0x7f, by_node ? "of" : "to", node,
                     content(std::span(frame.data).subspan(1)), (frame.data[0] & 0x80) != 0 ? ", the last" : "");
}

std::string block_end_words(const SdoBlock& block, const Frame& frame, const std::string& node) {
  const std::uint32_t given = canopen::get_unsigned(frame.data, 1, 2);
  const std::string crc = !block.has_crc()       ? "no CRC"
                          : given == block.crc() ? fmt::format("CRC {:#06x}", given)
                                                 : fmt::format("CRC {:#06x} is wrong: {:#06x}", given, block.crc());
  return fmt::format("SDO block end {} {}: {} = {}, {} bytes, {}", block.is_download() ? "to" : "of", node,
                     object_words(block.object()), content(block.value()), block.size(), crc);
}

std::string sdo_request_words(const Frame& frame, const std::string& node) {
  switch (sdo::specifier(frame)) {
    case sdo::kDownload:
      return fmt::format("SDO write {} of {} = {}", object_words(sdo::address(frame)), node, initiated(frame));
    case sdo::kUpload:
      return fmt::format("SDO read {} from {}", object_words(sdo::address(frame)), node);
    case sdo::kDownloadSegment:
      return fmt::format("SDO segment to {}: {}", node, segment(frame));
    case sdo::kUploadSegment:
      return fmt::format("SDO next segment from {}", node);
    case sdo::kAbort:
      return fmt::format("SDO master, to {}, {}", node, abort_words(frame));
  }
  const std::string object = object_words(sdo::address(frame));
  if (sdo::specifier(frame) == kBlockReceiver) {
    const std::string read = fmt::format("read {}, in blocks of {}", object, frame.data[4]);
    return fmt::format("SDO block from {}: {}", node, receiver_words(frame, read));
  }
  if (sdo::specifier(frame) == kBlockSender && (frame.data[0] & kBlockEnd) != 0)
    return fmt::format("SDO block end to {}", node);
  if (sdo::specifier(frame) == kBlockSender)
    return fmt::format("SDO block write {} of {}, {}", object, node, block_size_words(frame));
  return fmt::format("SDO request to {} that CiA 301 does not define ({:#04x})", node, frame.data[0]);
}

std::string sdo_answer_words(const Frame& frame, const std::string& node) {
  switch (sdo::specifier(frame)) {
    case sdo::kDownloadAnswer:
      return fmt::format("SDO answer of {}: {} written", node, object_words(sdo::address(frame)));
    case sdo::kUploadAnswer:
      return fmt::format("SDO answer of {}: {} = {}", node, object_words(sdo::address(frame)), initiated(frame));
    case sdo::kUploadSegmentAnswer:
      return fmt::format("SDO segment of {}: {}", node, segment(frame));
    case sdo::kDownloadSegmentAnswer:
      return fmt::format("SDO answer of {}: segment taken", node);
    case sdo::kAbort:
      return fmt::format("SDO answer of {}: it {}", node, abort_words(frame));
  }
  const std::string object = object_words(sdo::address(frame));
  if (sdo::specifier(frame) == kBlockReceiver) {
    const std::string begun = fmt::format("{}, in blocks of {}", object, frame.data[4]);
    return fmt::format("SDO block answer of {}: {}", node, receiver_words(frame, begun));
  }
  if (sdo::specifier(frame) == kBlockSender && (frame.data[0] & kBlockEnd) != 0)
    return fmt::format("SDO block end of {}", node);
  if (sdo::specifier(frame) == kBlockSender)
    return fmt::format("SDO block answer of {}: {}, {}", node, object, block_size_words(frame));
  return fmt::format("SDO answer of {} that CiA 301 does not define ({:#04x})", node, frame.data[0]);
}

}  // namespace kenaf::canlog
