#include "formats/protocol/image_message.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace kenaf::protocol::image {
namespace {

constexpr std::string_view kNoteBegin = "kenaf-frame/1 ";
constexpr std::uint8_t kMarker = 0xff, kSoi = 0xd8, kEoi = 0xd9, kSos = 0xda, kCom = 0xfe;

std::uint32_t big_endian_16(std::span<const std::uint8_t> bytes) {
  return std::uint32_t{bytes[0]} << 8 | bytes[1];
}

// Takes `key=` and the value up to a blank from the front of `text`.
std::optional<std::string_view> take_value(std::string_view& text, std::string_view key) {
  if (!text.starts_with(key) || !text.substr(key.size()).starts_with('=')) return std::nullopt;
  text.remove_prefix(key.size() + 1);
  const std::string_view value = text.substr(0, text.find(' '));
  text.remove_prefix(std::min(value.size() + 1, text.size()));
  return value.empty() ? std::nullopt : std::optional(value);
}

template <typename Number>
bool take_number(std::string_view& text, std::string_view key, Number& number) {
  const std::optional<std::string_view> value = take_value(text, key);
  if (!value) return false;
  const auto [end, error] = std::from_chars(value->data(), value->data() + value->size(), number);
  return error == std::errc{} && end == value->data() + value->size();
}

std::optional<FrameNote> parse_note(std::string_view text) {
  if (!text.starts_with(kNoteBegin)) return std::nullopt;
  text.remove_prefix(kNoteBegin.size());
  FrameNote note;
  if (!take_number(text, "number", note.number) || !take_number(text, "robot_time_s", note.robot_time_s) ||
      !take_number(text, "age_ms", note.age_ms))
    return std::nullopt;
  const auto is_time = [](double value) { return std::isfinite(value) && value >= 0; };
  if (!is_time(note.robot_time_s) || !is_time(note.age_ms)) return std::nullopt;
  // A robot's name may contain blanks, a camera's does not.
  constexpr std::string_view kRobot = "robot=", kCamera = " camera=";
  const std::size_t camera = text.rfind(kCamera);
  if (!text.starts_with(kRobot) || camera == std::string_view::npos || camera < kRobot.size()) return std::nullopt;
  note.robot = text.substr(kRobot.size(), camera - kRobot.size());
  note.camera = text.substr(camera + kCamera.size());
  return note;
}

}  // namespace

std::string select_request(std::string_view name) {
  if (name.size() > kMaxNameBytes) throw std::invalid_argument("the name of a camera is longer than 255 bytes");
  std::string request = "V";
  request += static_cast<char>(name.size());
  return request.append(name);
}

std::array<std::uint8_t, kHeaderBytes> answer_header(std::uint8_t type, std::uint32_t size) {
  const auto byte = [&](int shift) { return static_cast<std::uint8_t>(size >> shift); };
  return {type, byte(24), byte(16), byte(8), byte(0)};
}

bool AnswerReader::take(std::span<const std::uint8_t>& bytes) {
  // The header, byte by byte, as a piece of the stream may end within it; checked once it is complete.
  while (header_count_ < kHeaderBytes) {
    if (bytes.empty()) return false;
    header_[header_count_++] = bytes.front();
    bytes = bytes.subspan(1);
    if (header_count_ < kHeaderBytes) continue;
    answer.type = header_[0];
    answer.data.clear();
    size_ =
        std::size_t{big_endian_16(std::span(header_).subspan(1))} << 16 | big_endian_16(std::span(header_).subspan(3));
    if (answer.type > kMaxJpegType && answer.type != kRefused)
      throw std::runtime_error("an answer of type " + std::to_string(answer.type) + ", which is not a picture");
    if (size_ > kMaxAnswerBytes)
      throw std::runtime_error("an answer of " + std::to_string(size_) +
                               " bytes, which is more than a picture can have");
  }

  // The data.
  const std::size_t count = std::min(bytes.size(), size_ - answer.data.size());
  answer.data.insert(answer.data.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  bytes = bytes.subspan(count);
  if (answer.data.size() < size_) return false;
  header_count_ = 0;
  return true;
}

std::optional<FrameNote> read_frame_note(std::span<const std::uint8_t> jpeg) {
  if (jpeg.size() < 2 || jpeg[0] != kMarker || jpeg[1] != kSoi) return std::nullopt;
  jpeg = jpeg.subspan(2);
  // Segments up to the first scan: marker, and a length that counts itself (ITU T.81, B.1.1.4).
  while (jpeg.size() >= 4 && jpeg[0] == kMarker && jpeg[1] != kSos && jpeg[1] != kEoi) {
    const std::size_t length = big_endian_16(jpeg.subspan(2));
    if (length < 2 || length + 2 > jpeg.size()) return std::nullopt;
    if (jpeg[1] == kCom) {
      const std::span<const std::uint8_t> text = jpeg.subspan(4, length - 2);
      std::optional<FrameNote> note = parse_note({reinterpret_cast<const char*>(text.data()), text.size()});
      if (note) return note;
    }
    jpeg = jpeg.subspan(length + 2);
  }
  return std::nullopt;
}

std::string frame_note_segment(const FrameNote& note) {
  std::array<char, 96> numbers{};
  const int count = std::snprintf(numbers.data(), numbers.size(), "number=%llu robot_time_s=%.6f age_ms=%.3f",
                                  static_cast<unsigned long long>(note.number), note.robot_time_s, note.age_ms);
  std::string text(kNoteBegin);
  text.append(numbers.data(), std::min(static_cast<std::size_t>(count), numbers.size() - 1));
  text += " robot=" + note.robot + " camera=" + note.camera;
  const std::size_t length = text.size() + 2;
  if (length > 0xffff) throw std::invalid_argument("the names of robot and camera are too long for a JPEG's comment");
  const std::string begin = {static_cast<char>(kMarker), static_cast<char>(kCom), static_cast<char>(length >> 8),
                             static_cast<char>(length & 0xff)};
  return begin + text;
}

bool is_whole_jpeg(std::span<const std::uint8_t> jpeg) {
  while (!jpeg.empty() && jpeg.back() == 0) jpeg = jpeg.first(jpeg.size() - 1);
  return jpeg.size() >= 4 && jpeg[0] == kMarker && jpeg[1] == kSoi && jpeg[jpeg.size() - 2] == kMarker &&
         jpeg.back() == kEoi;
}

std::optional<RawPicture> read_raw_picture(std::span<const std::uint8_t> data) {
  if (data.size() < 4) return std::nullopt;
  const std::size_t width = big_endian_16(data), height = big_endian_16(data.subspan(2));
  const std::size_t row_bytes = (3 * width + 3) / 4 * 4;
  if (width == 0 || height == 0 || data.size() - 4 != row_bytes * height) return std::nullopt;
  RawPicture picture{.width = static_cast<int>(width), .height = static_cast<int>(height), .rgb = {}};
  picture.rgb.resize(3 * width * height);
  std::uint8_t* out = picture.rgb.data();
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* in = data.data() + 4 + row * row_bytes;
    for (std::size_t column = 0; column < width; ++column, in += 3) {
      *out++ = in[2];
      *out++ = in[1];
      *out++ = in[0];
    }
  }
  return picture;
}

}  // namespace kenaf::protocol::image
