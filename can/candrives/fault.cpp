#include "can/candrives/fault.hpp"

#include <algorithm>

#include "can/canopen/sdo.hpp"

namespace kenaf::candrives {

using canopen::Frame;
using canopen::NodeId;

namespace {

bool is_pdo_of(const Frame& frame, NodeId node) {
  return std::ranges::any_of(canopen::kTransmitPdoId, [&](std::uint16_t first) { return frame.id == first + node; });
}

// True if the frame answers a segment request: its specifier, bits 7 to 5, is 0 for an upload and 1 for a download.
bool answers_segment(const Frame& frame) {
  return frame.data[0] >> 5 <= 1;
}

// Bytes that CiA 301, 7.2.4.3, reserves or leaves unused: behind the value of an expedited upload, and behind the
// address in the answer to a download.
void fill_unused(Frame& answer) {
  constexpr std::uint8_t kUploadAnswer = 0x40, kDownloadAnswer = 0x60, kExpeditedWithSize = 0x03, kNoise = 0xa5;
  const std::uint8_t specifier = answer.data[0] & 0xe0;
  const std::size_t length = std::min<std::size_t>(answer.length, answer.data.size());
  std::size_t used = length;
  if (specifier == kDownloadAnswer) used = 4;
  if (specifier == kUploadAnswer && (answer.data[0] & kExpeditedWithSize) == kExpeditedWithSize)
    used = 8u - (answer.data[0] >> 2 & 3u);
  for (std::size_t i = used; i < length; ++i) answer.data[i] = static_cast<std::uint8_t>(kNoise + 31 * i);
}

constexpr std::uint8_t kAbort = 0x80, kToggle = 0x10;

}  // namespace

bool is_sdo_answer(const Frame& frame, NodeId node) {
  return frame.id == canopen::kSdoResponseId + node;
}

Frame altered(const Frame& frame, NodeId node, const NodeFaults& faults) {
  Frame on_bus = frame;
  if (faults.short_pdos && is_pdo_of(frame, node) && frame.length > 0) on_bus.data[--on_bus.length] = 0;
  if (!is_sdo_answer(frame, node)) return on_bus;
  if (faults.sdo_abort) {
    on_bus.data[0] = kAbort;
    canopen::put(on_bus.data, 4, 4, static_cast<std::uint32_t>(canopen::SdoAbort::general));
  } else if (faults.sdo_wrong_toggle && answers_segment(frame)) {
    on_bus.data[0] ^= kToggle;
  } else if (faults.sdo_garbage) {
    fill_unused(on_bus);
  }
  return on_bus;
}

}  // namespace kenaf::candrives
