// Any lines a world server may send while the relay places its robot: the handshake ends in time, with a robot or with
// words that say why not, and what it wants sent is bounded.
//
// The first byte is the time that passes from line to line, in 16 ms.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "formats/protocol/usarsim_message.hpp"
#include "relayd/sensor_transform.hpp"
#include "relayd/world_handshake.hpp"

using namespace kenaf;
using namespace kenaf::relayd;
using namespace std::chrono_literals;

namespace {

using Result = WorldHandshake::Result;

void require(bool fine) {
  if (!fine) __builtin_trap();
}

void check_result(const WorldHandshake& handshake, const std::string& sent) {
  require(sent.size() < 1024);
  require((handshake.result() == Result::failed) != handshake.failure().empty());
  if (handshake.result() == Result::extended || handshake.result() == Result::plain) {
    require(sent.find("INIT") != sent.npos);
    require(std::isfinite(handshake.ready().period_s) && std::isfinite(handshake.ready().robot_time_s));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto between = data[0] * 16ms;
  WorldHandshake::TimePoint now{};
  WorldHandshake handshake({}, {}, now);
  SensorTransform transform;
  protocol::usarsim::LineSplitter lines;
  protocol::usarsim::MessageView message;
  std::string sent;
  lines.push({reinterpret_cast<const char*>(data + 1), size - 1});
  while (const auto line = lines.next()) {
    now += between;
    handshake.on_time(now, sent);
    if (protocol::usarsim::parse_message(*line, message) != protocol::usarsim::ParseError::none) continue;
    handshake.on_message(message, transform.take(message), now, sent);
    if (const auto answer = read_session_answer(message)) require(std::isfinite(answer->ready.period_s));
    check_result(handshake, sent);
  }
  // the server says no more: the greeting's deadline, and then the robot's
  for (int deadlines = 0; deadlines < 2; ++deadlines) handshake.on_time(handshake.deadline(), sent);
  require(handshake.result() != Result::pending);
  check_result(handshake, sent);
  return 0;
}
