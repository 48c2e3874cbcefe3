#include "can/canlog/vector_ascii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "can/canlog/driver_errors.hpp"
#include "can/canopen/text_fields.hpp"

namespace kenaf::canlog {

using canopen::BadLogLine;
using canopen::FrameKind;
using canopen::RecordedFrame;
namespace text = canopen::text;

namespace {

constexpr std::uint32_t kLargestStandardId = 0x7ff, kLargestExtendedId = 0x1fffffff;
constexpr std::uint32_t kLargestFdLength = 64, kFlagRemote = 0x10, kFlagFd = 0x1000;
// 292 years: the sum of relative times stays a time.
constexpr canopen::Time kLatest = std::chrono::seconds(9'000'000'000);

bool begins_header(std::string_view word) {
  static constexpr std::array<std::string_view, 8> kWords{"date",  "base", "internal", "no",
                                                          "Begin", "End",  "previous", "//"};
  return word.starts_with("//") || std::ranges::find(kWords, word) != kWords.end();
}

std::optional<RecordedFrame> chip_status(std::string_view channel, std::string_view rest) {
  constexpr std::string_view kStatus = "Status:chip status ";
  if (!text::is_decimal(channel) || !rest.starts_with(kStatus)) return std::nullopt;
  const std::string_view state = rest.substr(kStatus.size());
  DriverError error;
  error.bus_off = state.starts_with("bus off") || state.starts_with("busoff");
  error.passive = state.starts_with("error passive");
  error.warning = state.starts_with("warning level");
  error.active = state.starts_with("error active");
  RecordedFrame line{.interface = std::string(channel)};
  set_error(line, error);
  return line;
}

}  // namespace

std::optional<RecordedFrame> VectorAscii::read(std::string_view line) {
  std::string_view rest = line;
  const std::string_view first = text::take_word(rest);
  if (first.empty()) return std::nullopt;
  const auto time = text::time_of(first);
  if (!time) {
    if (!begins_header(first))
      throw BadLogLine(fmt::format("{} is not a time in s such as 2.501000", text::quoted(first)));
    read_header(line);
    return std::nullopt;
  }
  last_ = !relative_ ? *time : *time > kLatest - last_ ? kLatest : last_ + *time;

  // The second word is the channel, or the bus or program that an event is of.
  const std::string_view second = text::take_word(rest);
  std::optional<RecordedFrame> read;
  if (text::is_decimal(second)) {
    read = read_classic(second, rest);
  } else if (second == "CANFD") {
    read = read_fd(rest);
  } else if (second == "CAN") {
    const std::string_view channel = text::take_word(rest);
    read = chip_status(channel, rest);
  }
  if (read) read->at = last_;
  return read;
}

void VectorAscii::read_header(std::string_view line) {
  std::string_view rest = line;
  if (text::take_word(rest) != "base") return;
  hexadecimal_ = text::take_word(rest) != "dec";
  if (text::take_word(rest) == "timestamps") relative_ = rest.starts_with("relative");
}

std::uint32_t VectorAscii::number(std::string_view digits, std::uint32_t most, std::string_view what) const {
  const auto value = hexadecimal_ ? text::hexadecimal(digits) : text::decimal(digits);
  if (!value || *value > most) throw BadLogLine(fmt::format("{} is not {}", text::quoted(digits), what));
  return *value;
}

void VectorAscii::set_id(RecordedFrame& line, std::string_view word) const {
  const bool extended = word.ends_with('x');
  if (extended) word.remove_suffix(1);
  const std::uint32_t id =
      number(word, extended ? kLargestExtendedId : kLargestStandardId, "an identifier; symbolic names are not read");
  line.kind = extended ? FrameKind::extended : FrameKind::data;
  if (!extended) line.frame.id = static_cast<std::uint16_t>(id);
}

void VectorAscii::take_data(RecordedFrame& line, std::string_view& rest, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t byte = number(text::take_word(rest), 0xff, fmt::format("byte {} of {}", i + 1, count));
    if (line.kind == FrameKind::data) line.frame.data[i] = static_cast<std::uint8_t>(byte);
  }
  if (line.kind == FrameKind::data) line.frame.length = static_cast<std::uint8_t>(count);
}

std::optional<RecordedFrame> VectorAscii::read_classic(std::string_view channel, std::string_view rest) const {
  RecordedFrame line{.interface = std::string(channel)};
  const std::string_view id = text::take_word(rest);
  if (id == "ErrorFrame") {
    set_error(line, {.is_protocol = true});
    return line;
  }
  if (id == "Statistic:") return std::nullopt;
  set_id(line, id);
  const std::string_view direction = text::take_word(rest);
  if (direction == "TxRq") return std::nullopt;
  if (direction != "Rx" && direction != "Tx")
    throw BadLogLine(fmt::format("{} is not a direction: Rx or Tx", text::quoted(direction)));

  // A remote frame need not say how many bytes it asks for.
  const std::string_view kind = text::take_word(rest);
  if (kind != "d" && kind != "r")
    throw BadLogLine(fmt::format("{} is not a kind of frame: d or r", text::quoted(kind)));
  std::string_view after = rest;
  const std::string_view length_word = text::take_word(after);
  const auto code = text::hexadecimal(length_word, 1);
  if (!code && kind == "d") throw BadLogLine(fmt::format("{} is not the length of a frame", text::quoted(length_word)));
  const std::size_t length = std::min<std::size_t>(code.value_or(0), canopen::kMaxFrameBytes);
  if (kind == "d") {
    take_data(line, after, length);
  } else if (line.kind == FrameKind::data) {
    line.kind = FrameKind::remote;
    line.frame.length = static_cast<std::uint8_t>(length);
  }
  return line;
}

// Channel, direction, identifier, perhaps a name, two flags, length code, length, bytes, duration, bits, flags. A
// network for CAN FD carries classic frames too.
RecordedFrame VectorAscii::read_fd(std::string_view rest) const {
  RecordedFrame line{.interface = std::string(text::take_word(rest))};
  if (!text::is_decimal(line.interface))
    throw BadLogLine(fmt::format("{} is not the number of a channel", text::quoted(line.interface)));
  const std::string_view direction = text::take_word(rest);
  if (direction != "Rx" && direction != "Tx")
    throw BadLogLine(fmt::format("{} is not the direction of a frame: Rx or Tx", text::quoted(direction)));
  set_id(line, text::take_word(rest));
  std::string_view flag = text::take_word(rest);
  if (flag != "0" && flag != "1") flag = text::take_word(rest);  // what comes first is the frame's name
  text::take_word(rest);
  text::take_word(rest);
  const std::string_view length_word = text::take_word(rest);
  const auto length = text::decimal(length_word);
  if (!length || *length > kLargestFdLength)
    throw BadLogLine(fmt::format("{} is not a length of up to 64 bytes", text::quoted(length_word)));
  if (*length > canopen::kMaxFrameBytes) return {.interface = line.interface, .kind = FrameKind::fd};
  take_data(line, rest, *length);
  text::take_word(rest);
  text::take_word(rest);
  const std::uint32_t flags = text::hexadecimal(text::take_word(rest)).value_or(kFlagFd);
  if ((flags & kFlagFd) != 0) return {.interface = line.interface, .kind = FrameKind::fd};
  if ((flags & kFlagRemote) != 0 && line.kind == FrameKind::data) {
    line.kind = FrameKind::remote;
    line.frame.data = {};
  }
  return line;
}

}  // namespace kenaf::canlog
