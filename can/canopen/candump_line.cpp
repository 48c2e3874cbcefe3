#include "can/canopen/candump_line.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "can/canopen/candump_screen.hpp"
#include "can/canopen/candump_stamp.hpp"
#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen {
namespace {

using text::digit;
using text::quoted;
using text::take_word;

constexpr std::uint32_t kErrorFlag = 1u << 29, kMaxExtendedId = (1u << 29) - 1, kMaxId = 0x7ff;
constexpr std::size_t kStandardDigits = 3, kExtendedDigits = 8, kMaxFdBytes = 64, kMaxInterface = 15;

// Pairs of hexadecimal digits, optionally separated by points; nullopt: anything else, or more than `most`.
std::optional<std::vector<std::uint8_t>> parse_bytes(std::string_view text, std::size_t most) {
  std::vector<std::uint8_t> bytes;
  while (!text.empty()) {
    if (text.front() == '.' && !bytes.empty()) text.remove_prefix(1);
    if (text.size() < 2 || digit(text[0]) < 0 || digit(text[1]) < 0 || bytes.size() == most) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(digit(text[0]) << 4 | digit(text[1])));
    text.remove_prefix(2);
  }
  return bytes;
}

// How many bytes a remote frame asks for; nullopt: the data are not a remote frame's.
std::optional<std::uint8_t> asked_bytes(std::string_view data) {
  if (data.empty() || (data.front() != 'R' && data.front() != 'r')) return std::nullopt;
  if (data.size() == 1) return std::uint8_t{0};
  if (data.size() != 2 || data[1] < '0' || data[1] > '8') return std::nullopt;
  return static_cast<std::uint8_t>(data[1] - '0');
}

bool is_fd(std::string_view data) {
  return data.size() >= 2 && data[0] == '#' && digit(data[1]) >= 0 && parse_bytes(data.substr(2), kMaxFdBytes);
}

// Bytes of a classic frame, without the raw length code that may follow eight bytes.
std::optional<std::vector<std::uint8_t>> parse_classic(std::string_view data) {
  const std::size_t mark = data.find('_');
  auto bytes = parse_bytes(data.substr(0, mark), kMaxFrameBytes);
  if (mark == std::string_view::npos) return bytes;
  const bool raw_length =
      bytes && bytes->size() == kMaxFrameBytes && mark + 2 == data.size() && digit(data[mark + 1]) > 8;
  return raw_length ? bytes : std::nullopt;
}

// IDENTIFIER#DATA; the number of the identifier's digits says whether it has 11 or 29 bits.
void parse_frame(std::string_view word, RecordedFrame& line) {
  const std::size_t mark = word.find('#');
  if (mark == std::string_view::npos) throw BadLogLine(fmt::format("{} is not a frame such as 1A5#2C01", quoted(word)));
  const CandumpId id = parse_candump_id(word.substr(0, mark));

  // The kind, by data and identifier. Error frames always have bytes.
  const std::string_view data = word.substr(mark + 1);
  if (const auto bytes = parse_classic(data)) return set_frame(line, id, *bytes);
  const auto asked = asked_bytes(data);
  if (!id.error && asked) {
    line.kind = id.extended ? FrameKind::extended : FrameKind::remote;
    if (!id.extended) line.frame = Frame{.id = static_cast<std::uint16_t>(id.id), .length = *asked};
  } else if (!id.error && is_fd(data)) {
    line.kind = FrameKind::fd;
  } else {
    throw BadLogLine(
        fmt::format("{} is not frame data: up to eight bytes of two hexadecimal digits each", quoted(data)));
  }
}

// Without the colours of a terminal: escape, '[', numbers, a letter.
std::string without_colours(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\x1b') {
      plain += text[i];
    } else {
      while (i + 1 < text.size() && text[i] != 'm') ++i;
    }
  }
  return plain;
}

RecordedFrame parse_plain(std::string_view text) {
  std::string_view rest = text::trimmed(text);
  const CandumpStamp stamp = take_candump_stamp(rest);
  const std::string_view first = rest.substr(0, rest.find_first_of(" \t"));
  RecordedFrame line{.at = stamp.at, .interface = std::string(take_word(rest)), .stamp = stamp.stamp};
  const bool on_screen = is_candump_screen(rest);
  if (stamp.stamp == Stamp::none && !on_screen)
    throw BadLogLine(fmt::format("{} is not a time such as (1436509052.249713)", quoted(first)));
  if (line.interface.empty() || line.interface.size() > kMaxInterface)
    throw BadLogLine(
        fmt::format("{} is not the name of an interface: 1 to 15 characters", text::quoted(line.interface)));
  if (on_screen) {
    parse_candump_screen(rest, line);
    return line;
  }
  parse_frame(take_word(rest), line);
  if (!rest.empty() && rest != "T" && rest != "R") throw BadLogLine(fmt::format("{} follows the frame", quoted(rest)));
  return line;
}

}  // namespace

std::string_view describe(FrameKind kind) {
  switch (kind) {
    case FrameKind::data:
      return "a data frame";
    case FrameKind::extended:
      return "a frame with an identifier of 29 bits";
    case FrameKind::remote:
      return "a remote frame";
    case FrameKind::fd:
      return "a CAN FD frame";
    case FrameKind::error:
      return "an error message of the CAN driver";
  }
  return "an unknown kind of frame";
}

RecordedFrame parse_candump_line(std::string_view text) {
  if (text.find('\x1b') == std::string_view::npos) return parse_plain(text);
  return parse_plain(without_colours(text));
}

CandumpId parse_candump_id(std::string_view digits) {
  const bool standard = digits.size() == kStandardDigits, extended = digits.size() == kExtendedDigits;
  const auto id = text::hexadecimal(digits);
  if ((!standard && !extended) || !id || *id > (standard ? kMaxId : kMaxExtendedId | kErrorFlag)) {
    throw BadLogLine(fmt::format("{} is not an identifier: three hexadecimal digits up to 7FF, or eight up to 3FFFFFFF",
                                 quoted(digits)));
  }
  return {*id & kMaxExtendedId, extended, extended && (*id & kErrorFlag) != 0};
}

void set_frame(RecordedFrame& line, CandumpId id, std::span<const std::uint8_t> bytes) {
  if (id.error) {
    line.kind = FrameKind::error;
    line.error_class = id.id;
    line.frame = make_frame(0, bytes);
  } else if (id.extended) {
    line.kind = FrameKind::extended;
  } else {
    line.kind = FrameKind::data;
    line.frame = make_frame(static_cast<std::uint16_t>(id.id), bytes);
  }
}

std::string candump_line(Time at, std::string_view interface, const Frame& frame) {
  const std::int64_t us = std::chrono::floor<std::chrono::microseconds>(at).count();
  return fmt::format("({:010}.{:06}) {} {:03X}#{:02X}", us / 1'000'000, us % 1'000'000, interface, frame.id,
                     fmt::join(frame.data.begin(), frame.data.begin() + frame.length, ""));
}

}  // namespace kenaf::canopen
