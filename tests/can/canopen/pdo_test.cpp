#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "can/canopen/device.hpp"
#include "can/canopen/drive.hpp"
#include "can/canopen/pdo.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;

namespace {

const Pdo kStatus{.direction = PdoDirection::transmit,
                  .number = 2,
                  .transmission = 1,
                  .objects = {object::statusword, object::position_actual, object::current_actual}};
const Pdo kCommand{
    .direction = PdoDirection::receive, .number = 1, .transmission = 1, .objects = {object::controlword, object::mode}};

struct Written {
  std::uint16_t index;
  std::uint8_t sub;
  ObjectType type;
  std::int64_t value;
};

void check_writes(const std::vector<SdoWrite>& writes, const std::vector<Written>& expected) {
  REQUIRE(writes.size() == expected.size());
  for (std::size_t i = 0; i < writes.size(); ++i) {
    INFO("write " << i << ": " << writes[i].purpose);
    CHECK(to_string(writes[i].object) == to_string(ObjectAddress{expected[i].index, expected[i].sub}));
    CHECK(writes[i].type == expected[i].type);
    CHECK(writes[i].value == expected[i].value);
  }
}

}  // namespace

TEST_CASE("A PDO's identifier is that of its number and node") {
  CHECK(cob_id(kStatus, 5) == 0x285);
  CHECK(cob_id(kCommand, 5) == 0x205);
  Pdo last = kStatus;
  last.number = 4;
  CHECK(cob_id(last, 127) == 0x4ff);
  last.direction = PdoDirection::receive;
  CHECK(cob_id(last, 127) == 0x57f);
}

TEST_CASE("A transmit PDO is switched off, mapped and switched on, in this order") {
  // CiA 301, 7.5.2.38. Mapping: index in bits 16 to 31, sub-index in 8 to 15, bits of the object in 0 to 7.
  const std::vector<Written> expected{
      {0x1801, 1, ObjectType::unsigned32, 0xc0000285},  // invalid, no remote request
      {0x1801, 2, ObjectType::unsigned8, 1},            // at each SYNC
      {0x1a01, 0, ObjectType::unsigned8, 0},            // nothing mapped
      {0x1a01, 1, ObjectType::unsigned32, 0x60410010},  // statusword, 16 bits
      {0x1a01, 2, ObjectType::unsigned32, 0x60640020},  // position, 32 bits
      {0x1a01, 3, ObjectType::unsigned32, 0x60780010},  // current, 16 bits
      {0x1a01, 0, ObjectType::unsigned8, 3},            // three mapped
      {0x1801, 1, ObjectType::unsigned32, 0x40000285},  // valid
  };
  check_writes(configuration_of(kStatus, 5), expected);
}

TEST_CASE("A receive PDO likewise, without the bit that it does not have") {
  // CiA 301, 7.5.2.36; bit 30 is reserved in 0x1400.
  const std::vector<Written> expected{
      {0x1400, 1, ObjectType::unsigned32, 0x80000211},  // invalid
      {0x1400, 2, ObjectType::unsigned8, 1},            // acts at the next SYNC
      {0x1600, 0, ObjectType::unsigned8, 0},            // nothing mapped
      {0x1600, 1, ObjectType::unsigned32, 0x60400010},  // controlword, 16 bits
      {0x1600, 2, ObjectType::unsigned32, 0x60600008},  // mode, 8 bits
      {0x1600, 0, ObjectType::unsigned8, 2},            // two mapped
      {0x1400, 1, ObjectType::unsigned32, 0x00000211},  // valid
  };
  check_writes(configuration_of(kCommand, 0x11), expected);
}

TEST_CASE("A sub-index is mapped with its object") {
  const Pdo pdo{PdoDirection::transmit, 3, 255, {object::position_limit_max}};
  CHECK(configuration_of(pdo, 1).at(3).value == 0x607d0220);
}

TEST_CASE("Every write says what it is for") {
  const std::vector<SdoWrite> writes = configuration_of(kStatus, 5);
  CHECK(writes.at(0).purpose == "switching TPDO2 off");
  CHECK(writes.at(4).purpose == "mapping of 0x6064:00 in TPDO2");
  for (const SdoWrite& write : writes) CHECK(write.purpose.find("TPDO2") != std::string::npos);
  CHECK(configuration_of(kCommand, 5).back().purpose == "switching RPDO1 on");
}

TEST_CASE("Values are packed in the order of the mapping, without gaps") {
  CHECK(byte_count(kStatus) == 8);
  const std::vector<std::int64_t> values{0x0637, -1000, -3};
  const Frame frame = frame_of(0x285, {0x37, 0x06,              // statusword
                                       0x18, 0xfc, 0xff, 0xff,  // 2^32 - 1000
                                       0xfd, 0xff});            // 2^16 - 3
  CHECK(pack(kStatus, 5, values) == frame);

  std::vector<std::int64_t> read(3);
  REQUIRE(unpack(kStatus, frame, read));
  CHECK(read == values);
}

TEST_CASE("Without a sign the same bits are a large number") {
  const Pdo pdo{PdoDirection::transmit, 1, 1, {object::mode_display, object::error_register, object::statusword}};
  std::vector<std::int64_t> read(3);
  REQUIRE(unpack(pdo, frame_of(0x181, {0xff, 0xff, 0xff, 0xff}), read));
  CHECK(read == std::vector<std::int64_t>{-1, 255, 65535});
}

TEST_CASE("A frame of another length changes nothing") {
  std::vector<std::int64_t> values{1, 2};
  CHECK_FALSE(unpack(kCommand, frame_of(0x205, {0x0f, 0x00}), values));              // short of the mode
  CHECK_FALSE(unpack(kCommand, frame_of(0x205, {0x0f, 0x00, 0x08, 0x00}), values));  // one too many
  CHECK_FALSE(unpack(kCommand, frame_of(0x205, {}), values));
  CHECK(values == std::vector<std::int64_t>{1, 2});
  CHECK(unpack(kCommand, frame_of(0x205, {0x0f, 0x00, 0x08}), values));
  CHECK(values == std::vector<std::int64_t>{15, 8});
}

TEST_CASE("A value beyond its type is not packed") {
  CHECK_THROWS_AS(pack(kCommand, 5, std::vector<std::int64_t>{0x10000, 8}), std::out_of_range);
  CHECK_THROWS_AS(pack(kCommand, 5, std::vector<std::int64_t>{15, 128}), std::out_of_range);
  CHECK(pack(kCommand, 5, std::vector<std::int64_t>{15, -128}) == frame_of(0x205, {0x0f, 0x00, 0x80}));
}

TEST_CASE("An inclinometer's slopes are signed") {
  const Pdo slopes{PdoDirection::transmit, 1, 1, {object::slope_longitudinal, object::slope_lateral}};
  std::vector<std::int64_t> read(2);
  REQUIRE(unpack(slopes, frame_of(0x190, {0x9c, 0xff, 0x64, 0x00}), read));
  CHECK(read == std::vector<std::int64_t>{-100, 100});
}
