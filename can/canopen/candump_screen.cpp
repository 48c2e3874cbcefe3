#include "can/canopen/candump_screen.hpp"

#include <fmt/format.h>

#include "can/canopen/candump_line.hpp"
#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen {
namespace {

using text::take_word;

constexpr std::size_t kMaxFdLength = 64, kMaxRawCode = 15, kBinaryDigits = 8;

struct Length {
  std::size_t bytes;
  bool fd;
};

// "[8]", "{E}", "[08]"; nullopt for anything else.
std::optional<Length> length_from(std::string_view word) {
  if (word.size() < 3 || word.size() > 4) return std::nullopt;
  const bool raw = word.front() == '{' && word.back() == '}';
  if (!raw && !(word.front() == '[' && word.back() == ']')) return std::nullopt;
  const std::string_view digits = word.substr(1, word.size() - 2);
  const auto number = raw ? text::hexadecimal(digits, 1) : text::decimal(digits);
  if (!number) return std::nullopt;
  if (raw) return *number > kMaxRawCode ? std::nullopt : std::optional(Length{kMaxFrameBytes, false});
  if (digits.size() == 2) return *number > kMaxFdLength ? std::nullopt : std::optional(Length{*number, true});
  return *number > kMaxFrameBytes ? std::nullopt : std::optional(Length{*number, false});
}

// Two hexadecimal digits, or eight binary ones.
std::optional<std::uint8_t> byte_from(std::string_view word) {
  if (word.size() == 2) {
    const auto value = text::hexadecimal(word);
    return value ? std::optional(static_cast<std::uint8_t>(*value)) : std::nullopt;
  }
  if (word.size() != kBinaryDigits) return std::nullopt;
  unsigned value = 0;
  for (const char c : word) {
    if (c != '0' && c != '1') return std::nullopt;
    value = value << 1 | static_cast<unsigned>(c - '0');
  }
  return static_cast<std::uint8_t>(value);
}

std::vector<std::uint8_t> take_bytes(std::string_view& rest, std::size_t count) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view word = take_word(rest);
    if (word.find('`') != std::string_view::npos)
      throw BadLogLine(fmt::format("{} has its bytes in reverse order: record without -S", text::quoted(word)));
    const auto byte = byte_from(word);
    if (!byte) throw BadLogLine(fmt::format("{} is not byte {} of {}", text::quoted(word), i + 1, count));
    bytes.push_back(*byte);
  }
  return bytes;
}

// -x: sent or received, and the flags of a CAN FD frame.
void skip_directions(std::string_view& rest) {
  std::string_view after = rest;
  const std::string_view direction = take_word(after);
  if (direction != "TX" && direction != "RX") return;
  take_word(after);
  take_word(after);
  rest = after;
}

}  // namespace

bool is_candump_screen(std::string_view text) {
  skip_directions(text);
  take_word(text);
  return length_from(take_word(text)).has_value();
}

void parse_candump_screen(std::string_view text, RecordedFrame& line) {
  skip_directions(text);
  const CandumpId id = parse_candump_id(take_word(text));
  const std::string_view length_word = take_word(text);
  const auto length = length_from(length_word);
  if (!length) throw BadLogLine(fmt::format("{} is not a length such as [8]", text::quoted(length_word)));

  // A remote frame has no bytes, whatever its length.
  if (text == "remote request" && !length->fd && !id.error) {
    line.kind = id.extended ? FrameKind::extended : FrameKind::remote;
    if (!id.extended)
      line.frame = Frame{.id = static_cast<std::uint16_t>(id.id), .length = static_cast<std::uint8_t>(length->bytes)};
    return;
  }
  const std::vector<std::uint8_t> bytes = take_bytes(text, length->bytes);
  if (!text.empty() && text != "ERRORFRAME" && text.front() != '\'')
    throw BadLogLine(fmt::format("{} follows the frame", text::quoted(text)));
  if (length->fd) {
    line.kind = FrameKind::fd;
  } else {
    set_frame(line, id, bytes);
  }
}

}  // namespace kenaf::canopen
