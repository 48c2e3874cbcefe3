#include <catch2/catch.hpp>
#include <stdexcept>

#include "can/canopen/device.hpp"
#include "can/canopen/object.hpp"

using namespace kenaf::canopen;

TEST_CASE("An object's address is written as index and sub-index") {
  CHECK(to_string(ObjectAddress{0x6040, 0}) == "0x6040:00");
  CHECK(to_string(ObjectAddress{0x1018, 4}) == "0x1018:04");
  CHECK(to_string(ObjectAddress{0x0005, 0xfe}) == "0x0005:fe");
}

TEST_CASE("Numbers become their type's bytes, lowest first") {
  CHECK(encode_number(ObjectType::unsigned8, 255) == ObjectBytes{0xff});
  CHECK(encode_number(ObjectType::unsigned16, 0x1234) == ObjectBytes{0x34, 0x12});
  CHECK(encode_number(ObjectType::unsigned32, 0xdeadbeef) == ObjectBytes{0xef, 0xbe, 0xad, 0xde});
  CHECK(encode_number(ObjectType::integer8, -1) == ObjectBytes{0xff});
  CHECK(encode_number(ObjectType::integer16, -2) == ObjectBytes{0xfe, 0xff});
  CHECK(encode_number(ObjectType::integer32, -1000) ==
        ObjectBytes{0x18, 0xfc, 0xff, 0xff});  // 2^32 - 1000 = 0xfffffc18
}

TEST_CASE("Bytes become their type's number") {
  CHECK(decode_number(ObjectType::unsigned8, ObjectBytes{0xff}) == 255);
  CHECK(decode_number(ObjectType::integer8, ObjectBytes{0xff}) == -1);
  CHECK(decode_number(ObjectType::unsigned16, ObjectBytes{0x00, 0x80}) == 32768);
  CHECK(decode_number(ObjectType::integer16, ObjectBytes{0x00, 0x80}) == -32768);
  CHECK(decode_number(ObjectType::unsigned32, ObjectBytes{0xff, 0xff, 0xff, 0xff}) == 4294967295);
  CHECK(decode_number(ObjectType::integer32, ObjectBytes{0xff, 0xff, 0xff, 0xff}) == -1);
}

TEST_CASE("A number at each end of its type fits, and one beyond does not") {
  struct Range {
    ObjectType type;
    std::int64_t min, max;
  };
  for (const Range& range :
       {Range{ObjectType::unsigned8, 0, 255}, Range{ObjectType::unsigned16, 0, 65535},
        Range{ObjectType::unsigned32, 0, 4294967295}, Range{ObjectType::integer8, -128, 127},
        Range{ObjectType::integer16, -32768, 32767}, Range{ObjectType::integer32, -2147483648LL, 2147483647}}) {
    for (const std::int64_t value : {range.min, range.max})
      CHECK(decode_number(range.type, encode_number(range.type, value)) == value);
    CHECK_THROWS_AS(encode_number(range.type, range.min - 1), std::out_of_range);
    CHECK_THROWS_AS(encode_number(range.type, range.max + 1), std::out_of_range);
  }
  CHECK_THROWS_WITH(encode_number(ObjectType::integer8, 200), "200 does not fit in 8 bits with sign (-128 to 127)");
  CHECK_THROWS_WITH(encode_number(ObjectType::unsigned16, -1), "-1 does not fit in 16 bits without sign (0 to 65535)");
}

TEST_CASE("Sizes of types") {
  CHECK(byte_count(ObjectType::unsigned8) == 1);
  CHECK(byte_count(ObjectType::integer16) == 2);
  CHECK(byte_count(ObjectType::unsigned32) == 4);
  CHECK(byte_count(ObjectType::text) == 0);
  CHECK(is_signed(ObjectType::integer8));
  CHECK_FALSE(is_signed(ObjectType::unsigned8));
}

TEST_CASE("A device's profile and a consumer heartbeat entry") {
  CHECK(profile_of(0x00020192) == kProfileDrive);         // 0x192 = 402; bit 17: a servo drive
  CHECK(profile_of(0x0002019a) == kProfileInclinometer);  // 0x19a = 410
  CHECK(consumer_heartbeat(127, 100) == 0x007f0064);      // node 0x7f, 0x64 ms
}
