// Any lines a world server may send: States stay finite, so that the datagrams made of them can be read.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "formats/protocol/relay_datagram.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "relayd/sensor_transform.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  relayd::SensorTransform transform;
  protocol::usarsim::LineSplitter lines;
  protocol::usarsim::MessageView message;
  lines.push({reinterpret_cast<const char*>(data), size});
  while (const auto line = lines.next()) {
    if (protocol::usarsim::parse_message(*line, message) != protocol::usarsim::ParseError::none) continue;
    if (!transform.take(message)) continue;
    const relayd::WorldFrame& frame = transform.frame();
    const protocol::relay::State state{1, 0, false, false, frame.not_at_start, frame.state};
    std::array<std::byte, protocol::relay::kMaxDatagramBytes> bytes;
    protocol::relay::Datagram again;
    if (protocol::relay::decode({bytes.data(), protocol::relay::encode(state, bytes)}, again) !=
        protocol::DecodeError::none)
      std::abort();
  }
  return 0;
}
