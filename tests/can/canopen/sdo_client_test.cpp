// The client's frames, byte by byte as CiA 301, 7.2.4.3 has them. The server is node 5: requests 0x605, answers 0x585.
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "can/canopen/sdo_client.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;
using namespace std::chrono_literals;

namespace {

constexpr ObjectAddress kStatusword{0x6041, 0}, kName{0x1008, 0}, kControlword{0x6040, 0}, kStore{0x2000, 1};
constexpr Time kStart = 7s, kPatience = 50ms;

const Frame kSegmentRequest = request({0x60, 0, 0, 0, 0, 0, 0, 0});         // command 3, toggle 0
const Frame kToggledSegmentRequest = request({0x70, 0, 0, 0, 0, 0, 0, 0});  // toggle 1

Frame abort_of(ObjectAddress object, std::uint32_t code) {
  Frame frame = request({0x80, 0, 0, 0, 0, 0, 0, 0});  // command 4; index, sub-index, code
  put(frame.data, 1, 2, object.index);
  frame.data[3] = object.sub;
  put(frame.data, 4, 4, code);
  return frame;
}

void check_aborted(const SdoClient& client, SdoAbort abort, bool by_server) {
  REQUIRE(client.outcome());
  REQUIRE(client.outcome()->abort);
  CHECK(*client.outcome()->abort == abort);
  CHECK(client.outcome()->by_server == by_server);
  CHECK(client.outcome()->value.empty());
}

void check_done(const SdoClient& client, ObjectAddress object, const ObjectBytes& value) {
  REQUIRE(client.outcome());
  CHECK_FALSE(client.outcome()->abort);
  CHECK(client.outcome()->object == object);
  CHECK(client.outcome()->value == value);
}

// A segmented read that has come to where the node has said its first frame.
SdoClient reading(const Frame& first) {
  SdoClient client(5, kPatience);
  client.begin_read(kName, kStart);
  REQUIRE(client.on_frame(first, kStart) == kSegmentRequest);
  return client;
}

SdoClient writing(const ObjectBytes& value) {
  SdoClient client(5, kPatience);
  client.begin_write(kStore, value, kStart);
  REQUIRE(client.on_frame(answer({0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0}), kStart));
  return client;
}

}  // namespace

TEST_CASE("A read in one frame") {
  SdoClient client(5, kPatience);
  // command 2, initiate upload; index 0x6041 low byte first, sub-index 0
  CHECK(client.begin_read(kStatusword, kStart) == request({0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0}));
  CHECK_FALSE(client.outcome());
  // answer 2; bits 3 and 2: 2 of 4 bytes empty, bit 1: expedited, bit 0: size said: 0x40 + 8 + 2 + 1
  CHECK_FALSE(client.on_frame(answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}), kStart + 1ms));
  check_done(client, kStatusword, {0x37, 0x02});
}

TEST_CASE("Every size of a read in one frame") {
  const auto read = [](std::uint8_t command) {
    SdoClient client(5, kPatience);
    client.begin_read(kStatusword, kStart);
    CHECK_FALSE(client.on_frame(answer({command, 0x41, 0x60, 0x00, 1, 2, 3, 4}), kStart));
    REQUIRE(client.outcome());
    return client.outcome()->value;
  };
  CHECK(read(0x4f) == ObjectBytes{1});  // 3 of 4 empty
  CHECK(read(0x4b) == ObjectBytes{1, 2});
  CHECK(read(0x47) == ObjectBytes{1, 2, 3});
  CHECK(read(0x43) == ObjectBytes{1, 2, 3, 4});
  CHECK(read(0x42) == ObjectBytes{1, 2, 3, 4});  // size not said
  CHECK(read(0x4e) == ObjectBytes{1, 2, 3, 4});  // nor then, whatever bits 3 and 2 are
}

TEST_CASE("A read in segments") {
  SdoClient client(5, kPatience);
  CHECK(client.begin_read(kName, kStart) == request({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  // answer 2, not expedited, size said: 11 bytes
  CHECK(client.on_frame(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}), kStart) == kSegmentRequest);
  // answer 0, toggle 0, none of 7 empty, more to come
  CHECK(client.on_frame(answer({0x00, 'K', 'e', 'n', 'a', 'f', ' ', 'd'}), kStart) == kToggledSegmentRequest);
  CHECK_FALSE(client.outcome());
  // toggle 0x10, 3 of 7 empty: 3 << 1, no more: 1
  CHECK_FALSE(client.on_frame(answer({0x17, 'r', 'i', 'v', 'e', 0, 0, 0}), kStart));
  check_done(client, kName, {'K', 'e', 'n', 'a', 'f', ' ', 'd', 'r', 'i', 'v', 'e'});
}

TEST_CASE("A read in segments whose size is not said, and one of segments that are not full") {
  SdoClient client = reading(answer({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  CHECK(client.on_frame(answer({0x0a, 'a', 'b', 0, 0, 0, 0, 0}), kStart) == kToggledSegmentRequest);  // 5 empty
  CHECK(client.on_frame(answer({0x1c, 'c', 0, 0, 0, 0, 0, 0}), kStart) == kSegmentRequest);           // 6 empty
  CHECK_FALSE(client.on_frame(answer({0x01, 'd', 'e', 'f', 'g', 'h', 'i', 'j'}), kStart));
  check_done(client, kName, {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j'});
}

TEST_CASE("An empty text is read: a last segment without a byte") {
  SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  CHECK_FALSE(client.on_frame(answer({0x0f, 0, 0, 0, 0, 0, 0, 0}), kStart));
  check_done(client, kName, {});
}

TEST_CASE("A write in one frame, of each size") {
  const auto write = [](const ObjectBytes& value) {
    SdoClient client(5, kPatience);
    const Frame frame = client.begin_write(kControlword, value, kStart);
    // answer 3
    CHECK_FALSE(client.on_frame(answer({0x60, 0x40, 0x60, 0x00, 0, 0, 0, 0}), kStart));
    check_done(client, kControlword, {});
    return frame;
  };
  // command 1, initiate download, expedited 2, size said 1, empty bytes << 2
  CHECK(write({0x0f}) == request({0x2f, 0x40, 0x60, 0x00, 0x0f, 0, 0, 0}));
  CHECK(write({0x0f, 0x01}) == request({0x2b, 0x40, 0x60, 0x00, 0x0f, 0x01, 0, 0}));
  CHECK(write({1, 2, 3}) == request({0x27, 0x40, 0x60, 0x00, 1, 2, 3, 0}));
  CHECK(write({1, 2, 3, 4}) == request({0x23, 0x40, 0x60, 0x00, 1, 2, 3, 4}));
}

TEST_CASE("A write in segments") {
  SdoClient client(5, kPatience);
  // command 1, not expedited, size said: 10 bytes
  CHECK(client.begin_write(kStore, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, kStart) ==
        request({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0}));
  // command 0, toggle 0, full, more to come
  CHECK(client.on_frame(answer({0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0}), kStart) == request({0x00, 0, 1, 2, 3, 4, 5, 6}));
  // answer 1, toggle 0; then toggle 0x10, 4 of 7 empty: 4 << 1, no more: 1
  CHECK(client.on_frame(answer({0x20, 0, 0, 0, 0, 0, 0, 0}), kStart) == request({0x19, 7, 8, 9, 0, 0, 0, 0}));
  CHECK_FALSE(client.outcome());
  CHECK_FALSE(client.on_frame(answer({0x30, 0, 0, 0, 0, 0, 0, 0}), kStart));
  check_done(client, kStore, {});
}

TEST_CASE("A write of a multiple of seven bytes ends with a full segment") {
  SdoClient client = writing(ObjectBytes(14, 9));
  CHECK(client.on_frame(answer({0x20, 0, 0, 0, 0, 0, 0, 0}), kStart) == request({0x11, 9, 9, 9, 9, 9, 9, 9}));
  CHECK_FALSE(client.on_frame(answer({0x30, 0, 0, 0, 0, 0, 0, 0}), kStart));
  check_done(client, kStore, {});
}

TEST_CASE("A value of no byte, and one of too many, is not written") {
  SdoClient client(5, kPatience);
  CHECK_THROWS_AS(client.begin_write(kStore, {}, kStart), std::length_error);
  CHECK_THROWS_AS(client.begin_write(kStore, ObjectBytes(kMaxSdoBytes + 1), kStart), std::length_error);
  CHECK_FALSE(client.on_time(kStart + 1h));
}

TEST_CASE("The node aborts") {
  SECTION("a read: object does not exist, 0x06020000 low byte first") {
    SdoClient client(5, kPatience);
    client.begin_read(kStatusword, kStart);
    CHECK_FALSE(client.on_frame(answer({0x80, 0x41, 0x60, 0x00, 0x00, 0x00, 0x02, 0x06}), kStart));
    check_aborted(client, SdoAbort::no_object, true);
    CHECK(client.outcome()->object == kStatusword);
  }
  SECTION("a write, in the midst of its segments") {
    SdoClient client = writing(ObjectBytes(20));
    CHECK_FALSE(client.on_frame(answer({0x80, 0x00, 0x20, 0x01, 0x22, 0x00, 0x00, 0x08}), kStart));
    check_aborted(client, SdoAbort::not_in_this_state, true);
  }
  SECTION("with a code that CiA 301 does not have") {
    SdoClient client(5, kPatience);
    client.begin_read(kStatusword, kStart);
    client.on_frame(answer({0x80, 0x41, 0x60, 0x00, 0x78, 0x56, 0x34, 0x12}), kStart);
    check_aborted(client, static_cast<SdoAbort>(0x12345678), true);
    CHECK(describe(*client.outcome()->abort) == "unknown abort code");
  }
}

TEST_CASE("A wrong toggle bit ends the transfer") {
  SECTION("of a read's first segment") {
    SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}));
    CHECK(client.on_frame(answer({0x10, 1, 2, 3, 4, 5, 6, 7}), kStart) == abort_of(kName, 0x05030000));
    check_aborted(client, SdoAbort::toggle_bit, false);
  }
  SECTION("of a read's second: the first once more") {
    SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}));
    CHECK(client.on_frame(answer({0x00, 1, 2, 3, 4, 5, 6, 7}), kStart) == kToggledSegmentRequest);
    CHECK(client.on_frame(answer({0x00, 1, 2, 3, 4, 5, 6, 7}), kStart) == abort_of(kName, 0x05030000));
    check_aborted(client, SdoAbort::toggle_bit, false);
  }
  SECTION("of a write's answer") {
    SdoClient client = writing(ObjectBytes(20));
    CHECK(client.on_frame(answer({0x30, 0, 0, 0, 0, 0, 0, 0}), kStart) == abort_of(kStore, 0x05030000));
    check_aborted(client, SdoAbort::toggle_bit, false);
  }
}

TEST_CASE("What comes must have the size that was announced") {
  SECTION("one byte more") {
    SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 6, 0, 0, 0}));
    CHECK(client.on_frame(answer({0x01, 1, 2, 3, 4, 5, 6, 7}), kStart) == abort_of(kName, 0x06070012));
    check_aborted(client, SdoAbort::too_long, false);
  }
  SECTION("one byte less") {
    SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 8, 0, 0, 0}));
    CHECK(client.on_frame(answer({0x01, 1, 2, 3, 4, 5, 6, 7}), kStart) == abort_of(kName, 0x06070013));
    check_aborted(client, SdoAbort::too_short, false);
  }
  SECTION("none were announced") {
    SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
    CHECK(client.on_frame(answer({0x0d, 1, 0, 0, 0, 0, 0, 0}), kStart) == abort_of(kName, 0x06070012));
  }
}

TEST_CASE("More than is taken is refused") {
  SECTION("as soon as it is announced: 1025 = 0x401, or 4 GB") {
    for (const auto& first : {answer({0x41, 0x08, 0x10, 0x00, 0x01, 0x04, 0, 0}),
                              answer({0x41, 0x08, 0x10, 0x00, 0xff, 0xff, 0xff, 0xff})}) {
      SdoClient client(5, kPatience);
      client.begin_read(kName, kStart);
      CHECK(client.on_frame(first, kStart) == abort_of(kName, 0x05040005));
      check_aborted(client, SdoAbort::out_of_memory, false);
    }
  }
  SECTION("as soon as it has come: 1024 = 146 * 7 + 2") {
    SdoClient client = reading(answer({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
    Frame segment = answer({0x00, 1, 2, 3, 4, 5, 6, 7});
    for (int i = 0; i < 146; ++i) {
      REQUIRE(client.on_frame(segment, kStart) == (i % 2 == 0 ? kToggledSegmentRequest : kSegmentRequest));
      segment.data[0] ^= 0x10;
    }
    CHECK(client.on_frame(segment, kStart) == abort_of(kName, 0x05040005));
    check_aborted(client, SdoAbort::out_of_memory, false);
  }
}

TEST_CASE("Segments without a byte do not go on for ever") {
  SdoClient client = reading(answer({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  CHECK(client.on_frame(answer({0x0e, 0, 0, 0, 0, 0, 0, 0}), kStart) == abort_of(kName, 0x06070013));
  check_aborted(client, SdoAbort::too_short, false);
}

TEST_CASE("Frames that are not this transfer's change nothing") {
  SdoClient client(5, kPatience);
  client.begin_read(kStatusword, kStart);
  const std::vector<Frame> strangers{
      frame_of(0x586, {0x4b, 0x41, 0x60, 0x00, 1, 2, 0, 0}),  // node 6
      frame_of(0x605, {0x4b, 0x41, 0x60, 0x00, 1, 2, 0, 0}),  // a request
      frame_of(0x585, {0x4b, 0x41, 0x60, 0x00, 1, 2, 0}),     // seven bytes
      frame_of(0x585, {}),
      answer({0x4b, 0x40, 0x60, 0x00, 1, 2, 0, 0}),              // another index
      answer({0x4b, 0x41, 0x60, 0x01, 1, 2, 0, 0}),              // another sub-index
      answer({0x80, 0x40, 0x60, 0x00, 0x00, 0x00, 0x02, 0x06}),  // an abort for another object
      answer({0x60, 0x41, 0x60, 0x00, 0, 0, 0, 0}),              // to a write
      answer({0x00, 1, 2, 3, 4, 5, 6, 7}),                       // a segment
      answer({0x20, 0, 0, 0, 0, 0, 0, 0}),                       // to a segment
      answer({0xc2, 0x41, 0x60, 0x00, 1, 0, 0, 0}),              // of a block transfer
  };
  for (const Frame& frame : strangers) {
    INFO(frame);
    CHECK_FALSE(client.on_frame(frame, kStart + 49ms));
    CHECK_FALSE(client.outcome());
  }
  CHECK(client.deadline() == kStart + kPatience);  // nor do they keep it waiting
  client.on_frame(answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}), kStart + 49ms);
  check_done(client, kStatusword, {0x37, 0x02});
}

TEST_CASE("Nor do they in a write, of either kind") {
  const std::vector<Frame> strangers{
      answer({0x60, 0x00, 0x20, 0x02, 0, 0, 0, 0}),              // another sub-index
      answer({0x80, 0x00, 0x20, 0x02, 0x00, 0x00, 0x02, 0x06}),  // an abort for it
      answer({0x4b, 0x00, 0x20, 0x01, 1, 2, 0, 0}),              // to a read
      answer({0x10, 1, 2, 3, 4, 5, 6, 7}),                       // a segment that was read
      frame_of(0x585, {0x60, 0x00, 0x20, 0x01}),                 // four bytes
  };
  SdoClient in_one_frame(5, kPatience);
  in_one_frame.begin_write(kStore, {1, 2}, kStart);
  SdoClient in_segments = writing(ObjectBytes(5));
  for (const Frame& frame : strangers) {
    INFO(frame);
    CHECK_FALSE(in_one_frame.on_frame(frame, kStart));
    CHECK_FALSE(in_one_frame.outcome());
    CHECK_FALSE(in_segments.on_frame(frame, kStart));
    CHECK_FALSE(in_segments.outcome());
  }
  in_one_frame.on_frame(answer({0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0}), kStart);
  check_done(in_one_frame, kStore, {});
  in_segments.on_frame(answer({0x20, 0, 0, 0, 0, 0, 0, 0}), kStart);
  check_done(in_segments, kStore, {});
}

TEST_CASE("Nothing is answered where nothing was asked") {
  SdoClient client(5, kPatience);
  CHECK_FALSE(client.on_frame(answer({0x4b, 0x41, 0x60, 0x00, 1, 2, 0, 0}), kStart));
  CHECK_FALSE(client.on_frame(answer({0x00, 1, 2, 3, 4, 5, 6, 7}), kStart));
  CHECK_FALSE(client.on_time(kStart + 1h));
  CHECK_FALSE(client.outcome());
}

TEST_CASE("Patience is for each answer") {
  SdoClient client(5, kPatience);
  client.begin_read(kName, kStart);
  CHECK_FALSE(client.on_time(kStart + 50ms - 1ns));
  client.on_frame(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}), kStart + 40ms);
  CHECK(client.deadline() == kStart + 90ms);
  CHECK_FALSE(client.on_time(kStart + 90ms - 1ns));
  CHECK(client.on_time(kStart + 90ms) == abort_of(kName, 0x05040000));
  check_aborted(client, SdoAbort::timed_out, false);
  CHECK_FALSE(client.on_time(kStart + 1h));  // once
}

TEST_CASE("An answer after the time is over changes nothing") {
  SdoClient client(5, kPatience);
  client.begin_read(kStatusword, kStart);
  CHECK(client.on_time(kStart + 60ms));
  CHECK_FALSE(client.on_frame(answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}), kStart + 61ms));
  check_aborted(client, SdoAbort::timed_out, false);
}

TEST_CASE("Late answers do not disturb the transfer after theirs") {
  SdoClient client(5, kPatience);
  SECTION("of a read of the same object, in a write") {
    client.begin_read(kControlword, kStart);
    client.on_time(kStart + 50ms);
    client.begin_write(kControlword, {0x0f, 0x00}, kStart + 51ms);
    CHECK_FALSE(client.on_frame(answer({0x4b, 0x40, 0x60, 0x00, 0x37, 0x02, 0, 0}), kStart + 52ms));
    CHECK_FALSE(client.outcome());
    client.on_frame(answer({0x60, 0x40, 0x60, 0x00, 0, 0, 0, 0}), kStart + 53ms);
    check_done(client, kControlword, {});
  }
  SECTION("a segment, in a read in one frame") {
    client = reading(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}));
    client.on_time(kStart + 50ms);
    client.begin_read(kStatusword, kStart + 51ms);
    CHECK_FALSE(client.on_frame(answer({0x00, 1, 2, 3, 4, 5, 6, 7}), kStart + 52ms));
    client.on_frame(answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}), kStart + 53ms);
    check_done(client, kStatusword, {0x37, 0x02});
  }
  SECTION("the first frame of a read in segments that was asked for twice") {
    client.begin_read(kName, kStart);
    client.on_time(kStart + 50ms);
    client.begin_read(kName, kStart + 51ms);
    const Frame first = answer({0x41, 0x08, 0x10, 0x00, 3, 0, 0, 0});
    CHECK(client.on_frame(first, kStart + 52ms) == kSegmentRequest);
    CHECK_FALSE(client.on_frame(first, kStart + 53ms));
    client.on_frame(answer({0x09, 'a', 'b', 'c', 0, 0, 0, 0}), kStart + 54ms);
    check_done(client, kName, {'a', 'b', 'c'});
  }
}

TEST_CASE("A new transfer over an old one forgets it") {
  SdoClient client = reading(answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}));
  CHECK(client.on_frame(answer({0x00, 1, 2, 3, 4, 5, 6, 7}), kStart) == kToggledSegmentRequest);
  CHECK(client.begin_read(kName, kStart + 20ms) == request({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  CHECK(client.deadline() == kStart + 70ms);
  // size not said this time, toggle from 0, and none of the old bytes
  CHECK(client.on_frame(answer({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}), kStart + 21ms) == kSegmentRequest);
  CHECK_FALSE(client.on_frame(answer({0x0b, 'x', 'y', 0, 0, 0, 0, 0}), kStart + 22ms));
  check_done(client, kName, {'x', 'y'});
}

TEST_CASE("Abort codes have the words of CiA 301") {
  CHECK(describe(SdoAbort::toggle_bit) == "toggle bit not alternated");
  CHECK(describe(SdoAbort::timed_out) == "SDO protocol timed out");
  CHECK(describe(SdoAbort::no_object) == "object does not exist in the object dictionary");
  CHECK(describe(SdoAbort::read_only) == "attempt to write a read only object");
  CHECK(describe(SdoAbort::no_sub_index) == "sub-index does not exist");
  CHECK(describe(static_cast<SdoAbort>(0x06060000)) == "access failed due to a hardware error");
}
