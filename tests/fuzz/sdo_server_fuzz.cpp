// Any frames: each request to the node but an abort has one answer, nothing else has one, and no value that is written
// is longer than the server says.
#include <cstddef>

#include "can/canopen/sdo_server.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf::canopen;
using kenaf::fuzz::require;

namespace {

constexpr NodeId kNode = 5;

// Objects of every length and a little more than may be sent; some refuse.
std::variant<ObjectBytes, SdoAbort> read(ObjectAddress object) {
  if (object.sub == 0xff) return SdoAbort::no_sub_index;
  return ObjectBytes(object.index % (kMaxSdoBytes + 10), object.sub);
}

std::optional<SdoAbort> write(ObjectAddress object, std::span<const std::uint8_t> value) {
  require(value.size() <= kMaxSdoBytes);
  if (object.sub == 0xff) return SdoAbort::read_only;
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kenaf::fuzz::CanInput input{{data, size}};
  SdoServer server(kNode, {.read = read, .write = write});
  while (!input.empty()) {
    const bool any = input.byte() % 8 == 0;
    const Frame frame = any ? input.any_frame() : input.frame(kSdoRequestId + kNode, 8);
    const std::optional<Frame> answer = server.on_frame(frame);
    const bool asks = frame.id == kSdoRequestId + kNode && frame.length == 8 && (frame.data[0] & 0xe0) != 0x80;
    require(answer.has_value() == asks);
    if (answer) require(answer->id == kSdoResponseId + kNode && answer->length == 8);
  }
  return 0;
}
