// The server's frames, byte by byte as CiA 301, 7.2.4.3 has them. It is node 5: requests 0x605, answers 0x585.
#include <catch2/catch.hpp>
#include <map>
#include <utility>
#include <vector>

#include "can/canopen/sdo_server.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;

namespace {

// A node whose objects are what the test says, and that writes down what is written to it.
struct Node {
  std::map<ObjectAddress, ObjectBytes> objects;
  std::vector<std::pair<ObjectAddress, ObjectBytes>> written;
  std::optional<SdoAbort> refuses;
  SdoServer server{5,
                   {.read = [this](ObjectAddress object) -> std::variant<ObjectBytes, SdoAbort> {
                      const auto found = objects.find(object);
                      if (found == objects.end()) return SdoAbort::no_object;
                      return found->second;
                    },
                    .write =
                        [this](ObjectAddress object, std::span<const std::uint8_t> value) {
                          if (!refuses) written.emplace_back(object, ObjectBytes(value.begin(), value.end()));
                          return refuses;
                        }}};
  Node() = default;
  Node(const Node&) = delete;

  std::optional<Frame> operator()(std::initializer_list<std::uint8_t> bytes) { return server.on_frame(request(bytes)); }
};

using Writes = std::vector<std::pair<ObjectAddress, ObjectBytes>>;

}  // namespace

TEST_CASE("A value of one to four bytes is read in one frame") {
  Node node;
  const auto read = [&](const ObjectBytes& value) {
    node.objects[{0x6041, 0}] = value;
    return node({0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0});
  };
  // answer 2: 0x40, expedited 2, size said 1, empty bytes << 2
  CHECK(read({0x37}) == answer({0x4f, 0x41, 0x60, 0x00, 0x37, 0, 0, 0}));
  CHECK(read({0x37, 0x02}) == answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}));
  CHECK(read({1, 2, 3}) == answer({0x47, 0x41, 0x60, 0x00, 1, 2, 3, 0}));
  CHECK(read({1, 2, 3, 4}) == answer({0x43, 0x41, 0x60, 0x00, 1, 2, 3, 4}));
}

TEST_CASE("A longer value is read in segments") {
  Node node;
  node.objects[{0x1008, 0}] = {'K', 'e', 'n', 'a', 'f', ' ', 'd', 'r', 'i', 'v', 'e'};
  CHECK(node({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}) == answer({0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0}));
  CHECK(node({0x60, 0, 0, 0, 0, 0, 0, 0}) == answer({0x00, 'K', 'e', 'n', 'a', 'f', ' ', 'd'}));
  CHECK(node({0x70, 0, 0, 0, 0, 0, 0, 0}) == answer({0x17, 'r', 'i', 'v', 'e', 0, 0, 0}));  // toggle, 3 empty, last
  // and then there is nothing left to ask for: command specifier not valid, 0x05040001
  CHECK(node({0x60, 0, 0, 0, 0, 0, 0, 0}) == answer({0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
}

TEST_CASE("An empty value is read as a last segment without a byte") {
  Node node;
  node.objects[{0x1008, 0}] = {};
  CHECK(node({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}) == answer({0x41, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  CHECK(node({0x60, 0, 0, 0, 0, 0, 0, 0}) == answer({0x0f, 0, 0, 0, 0, 0, 0, 0}));
}

TEST_CASE("A write of each size in one frame is one write") {
  Node node;
  const Frame done = answer({0x60, 0x40, 0x60, 0x00, 0, 0, 0, 0});  // answer 3
  CHECK(node({0x2f, 0x40, 0x60, 0x00, 1, 0, 0, 0}) == done);
  CHECK(node({0x2b, 0x40, 0x60, 0x00, 1, 2, 0, 0}) == done);
  CHECK(node({0x27, 0x40, 0x60, 0x00, 1, 2, 3, 0}) == done);
  CHECK(node({0x23, 0x40, 0x60, 0x00, 1, 2, 3, 4}) == done);
  CHECK(node({0x22, 0x40, 0x60, 0x00, 1, 2, 3, 4}) == done);  // size not said: all four
  const ObjectAddress controlword{0x6040, 0};
  CHECK(node.written == Writes{{controlword, {1}},
                               {controlword, {1, 2}},
                               {controlword, {1, 2, 3}},
                               {controlword, {1, 2, 3, 4}},
                               {controlword, {1, 2, 3, 4}}});
}

TEST_CASE("A write in segments is one write") {
  Node node;
  CHECK(node({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0}) == answer({0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0}));
  CHECK(node({0x00, 0, 1, 2, 3, 4, 5, 6}) == answer({0x20, 0, 0, 0, 0, 0, 0, 0}));
  CHECK(node.written.empty());
  CHECK(node({0x19, 7, 8, 9, 0, 0, 0, 0}) == answer({0x30, 0, 0, 0, 0, 0, 0, 0}));  // toggle, 4 empty, last
  CHECK(node.written == Writes{{{0x2000, 1}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}});
}

TEST_CASE("A write in segments whose size is not said") {
  Node node;
  CHECK(node({0x20, 0x00, 0x20, 0x01, 0, 0, 0, 0}) == answer({0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0}));
  CHECK(node({0x0b, 8, 9, 0, 0, 0, 0, 0}) == answer({0x20, 0, 0, 0, 0, 0, 0, 0}));  // 5 empty, last
  CHECK(node.written == Writes{{{0x2000, 1}, {8, 9}}});
}

TEST_CASE("What the objects refuse, the answer says") {
  Node node;
  CHECK(node({0x40, 0x34, 0x12, 0x07, 0, 0, 0, 0}) == answer({0x80, 0x34, 0x12, 0x07, 0x00, 0x00, 0x02, 0x06}));
  node.refuses = SdoAbort::value_too_high;  // 0x06090031
  CHECK(node({0x2f, 0x60, 0x60, 0x00, 99, 0, 0, 0}) == answer({0x80, 0x60, 0x60, 0x00, 0x31, 0x00, 0x09, 0x06}));
  node({0x21, 0x00, 0x20, 0x01, 5, 0, 0, 0});
  CHECK(node({0x05, 1, 2, 3, 4, 5, 0, 0}) == answer({0x80, 0x00, 0x20, 0x01, 0x31, 0x00, 0x09, 0x06}));
}

TEST_CASE("A wrong toggle bit ends the server's transfer") {
  Node node;
  SECTION("of a read: the first request once more") {
    node.objects[{0x1008, 0}] = ObjectBytes(20);
    node({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0});
    node({0x60, 0, 0, 0, 0, 0, 0, 0});
    CHECK(node({0x60, 0, 0, 0, 0, 0, 0, 0}) == answer({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
    // it has ended: the right one has no transfer any more
    CHECK(node({0x70, 0, 0, 0, 0, 0, 0, 0}) == answer({0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
  }
  SECTION("of a write: the first segment must have 0") {
    node({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0});
    CHECK(node({0x10, 0, 1, 2, 3, 4, 5, 6}) == answer({0x80, 0x00, 0x20, 0x01, 0x00, 0x00, 0x03, 0x05}));
    CHECK(node.written.empty());
  }
}

TEST_CASE("A write must have the size that was announced") {
  Node node;
  node({0x21, 0x00, 0x20, 0x01, 6, 0, 0, 0});
  SECTION("one byte more") {
    CHECK(node({0x01, 0, 1, 2, 3, 4, 5, 6}) == answer({0x80, 0x00, 0x20, 0x01, 0x12, 0x00, 0x07, 0x06}));
  }
  SECTION("one byte less") {
    CHECK(node({0x05, 0, 1, 2, 3, 4, 0, 0}) == answer({0x80, 0x00, 0x20, 0x01, 0x13, 0x00, 0x07, 0x06}));
  }
  CHECK(node.written.empty());
}

TEST_CASE("The server takes and gives no more than it says") {
  Node node;
  SECTION("announced: 1025 = 0x401") {
    CHECK(node({0x21, 0x00, 0x20, 0x01, 0x01, 0x04, 0, 0}) == answer({0x80, 0x00, 0x20, 0x01, 0x05, 0x00, 0x04, 0x05}));
  }
  SECTION("come: 1024 = 146 * 7 + 2") {
    node({0x20, 0x00, 0x20, 0x01, 0, 0, 0, 0});
    Frame segment = request({0x00, 1, 2, 3, 4, 5, 6, 7});
    for (int i = 0; i < 146; ++i) {
      const std::optional<Frame> taken = node.server.on_frame(segment);
      REQUIRE(taken);
      REQUIRE(taken->data[0] == (0x20 | segment.data[0]));
      segment.data[0] ^= 0x10;
    }
    CHECK(node.server.on_frame(segment) == answer({0x80, 0x00, 0x20, 0x01, 0x05, 0x00, 0x04, 0x05}));
  }
  SECTION("to be read") {
    node.objects[{0x1008, 0}] = ObjectBytes(1025);
    CHECK(node({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}) == answer({0x80, 0x08, 0x10, 0x00, 0x05, 0x00, 0x04, 0x05}));
  }
  CHECK(node.written.empty());
}

TEST_CASE("Block transfers and command 7 are refused: command specifier not valid") {
  Node node;
  for (const std::uint8_t command : std::initializer_list<std::uint8_t>{0xa4, 0xc6, 0xe0})
    CHECK(node({command, 0x08, 0x10, 0x00, 0x7f, 0, 0, 0}) == answer({0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
}

TEST_CASE("A segment of the other direction ends the transfer") {
  Node node;
  node.objects[{0x1008, 0}] = ObjectBytes(20);
  node({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0});
  CHECK(node({0x00, 0, 1, 2, 3, 4, 5, 6}) == answer({0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
  node({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0});
  CHECK(node({0x60, 0, 0, 0, 0, 0, 0, 0}) == answer({0x80, 0x00, 0x20, 0x01, 0x01, 0x00, 0x04, 0x05}));
  CHECK(node.written.empty());
}

TEST_CASE("What is no request to this node has no answer") {
  Node node;
  CHECK_FALSE(node.server.on_frame(frame_of(0x606, {0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0})));
  CHECK_FALSE(node.server.on_frame(frame_of(0x585, {0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0})));
  CHECK_FALSE(node.server.on_frame(frame_of(0x605, {0x40, 0x41, 0x60, 0x00})));
  CHECK_FALSE(node.server.on_frame(frame_of(0x605, {})));
}

TEST_CASE("The client's abort ends the transfer and has no answer") {
  Node node;
  node({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0});
  node({0x00, 0, 1, 2, 3, 4, 5, 6});
  CHECK_FALSE(node({0x80, 0x00, 0x20, 0x01, 0x00, 0x00, 0x04, 0x05}));
  CHECK(node({0x19, 7, 8, 9, 0, 0, 0, 0}) == answer({0x80, 0x00, 0x20, 0x01, 0x01, 0x00, 0x04, 0x05}));
  CHECK(node.written.empty());
}

TEST_CASE("A new transfer ends the one before it") {
  Node node;
  node.objects[{0x6041, 0}] = {0x37, 0x02};
  node({0x21, 0x00, 0x20, 0x01, 10, 0, 0, 0});
  node({0x00, 0, 1, 2, 3, 4, 5, 6});
  SECTION("a read in between") {
    CHECK(node({0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0}) == answer({0x4b, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}));
    CHECK(node({0x19, 7, 8, 9, 0, 0, 0, 0}) == answer({0x80, 0x41, 0x60, 0x00, 0x01, 0x00, 0x04, 0x05}));
    CHECK(node.written.empty());
  }
  SECTION("the same write anew: none of the old bytes, toggle from 0") {
    node({0x20, 0x00, 0x20, 0x01, 0, 0, 0, 0});
    CHECK(node({0x0d, 42, 0, 0, 0, 0, 0, 0}) == answer({0x20, 0, 0, 0, 0, 0, 0, 0}));  // 6 empty, last
    CHECK(node.written == Writes{{{0x2000, 1}, {42}}});
  }
}
