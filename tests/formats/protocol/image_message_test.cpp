// Camera pictures on the wire: answers cut from a stream, frame notes, raw pictures.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "formats/protocol/image_message.hpp"

using namespace kenaf::protocol::image;

namespace {

using Octets = std::vector<std::uint8_t>;

Octets octets(std::string_view text) {
  return {text.begin(), text.end()};
}

// SOI, the segments, SOS with nothing, EOI.
Octets jpeg_with(std::string_view segments) {
  Octets out{0xff, 0xd8};
  out.insert(out.end(), segments.begin(), segments.end());
  out.insert(out.end(), {0xff, 0xda, 0x00, 0x02, 0xff, 0xd9});
  return out;
}

std::string comment(std::string_view text) {
  std::string out = {'\xff', '\xfe', '\0', static_cast<char>(text.size() + 2)};
  return out.append(text);
}

}  // namespace

TEST_CASE("An answer comes whole from any pieces, and several from one") {
  const Octets stream =
      octets(std::string("\x03\x00\x00\x00\x02"
                         "ab\xff\x00\x00\x00\x00\x00\x00\x00\x00\x01x",
                         18));
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    AnswerReader reader;
    std::vector<Answer> answers;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      auto bytes = std::span(stream).subspan(at, std::min(piece, stream.size() - at));
      while (reader.take(bytes)) answers.push_back(std::exchange(reader.answer, {}));
      REQUIRE(bytes.empty());
    }
    REQUIRE(answers.size() == 3);
    CHECK(answers[0].type == 3);
    CHECK(answers[0].data == octets("ab"));
    CHECK(answers[1].type == kRefused);
    CHECK(answers[1].data.empty());
    CHECK(answers[2].type == kRaw);
    CHECK(answers[2].data == octets("x"));
    CHECK(reader.is_between());
  }
}

TEST_CASE("What cannot be a picture's header is refused by its number") {
  const auto error = [](std::uint8_t type, std::uint32_t size) {
    const auto header = answer_header(type, size);
    std::span<const std::uint8_t> bytes(header);
    AnswerReader reader;
    try {
      (void)reader.take(bytes);
    } catch (const std::runtime_error& wrong) {
      return std::string(wrong.what());
    }
    return std::string();
  };
  CHECK_THAT(error(6, 1), Catch::Contains("type 6"));
  CHECK_THAT(error(254, 1), Catch::Contains("type 254"));
  CHECK_THAT(error(3, (64u << 20) + 1), Catch::Contains("67108865 bytes"));
  CHECK(error(3, 64u << 20).empty());
}

TEST_CASE("Headers are big-endian, names have their length before them") {
  CHECK(answer_header(2, 0x01020304) == std::array<std::uint8_t, 5>{2, 1, 2, 3, 4});
  CHECK(select_request("") == std::string("V\0", 2));
  CHECK(select_request("a/b") == "V\3a/b");
  CHECK_THROWS(select_request(std::string(256, 'x')));
}

TEST_CASE("A frame note is read as it is written") {
  const FrameNote note{
      .number = 18446744073709551615u, .robot_time_s = 3.25, .age_ms = 0.125, .robot = "my robot", .camera = "Front"};
  const std::string segment = frame_note_segment(note);
  // FF FE, the length of length and text, the text
  const std::string text =
      "kenaf-frame/1 number=18446744073709551615 robot_time_s=3.250000 age_ms=0.125 robot=my robot camera=Front";
  CHECK(segment == comment(text));
  const auto read = read_frame_note(jpeg_with(segment));
  REQUIRE(read);
  CHECK(read->number == note.number);
  CHECK(read->robot_time_s == 3.25);
  CHECK(read->age_ms == 0.125);
  CHECK(read->robot == "my robot");
  CHECK(read->camera == "Front");
  // Also behind other segments and comments.
  CHECK(read_frame_note(jpeg_with(std::string("\xff\xe0\0\4ab", 6) + comment("by hand") + segment)));
}

TEST_CASE("What is no frame note is none") {
  for (const std::string text :
       {"kenaf-frame/2 number=1 robot_time_s=0 age_ms=0 robot=a camera=b",
        "kenaf-frame/1 number=-1 robot_time_s=0 age_ms=0 robot=a camera=b",
        "kenaf-frame/1 number=1 robot_time_s=nan age_ms=0 robot=a camera=b",
        "kenaf-frame/1 number=1 robot_time_s=0 age_ms=-1 robot=a camera=b",
        "kenaf-frame/1 number=1 robot_time_s=0 age_ms=inf robot=a camera=b",
        "kenaf-frame/1 number=1 age_ms=0 robot_time_s=0 robot=a camera=b",
        "kenaf-frame/1 number=1 robot_time_s=0 age_ms=0 robot=a",
        "kenaf-frame/1 number=1 robot_time_s=0 age_ms=0 camera=b",
        "kenaf-frame/1 number= robot_time_s=0 age_ms=0 robot=a camera=b", "kenaf-frame/1 ", ""}) {
    CAPTURE(text);
    CHECK_FALSE(read_frame_note(jpeg_with(comment(text))));
  }
  const std::string good = comment("kenaf-frame/1 number=1 robot_time_s=0 age_ms=0 robot=a camera=b");
  CHECK(read_frame_note(jpeg_with(good)));
  CHECK_FALSE(read_frame_note(octets(good)));                                      // no SOI
  CHECK_FALSE(read_frame_note(jpeg_with(std::string("\xff\xda\0\2", 4) + good)));  // in the picture's data
  CHECK_FALSE(read_frame_note(jpeg_with(std::string("\xff\xe0\0\1", 4) + good)));  // a segment shorter than its length
  CHECK_FALSE(read_frame_note({}));
}

TEST_CASE("A whole JPEG begins with SOI and ends with EOI, but for zeros") {
  Octets jpeg = jpeg_with("");
  CHECK(is_whole_jpeg(jpeg));
  jpeg.insert(jpeg.end(), 7, 0);
  CHECK(is_whole_jpeg(jpeg));
  jpeg.push_back(1);
  CHECK_FALSE(is_whole_jpeg(jpeg));
  CHECK_FALSE(is_whole_jpeg({}));
  CHECK_FALSE(is_whole_jpeg(Octets{0xff, 0xd8, 0xd9}));
}

TEST_CASE("Raw pictures: blue, green, red, rows padded to 4 bytes") {
  // 3 x 1: 9 bytes and 3 of padding
  const auto picture = read_raw_picture(Octets{0, 3, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0});
  REQUIRE(picture);
  CHECK(picture->width == 3);
  CHECK(picture->height == 1);
  CHECK(picture->rgb == Octets{3, 2, 1, 6, 5, 4, 9, 8, 7});
  CHECK_FALSE(read_raw_picture(Octets{0, 3, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  CHECK_FALSE(read_raw_picture(Octets{0, 0, 0, 1}));
  CHECK_FALSE(read_raw_picture(Octets{0, 1}));
}
