#include "can/canlog/python_can_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <vector>

#include "can/canopen/text_fields.hpp"

namespace kenaf::canlog {

using canopen::BadLogLine;
using canopen::FrameKind;
using canopen::RecordedFrame;
namespace text = canopen::text;

namespace {

constexpr std::size_t kFields = 7;
constexpr std::uint32_t kMaxElevenBits = 0x7ff, kMaxTwentyNineBits = 0x1fffffff;
constexpr double kLatest_s = 9e9;

std::array<std::string_view, kFields> fields_of(std::string_view line) {
  std::array<std::string_view, kFields> fields;
  for (std::size_t i = 0; i < kFields; ++i) {
    const std::size_t end = i + 1 < kFields ? line.find(',') : line.size();
    if (end == std::string_view::npos)
      throw BadLogLine(
          fmt::format("{} has {} of the {} fields {}", text::quoted(line), i + 1, kFields, kPythonCanHeader));
    fields[i] = text::trimmed(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return fields;
}

// As Python writes a number: "1483389464.165", "12", "1e-05".
canopen::Time seconds_from(std::string_view word) {
  if (const auto exact = text::time_of(word)) return *exact;
  double seconds = 0;
  const auto end = std::from_chars(word.data(), word.data() + word.size(), seconds);
  if (end.ec != std::errc{} || end.ptr != word.data() + word.size() || !(seconds >= 0 && seconds <= kLatest_s))
    throw BadLogLine(fmt::format("{} is not a time in s", text::quoted(word)));
  return std::chrono::round<canopen::Time>(std::chrono::duration<double>(seconds));
}

bool flag_from(std::string_view word) {
  if (word != "0" && word != "1") throw BadLogLine(fmt::format("{} is neither 0 nor 1", text::quoted(word)));
  return word == "1";
}

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// RFC 4648, section 4.
std::vector<std::uint8_t> base64_from(std::string_view word) {
  const auto bad = [&] { return BadLogLine(fmt::format("{} is not data in base 64", text::quoted(word))); };
  if (word.size() % 4 != 0) throw bad();
  std::string_view digits = word;
  for (int i = 0; i < 2 && digits.ends_with('='); ++i) digits.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  unsigned held = 0, bits = 0;
  for (const char c : digits) {
    if (sextet(c) < 0) throw bad();
    held = (held << 6 | static_cast<unsigned>(sextet(c))) & 0xffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(held >> bits & 0xff));
  }
  return bytes;
}

}  // namespace

std::optional<RecordedFrame> read_python_can_csv(std::string_view line) {
  line = text::trimmed(line);
  if (line.empty() || line == kPythonCanHeader) return std::nullopt;
  const auto fields = fields_of(line);
  RecordedFrame read{.at = seconds_from(fields[0]), .interface = "can"};
  const bool extended = flag_from(fields[2]), remote = flag_from(fields[3]), error = flag_from(fields[4]);
  const auto id = fields[1].starts_with("0x") ? text::hexadecimal(fields[1].substr(2)) : std::nullopt;
  if (!id || *id > (extended || error ? kMaxTwentyNineBits : kMaxElevenBits))
    throw BadLogLine(fmt::format("{} is not an identifier such as 0x701", text::quoted(fields[1])));
  const auto dlc = text::decimal(fields[5]);
  const std::vector<std::uint8_t> bytes = base64_from(fields[6]);
  if (!dlc) throw BadLogLine(fmt::format("{} is not a length", text::quoted(fields[5])));

  // python-can writes the length of a CAN FD frame in bytes, and has no column for its kind.
  if (*dlc > canopen::kMaxFrameBytes || bytes.size() > canopen::kMaxFrameBytes) {
    read.kind = FrameKind::fd;
    return read;
  }
  if (!remote && bytes.size() != *dlc)
    throw BadLogLine(fmt::format("the frame has {} bytes and says {}", bytes.size(), *dlc));
  if (error) {
    read.kind = FrameKind::error;
    read.error_class = *id;
    read.frame = canopen::make_frame(0, bytes);
  } else if (extended) {
    read.kind = FrameKind::extended;
  } else if (remote) {
    read.kind = FrameKind::remote;
    read.frame = {.id = static_cast<std::uint16_t>(*id), .length = static_cast<std::uint8_t>(*dlc)};
  } else {
    read.frame = canopen::make_frame(static_cast<std::uint16_t>(*id), bytes);
  }
  return read;
}

}  // namespace kenaf::canlog
