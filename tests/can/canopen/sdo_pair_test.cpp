// Client and server against each other, over a bus without faults.
#include <catch2/catch.hpp>

#include "can/canopen/sdo_client.hpp"
#include "can/canopen/sdo_server.hpp"

using namespace kenaf::canopen;
using namespace std::chrono_literals;

namespace {

ObjectBytes pattern(std::size_t size) {
  ObjectBytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 31 + size);
  return bytes;
}

// Frames that went over the bus until the client had its outcome.
int transfer(SdoClient& client, SdoServer& server, std::optional<Frame> request) {
  int frames = 0;
  while (request && !client.outcome()) {
    const std::optional<Frame> answer = server.on_frame(*request);
    REQUIRE(answer);
    frames += 2;
    request = client.on_frame(*answer, 0s);
  }
  CHECK_FALSE(request);
  return frames;
}

// By CiA 301: a request and an answer, and as many for every seven bytes where it takes segments.
int frames_for(std::size_t size) {
  return 2 + (size > 4 ? 2 * static_cast<int>((size + 6) / 7) : 0);
}

}  // namespace

TEST_CASE("A value of each length is written and read back") {
  const ObjectAddress object{0x2000, 1};
  ObjectBytes stored;
  int writes = 0;
  SdoServer server(
      9, {.read = [&](ObjectAddress) -> std::variant<ObjectBytes, SdoAbort> { return stored; },
          .write = [&](ObjectAddress written, std::span<const std::uint8_t> value) -> std::optional<SdoAbort> {
            REQUIRE(written == object);
            stored.assign(value.begin(), value.end());
            ++writes;
            return std::nullopt;
          }});
  SdoClient client(9, 50ms);
  for (std::size_t size = 1; size <= kMaxSdoBytes; ++size) {
    INFO(size << " bytes");
    const ObjectBytes value = pattern(size);
    REQUIRE(transfer(client, server, client.begin_write(object, value, 0s)) == frames_for(size));
    REQUIRE_FALSE(client.outcome()->abort);
    REQUIRE(stored == value);
    REQUIRE(transfer(client, server, client.begin_read(object, 0s)) == frames_for(size));
    REQUIRE_FALSE(client.outcome()->abort);
    REQUIRE(client.outcome()->value == value);
  }
  CHECK(writes == static_cast<int>(kMaxSdoBytes));
}
