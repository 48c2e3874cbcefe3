// Any frames and times in any transfer: the client sends nothing but requests to its node, takes no more than it says,
// and comes to an outcome once its patience is over.
#include <cstddef>

#include "can/canopen/sdo_client.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf::canopen;
using namespace std::chrono_literals;
using kenaf::fuzz::require;

namespace {

constexpr NodeId kNode = 5;
constexpr Time kPatience = 50ms;

void check_request(const Frame& frame) {
  require(frame.id == kSdoRequestId + kNode && frame.length == 8);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kenaf::fuzz::CanInput input{{data, size}};
  SdoClient client(kNode, kPatience);
  Time now = 0s;
  ObjectAddress object;
  bool begun = false;
  std::size_t frames = 0;  // that the transfer under way has sent

  const auto sent = [&](const std::optional<Frame>& frame) {
    if (!frame) return;
    check_request(*frame);
    // each frame but the first, the last and an abort moves a byte
    require(++frames <= kMaxSdoBytes + 3);
  };
  while (!input.empty()) {
    const bool had_outcome = client.outcome().has_value();
    const std::uint8_t action = input.byte();
    switch (action % 6) {
      case 0:
      case 1: {
        object = {input.word(), input.byte()};
        begun = true;
        frames = 0;
        if (action % 6 == 0) {
          sent(client.begin_read(object, now));
        } else {
          const std::size_t bytes = input.word() % kMaxSdoBytes + 1;
          sent(client.begin_write(object, ObjectBytes(bytes, action), now));
        }
        require(!client.outcome() && client.deadline() == now + kPatience);
        continue;
      }
      case 2:
        sent(client.on_frame(input.frame(kSdoResponseId + kNode, 8), now));
        break;
      case 3: {  // one that names the object
        Frame frame = input.frame(kSdoResponseId + kNode, 5);
        frame.length = 8;
        put(frame.data, 4, 4, get_unsigned(frame.data, 1, 4));
        put(frame.data, 1, 2, object.index);
        frame.data[3] = object.sub;
        sent(client.on_frame(frame, now));
        break;
      }
      case 4:
        sent(client.on_frame(input.any_frame(), now));
        break;
      case 5:
        now += std::chrono::milliseconds(input.byte());
        sent(client.on_time(now));
        require(!begun || client.outcome() || now < client.deadline());
        break;
    }
    require(begun || !client.outcome());
    if (had_outcome) require(client.outcome().has_value());
    if (client.outcome()) {
      const SdoOutcome& outcome = *client.outcome();
      require(outcome.object == object && outcome.value.size() <= kMaxSdoBytes);
      require(!outcome.abort || outcome.value.empty());
      if (outcome.abort) require(!describe(*outcome.abort).empty());
    } else if (begun) {
      require(client.deadline() <= now + kPatience);
    }
  }
  if (begun && !client.outcome()) {
    const std::optional<Frame> abort = client.on_time(client.deadline());
    require(abort.has_value() && abort->data[0] == 0x80);
    require(client.outcome().has_value() && client.outcome()->abort == SdoAbort::timed_out);
  }
  return 0;
}
