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

std::string segment(const Frame& frame) {
  const auto bytes = sdo::segment_bytes(frame);
  const bool text = std::ranges::all_of(bytes, [](std::uint8_t c) { return c >= 0x20 && c < 0x7f; });
  const std::string content = text ? fmt::format("\"{}\"", std::string(bytes.begin(), bytes.end()))
                                   : fmt::format("{:02X}", fmt::join(bytes, " "));
  return content + (sdo::is_last(frame) ? ", the last" : "");
}

std::string abort_words(const Frame& frame) {
  const auto code = canopen::get_unsigned(frame.data, 4, 4);
  return fmt::format("aborts {}: {:#010x} {}", object_words(sdo::address(frame)), code,
                     describe(static_cast<canopen::SdoAbort>(code)));
}

}  // namespace

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
  return fmt::format("SDO block transfer or unknown request to {} ({:#04x})", node, frame.data[0]);
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
  return fmt::format("SDO block transfer or unknown answer of {} ({:#04x})", node, frame.data[0]);
}

}  // namespace kenaf::canlog
