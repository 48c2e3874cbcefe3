#include "can/canopen/candump_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace kenaf::canopen {
namespace {

constexpr std::uint32_t kErrorFlag = 1u << 29, kMaxExtendedId = (1u << 29) - 1, kMaxId = 0x7ff;
constexpr std::size_t kStandardDigits = 3, kExtendedDigits = 8, kMaxFdBytes = 64, kMaxInterface = 15;
constexpr std::size_t kMaxSecondsDigits = 10;
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // larger values do not fit in 64-bit nanoseconds

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

bool is_decimal(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

std::int64_t decimal(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Returns the first word of `rest` and removes it.
std::string_view take_word(std::string_view& rest) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if(rest, is_blank) - rest.begin());
  const std::string_view word = rest.substr(0, end);
  rest = trimmed(rest.substr(end));
  return word;
}

Time parse_time(std::string_view word) {
  const auto bad = [&] {
    return BadCandumpLine(fmt::format("\"{}\" is not a time such as (1436509052.249713)", word));
  };
  if (word.size() < 2 || word.front() != '(' || word.back() != ')') throw bad();
  const std::string_view number = word.substr(1, word.size() - 2);
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) throw bad();
  const std::string_view whole = number.substr(0, point), fraction = number.substr(point + 1);
  if (!is_decimal(whole) || !is_decimal(fraction) || whole.size() > kMaxSecondsDigits || fraction.size() > 9)
    throw bad();
  if (decimal(whole) > kMaxSeconds) throw bad();
  std::int64_t nanoseconds = decimal(fraction);
  for (std::size_t i = fraction.size(); i < 9; ++i) nanoseconds *= 10;
  return std::chrono::seconds(decimal(whole)) + Time(nanoseconds);
}

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

std::optional<std::uint32_t> parse_id(std::string_view digits) {
  if (digits.size() != kStandardDigits && digits.size() != kExtendedDigits) return std::nullopt;
  std::uint32_t id = 0;
  for (const char c : digits) {
    if (digit(c) < 0) return std::nullopt;
    id = id << 4 | static_cast<std::uint32_t>(digit(c));
  }
  const bool standard = digits.size() == kStandardDigits;
  if (standard ? id > kMaxId : id > (kMaxExtendedId | kErrorFlag)) return std::nullopt;
  return id;
}

bool is_remote(std::string_view data) {
  if (data.empty() || (data.front() != 'R' && data.front() != 'r')) return false;
  return data.size() == 1 || (data.size() == 2 && data[1] >= '0' && data[1] <= '8');
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

void parse_frame(std::string_view word, CandumpLine& line) {
  // IDENTIFIER#DATA; the number of the identifier's digits says whether it has 11 or 29 bits.
  const std::size_t mark = word.find('#');
  if (mark == std::string_view::npos) throw BadCandumpLine(fmt::format("\"{}\" is not a frame such as 1A5#2C01", word));
  const std::optional<std::uint32_t> id = parse_id(word.substr(0, mark));
  if (!id) {
    throw BadCandumpLine(
        fmt::format("\"{}\" is not an identifier: three hexadecimal digits up to 7FF, or eight up to 3FFFFFFF",
                    word.substr(0, mark)));
  }

  // The kind, by data and identifier. Error frames have 29 bits with the error flag, and always bytes.
  const std::string_view data = word.substr(mark + 1);
  const bool extended = mark == kExtendedDigits, error = extended && (*id & kErrorFlag) != 0;
  const auto bytes = parse_classic(data);
  if (error && bytes) {
    line.kind = CandumpKind::error;
  } else if (!error && is_remote(data)) {
    line.kind = CandumpKind::remote;
  } else if (!error && is_fd(data)) {
    line.kind = CandumpKind::fd;
  } else if (!bytes) {
    throw BadCandumpLine(
        fmt::format("\"{}\" is not frame data: up to eight bytes of two hexadecimal digits each", data));
  } else if (extended) {
    line.kind = CandumpKind::extended;
  } else {
    line.kind = CandumpKind::data;
    line.frame = make_frame(static_cast<std::uint16_t>(*id), *bytes);
  }
}

}  // namespace

std::string_view describe(CandumpKind kind) {
  switch (kind) {
    case CandumpKind::data:
      return "a data frame";
    case CandumpKind::extended:
      return "a frame with an identifier of 29 bits";
    case CandumpKind::remote:
      return "a remote frame";
    case CandumpKind::fd:
      return "a CAN FD frame";
    case CandumpKind::error:
      return "an error message of the CAN driver";
  }
  return "an unknown kind of frame";
}

CandumpLine parse_candump_line(std::string_view text) {
  std::string_view rest = trimmed(text);
  CandumpLine line{.at = parse_time(take_word(rest)), .interface = std::string(take_word(rest)), .kind = {}};
  if (line.interface.empty() || line.interface.size() > kMaxInterface)
    throw BadCandumpLine(fmt::format("\"{}\" is not the name of an interface: 1 to 15 characters", line.interface));
  parse_frame(take_word(rest), line);
  if (!rest.empty() && rest != "T" && rest != "R") throw BadCandumpLine(fmt::format("\"{}\" follows the frame", rest));
  return line;
}

std::string candump_line(Time at, std::string_view interface, const Frame& frame) {
  const std::int64_t us = std::chrono::floor<std::chrono::microseconds>(at).count();
  return fmt::format("({:010}.{:06}) {} {:03X}#{:02X}", us / 1'000'000, us % 1'000'000, interface, frame.id,
                     fmt::join(frame.data.begin(), frame.data.begin() + frame.length, ""));
}

}  // namespace kenaf::canopen
