// Numbers of messages by path, from payloads made byte by byte. Offsets beside the bytes count from behind the head of
// CDR, from which alignment counts.
#include <catch2/catch.hpp>
#include <map>

#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/payload_fields.hpp"
#include "gap/recordings/recording_error.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf::gap::recordings;
using namespace kenaf::test;

namespace {

const std::string kLittle("\0\1\0\0", 4), kBig("\0\0\0\0", 4);

MessageReader reader(const std::string& definition, const std::string& encoding = "cdr") {
  return MessageReader({"/topic", "pkg/msg/Made", encoding, encoding == "cdr" ? "ros2msg" : "ros1msg", definition, 1},
                       {});
}

double value_at(const MessageReader& reader, const std::string& message, const std::string& path) {
  const FieldPath steps = parse_field_path(path);
  INFO(path);
  REQUIRE(reader.wrong_with(steps).empty());
  const auto found = reader.find(message, steps);
  REQUIRE(found);
  return found->value;
}

std::map<std::string, double> listed(const MessageReader& reader, const std::string& message) {
  std::map<std::string, double> all;
  reader.list(message, [&all](const std::string& path, const FieldValue& field) { all[path] = field.value; });
  return all;
}

const std::string kJointState =
    "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
    "================================================================================\nMSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

std::string joint_state() {
  return kLittle + u32(12) + u32(500000000) +             // 0: stamp
         u32(5) + "base\0"s + std::string(3, 'p') +       // 8: frame_id "base" of 5, pads 17 to 20
         u32(2) +                                         // 20: two names
         u32(2) + "l\0"s + "pp" +                         // 24: pads 30 to 32
         u32(6) + "right\0"s + "pp" +                     // 32: pads 42 to 44
         u32(2) + f64(1.5) + f64(-2.5) +                  // 44: length, then 48, a multiple of 8: no padding
         u32(2) + std::string(4, 'p') + f64(3) + f64(4);  // 64: length, pads 68 to 72
}

}  // namespace

TEST_CASE("Numbers of CDR lie at multiples of their size behind its head") {
  const MessageReader made = reader("bool a\nint16 b\nuint8 c\nfloat32 d\nint8 e\nfloat64 f\nint64 g\n");
  const std::string message = kLittle + "\1p"s + bytes_of<std::int16_t>(-3) +  // 0, 2
                              "\xFFppp"s + bytes_of(2.5F) +                    // 4, 8
                              "\xFFppp"s + f64(-0.125) +                       // 12, 16
                              bytes_of<std::int64_t>(-7);                      // 24
  CHECK(listed(made, message) == std::map<std::string, double>{
                                     {"a", 1}, {"b", -3}, {"c", 255}, {"d", 2.5}, {"e", -1}, {"f", -0.125}, {"g", -7}});
}

TEST_CASE("CDR in big endian is read by its head") {
  const std::string message = kBig + "\0\0\1\2"s + "pppp" + "\x3F\xF8\0\0\0\0\0\0"s;  // 258, pads 4 to 8, 1.5
  CHECK(listed(reader("uint32 a\nfloat64 b\n"), message) == std::map<std::string, double>{{"a", 258}, {"b", 1.5}});
}

TEST_CASE("A joint's number is found by its name, and carries the stamp of the header") {
  const MessageReader made = reader(kJointState);
  CHECK(value_at(made, joint_state(), "velocity[right]") == 4);
  CHECK(value_at(made, joint_state(), "position[l]") == 1.5);
  CHECK(value_at(made, joint_state(), "position[1]") == -2.5);
  CHECK(made.find(joint_state(), parse_field_path("velocity[l]"))->stamp_ns == 12500000000);
  CHECK_FALSE(made.find(joint_state(), parse_field_path("velocity[middle]")));
  CHECK_FALSE(made.find(joint_state(), parse_field_path("velocity[2]")));
  CHECK(listed(made, joint_state()).contains("velocity[right]"));
}

TEST_CASE("A transform is found by the frame that it leads to, with its own stamp") {
  const MessageReader tf({"/tf", "tf2_msgs/msg/TFMessage", "cdr", "", "", 1}, {});
  const auto transform = [](std::uint32_t sec, const std::string& child, double x, std::size_t at) {
    // header (8 + 4 + 2 "m"), padding to 4, child, padding to 8, 7 numbers; `at` is where it begins
    std::string bytes = u32(sec) + u32(0) + u32(2) + "m\0"s;
    bytes += std::string((4 - (at + bytes.size()) % 4) % 4, 'p') + u32(static_cast<std::uint32_t>(child.size() + 1)) +
             child + '\0';
    bytes += std::string((8 - (at + bytes.size()) % 8) % 8, 'p') + f64(x);
    for (int i = 0; i < 5; ++i) bytes += f64(0);
    return bytes + f64(1);
  };
  std::string message = u32(2);
  message += transform(5, "odom", 7, message.size());
  message += std::string((4 - message.size() % 4) % 4, 'p');
  message += transform(6, "base_link", 8, message.size());
  message = kLittle + message;
  CHECK(value_at(tf, message, "transforms[base_link].transform.translation.x") == 8);
  CHECK(tf.find(message, parse_field_path("transforms[base_link].transform.rotation.w"))->stamp_ns == 6000000000);
  CHECK(tf.find(message, parse_field_path("transforms[odom].transform.translation.x"))->stamp_ns == 5000000000);
  CHECK_FALSE(tf.find(message, parse_field_path("transforms[laser].transform.translation.x")));
  CHECK(listed(tf, message).at("transforms[base_link].transform.translation.x") == 8);
}

TEST_CASE("A driver's speed is found by its place in a feedback's list") {
  // As robots of Clearpath report it: two drivers of current, duty cycle, flag and measured velocity.
  const MessageReader feedback = reader(
      "std_msgs/Header header\nDriver[] drivers\n==========\nMSG: pkg/Driver\nfloat32 current\nfloat32 duty_cycle\n"
      "bool driver_fault\nfloat32 measured_velocity\n");
  const auto driver = [](float current, float velocity) {
    return bytes_of(current) + bytes_of(0.5F) + "\0ppp"s + bytes_of(velocity);  // 16 bytes, all at multiples of 4
  };
  const std::string message =
      kLittle + u32(7) + u32(0) + u32(1) + "\0ppp"s + u32(2) + driver(1.5F, -2) + driver(2.5F, 3);
  CHECK(value_at(feedback, message, "drivers[0].measured_velocity") == -2);
  CHECK(value_at(feedback, message, "drivers[1].measured_velocity") == 3);
  CHECK(value_at(feedback, message, "drivers[1].current") == 2.5);
  CHECK(feedback.find(message, parse_field_path("drivers[1].current"))->stamp_ns == 7000000000);
  CHECK_FALSE(feedback.find(message, parse_field_path("drivers[2].current")));
}

TEST_CASE("ROS 1 has no padding, its texts no zero, and its times are primitive") {
  const MessageReader made = reader(
      "Header header\ntime t\nduration d\nbyte b\nfloat64[2] pair\nint32 LIMIT=5\nstring TEXT=a # b\n"
      "================================================================================\nMSG: std_msgs/Header\n"
      "uint32 seq\ntime stamp\nstring frame_id\n",
      "ros1");
  const std::string message = u32(9) + u32(3) + u32(250000000) + sized("map") + u32(2) + u32(500000000) +
                              bytes_of<std::int32_t>(-1) + bytes_of<std::int32_t>(500000000) + "\xFE" + f64(1) + f64(2);
  CHECK(value_at(made, message, "t") == 2.5);
  CHECK(value_at(made, message, "d") == -0.5);
  CHECK(value_at(made, message, "b") == -2);
  CHECK(value_at(made, message, "pair[1]") == 2);
  CHECK(made.find(message, parse_field_path("b"))->stamp_ns == 3250000000);
}

TEST_CASE("A path is refused by the definition, with what is wrong") {
  const MessageReader made = reader(kJointState);
  CHECK(made.wrong_with(parse_field_path("speed")).find("has no field 'speed'") != std::string::npos);
  CHECK(made.wrong_with(parse_field_path("velocity")).find("is an array") != std::string::npos);
  CHECK(made.wrong_with(parse_field_path("header[0].stamp.sec")).find("is no array") != std::string::npos);
  CHECK(made.wrong_with(parse_field_path("header.frame_id")).find("is no number") != std::string::npos);
  CHECK(made.wrong_with(parse_field_path("header")).find("is no number") != std::string::npos);
  for (const char* text : {"", ".a", "a.", "a[", "a[]", "a]b", "a[1]b", "a..b"})
    CHECK_THROWS_AS(parse_field_path(text), RecordingError);
}

TEST_CASE("A message that ends before its definition does, at any byte, is refused") {
  const MessageReader made = reader(kJointState);
  const std::string whole = joint_state();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    REQUIRE_THROWS_AS(made.find(whole.substr(0, size), parse_field_path("velocity[1]")), RecordingError);
    REQUIRE_THROWS_AS(listed(made, whole.substr(0, size)), RecordingError);
  }
}

TEST_CASE("Lengths beyond the message are refused before anything is read or allocated") {
  const MessageReader numbers = reader("float64[] a\nfloat64 b\n");
  CHECK_THROWS_WITH(numbers.find(kLittle + u32(0xFFFFFFFF) + u32(0), parse_field_path("b")),
                    Catch::Contains("beyond its end"));
  const MessageReader nested = reader("Inner[] a\nfloat64 b\n================\nMSG: pkg/Inner\nfloat64 x\nstring s\n");
  CHECK_THROWS_WITH(nested.find(kLittle + u32(0xFFFFFFFF) + u32(0), parse_field_path("b")),
                    Catch::Contains("beyond its end"));
  // In ROS 1 empty messages have no bytes: any number of them is skipped at once.
  const MessageReader empty = reader("Empty[] a\nfloat64 b\n================\nMSG: pkg/Empty\n# nothing\n", "ros1");
  CHECK(value_at(empty, u32(0xFFFFFFFF) + f64(5), "b") == 5);
}

TEST_CASE("Definitions that depend on themselves, lie too deep or miss a type are refused") {
  CHECK_THROWS_WITH(reader("Made again\n"), Catch::Contains("depends on itself"));
  CHECK_THROWS_WITH(reader("A a\n==========\nMSG: pkg/A\nB b\n==========\nMSG: pkg/B\nA a\n"),
                    Catch::Contains("depends on itself"));
  std::string deep = "T0 t\n";
  for (int i = 0; i < 40; ++i)
    deep += "==========\nMSG: pkg/T" + std::to_string(i) + "\nT" + std::to_string(i + 1) + " t\n";
  CHECK_THROWS_WITH(reader(deep), Catch::Contains("levels deep"));
  CHECK_THROWS_WITH(reader("Missing m\n"), Catch::Contains("no definition of the type pkg/Missing"));
  CHECK_THROWS_WITH(reader("float64\n"), Catch::Contains("line 1"));
  CHECK_THROWS_WITH(reader("float64[0] a\n"), Catch::Contains("no size of an array"));
  CHECK_THROWS_WITH(reader("fl*at a\n"), Catch::Contains("no type of a field"));
}

TEST_CASE("Bounded texts and arrays, default values and comments are read as fields") {
  const MessageReader made =
      reader("string<=8 name \"a\" # c\nint32[<=3] list\nstring<=2[<=2] texts\nfloat32 gain 0.5\n");
  const std::string message = kLittle + u32(2) + "x\0"s + "pp" +  // 0, pads 6 to 8
                              u32(1) + u32(7) +                   // 8
                              u32(1) + u32(1) + "\0ppp"s +        // 16, one text, pads 25 to 28
                              bytes_of(0.25F);                    // 28
  CHECK(listed(made, message) == std::map<std::string, double>{{"gain", 0.25}, {"list[0]", 7}});
}

TEST_CASE("Encodings that are not supported are named") {
  const auto made = [](const std::string& encoding, const std::string& schema_encoding) {
    return MessageReader({"/t", "pkg/msg/T", encoding, schema_encoding, "float64 a\n", 1}, {});
  };
  CHECK_THROWS_WITH(made("cdr", "ros2idl"), Catch::Contains("IDL"));
  CHECK_THROWS_WITH(made("protobuf", "protobuf"), Catch::Contains("'protobuf'"));
  CHECK_THROWS_WITH(made("cdr", "omgidl"), Catch::Contains("'omgidl'"));
  CHECK_THROWS_WITH(MessageReader({"/t", "pkg/msg/T", "cdr", "", "", 1}, {}), Catch::Contains("--definitions"));
  const MessageReader plain = made("cdr", "ros2msg");
  CHECK_THROWS_WITH(plain.find("\0\7\0\0"s + f64(1), parse_field_path("a")), Catch::Contains("0x0007"));
  const MessageReader wide = reader("wstring w\nfloat64 a\n");
  CHECK_THROWS_WITH(wide.find(kLittle + u32(1) + "ab" + f64(1), parse_field_path("a")), Catch::Contains("wstring"));
}

TEST_CASE("JSON messages have the same paths") {
  const MessageReader json({"/t", "any", "json", "jsonschema", "{}", 1}, {});
  const std::string message =
      R"({"header":{"stamp":{"sec":3,"nanosec":5}},"name":["l","r"],"velocity":[1,2],"on":true,"none":null,)"
      R"("parts":[{"id":"a","x":4},{"id":"b","x":5}]})";
  CHECK(value_at(json, message, "velocity[r]") == 2);
  CHECK(value_at(json, message, "parts[b].x") == 5);
  CHECK(value_at(json, message, "parts[0].x") == 4);
  CHECK(value_at(json, message, "on") == 1);
  CHECK(json.find(message, parse_field_path("on"))->stamp_ns == 3000000005);
  CHECK_FALSE(json.find(message, parse_field_path("none")));
  CHECK_FALSE(json.find(message, parse_field_path("velocity")));
  CHECK_THROWS_AS(json.find("{", parse_field_path("on")), RecordingError);
  CHECK(listed(json, message).at("parts[a].x") == 4);
  CHECK(listed(json, std::string(100000, '[') + std::string(100000, ']')).empty());
}

TEST_CASE("Definitions with two fields of one name, or with a type that has no name, are refused") {
  CHECK_THROWS_WITH(reader("float64 a\nint8 a\n"), Catch::Contains("two fields 'a'"));
  CHECK_THROWS_WITH(reader("<=0 c\n"), Catch::Contains("no type of a field"));
}
