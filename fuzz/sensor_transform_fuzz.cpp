// Any lines a world server may send: States stay finite, so that the datagrams made of them can be read.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/relay_datagram.hpp"
#include "protocol/usarsim_message.hpp"
#include "relayd/sensor_transform.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  relayd::SensorTransform transform;
  usarsim::LineSplitter lines;
  usarsim::MessageView message;
  lines.push({reinterpret_cast<const char*>(data), size});
  while (const auto line = lines.next()) {
    if (usarsim::parse_message(*line, message) != usarsim::ParseError::none) continue;
    if (!transform.take(message)) continue;
    const relay::State state{1, 0, false, false, transform.frame().state};
    std::array<std::byte, relay::kMaxDatagramBytes> bytes;
    relay::Datagram again;
    if (relay::decode({bytes.data(), relay::encode(state, bytes)}, again) != relay::DecodeError::none) std::abort();
  }
  return 0;
}
