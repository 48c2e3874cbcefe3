#include "can/canlog/pcan_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "can/canlog/driver_errors.hpp"
#include "can/canopen/text_fields.hpp"

namespace kenaf::canlog {

using canopen::BadLogLine;
using canopen::FrameKind;
using canopen::RecordedFrame;
namespace text = canopen::text;

namespace {

constexpr std::string_view kVersion = ";$FILEVERSION=", kColumns = ";$COLUMNS=";
constexpr std::size_t kStandardDigits = 4, kWarningWords = 9;
constexpr std::uint32_t kMaxStandardId = 0x7ff, kMaxDlc = 15;

// PEAK's states of a bus.
constexpr std::uint32_t kOverrun = 0x02, kBusLight = 0x04, kBusHeavy = 0x08, kBusOff = 0x10;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (!(line = text::trimmed(line)).empty()) words.push_back(text::take_word(line));
  return words;
}

std::vector<std::uint8_t> bytes_from(std::span<const std::string_view> words) {
  std::vector<std::uint8_t> bytes;
  for (const std::string_view word : words) {
    const auto value = text::hexadecimal(word, 2);
    if (!value) throw BadLogLine(fmt::format("{} is not a byte of two hexadecimal digits", text::quoted(word)));
    bytes.push_back(static_cast<std::uint8_t>(*value));
  }
  return bytes;
}

std::vector<std::uint8_t> last_bytes(std::span<const std::string_view> words, std::size_t count) {
  if (words.size() < count) throw BadLogLine(fmt::format("the line has {} fields, too few", words.size()));
  return bytes_from(words.last(count));
}

// Four bytes, the highest first.
void set_status(RecordedFrame& line, std::span<const std::uint8_t> bytes) {
  std::uint32_t status = 0;
  for (const std::uint8_t byte : bytes) status = status << 8 | byte;
  DriverError error;
  error.bus_off = (status & kBusOff) != 0;
  error.passive = !error.bus_off && (status & kBusHeavy) != 0;
  error.warning = !error.bus_off && !error.passive && (status & kBusLight) != 0;
  error.overflow = (status & kOverrun) != 0;
  error.active = status == 0;
  set_error(line, error);
}

// 1 bit, 2 form, 4 stuff, 8 other: but for the last, the numbers of linux/can/error.h.
void set_error_frame(RecordedFrame& line, std::uint32_t type, std::uint8_t receive_count, std::uint8_t send_count) {
  DriverError error;
  error.protocol = static_cast<std::uint8_t>(type & 0x07);
  error.is_protocol = true;
  error.send_count = send_count;
  error.receive_count = receive_count;
  set_error(line, error);
}

}  // namespace

std::optional<RecordedFrame> PcanTrace::read(std::string_view text) {
  text = text::trimmed(text);
  if (text.empty()) return std::nullopt;
  if (text.front() == ';') {
    read_header(text);
    return std::nullopt;
  }
  if (version_ != "1.1" && version_ != "2.0" && version_ != "2.1") {
    throw std::runtime_error(fmt::format("a PCAN trace (.trc) of version {}: only 1.1, 2.0 and 2.1 are read",
                                         version_.empty() ? "1.0" : version_));
  }
  const std::vector<std::string_view> words = words_of(text);
  const auto at = text::time_of(column(words, 'O'), std::chrono::milliseconds(1));
  if (!at) throw BadLogLine(fmt::format("{} is not a time in ms such as 1841.5", text::quoted(column(words, 'O'))));
  const bool has_bus = columns_.find('B') != std::string::npos;
  RecordedFrame line{.at = *at, .interface = has_bus ? std::string(column(words, 'B')) : "1"};
  const std::string_view type = column(words, 'T');

  // 1.1 has a frame's direction for its type; 2.0 and 2.1 have both, and no identifier where there is no frame.
  if (type == "Warng") {
    if (words.size() < kWarningWords) throw BadLogLine("a warning without its four bytes");
    set_status(line, bytes_from(Words(words).subspan(kWarningWords - 4, 4)));
  } else if (type == "Error") {
    const auto kind = text::hexadecimal(column(words, 'I'));
    const auto bytes = last_bytes(words, 4);
    if (!kind) throw BadLogLine(fmt::format("{} is not a kind of error", text::quoted(column(words, 'I'))));
    set_error_frame(line, *kind, bytes[2], bytes[3]);
  } else if (type == "ST") {
    set_status(line, last_bytes(words, 4));
  } else if (type == "ER") {
    const auto bytes = last_bytes(words, 5);
    set_error_frame(line, bytes[0], bytes[3], bytes[4]);
  } else if (type == "EC") {
    const auto bytes = last_bytes(words, 2);
    DriverError error;
    error.receive_count = bytes[0];
    error.send_count = bytes[1];
    set_error(line, error);
  } else if (type == "EV") {
    return std::nullopt;
  } else {
    read_frame(words, type, line);
  }
  return line;
}

void PcanTrace::read_header(std::string_view line) {
  if (line.starts_with(kVersion)) {
    version_ = text::trimmed(line.substr(kVersion.size()));
    columns_ = version_ == "1.1" ? "NOTILD" : "NOTIdlD";
  }
  if (!line.starts_with(kColumns)) return;
  columns_.clear();
  std::ranges::copy_if(line.substr(kColumns.size()), std::back_inserter(columns_),
                       [](char c) { return c != ',' && !text::is_blank(c); });
}

std::string_view PcanTrace::column(Words words, char letter) const {
  const std::size_t place = columns_.find(letter);
  if (place == std::string::npos)
    throw std::runtime_error(fmt::format("a PCAN trace (.trc) whose $COLUMNS lack {}", letter));
  if (place >= words.size()) throw BadLogLine(fmt::format("the line has {} fields, too few", words.size()));
  return words[place];
}

void PcanTrace::read_frame(Words words, std::string_view type, RecordedFrame& line) const {
  static constexpr std::array<std::string_view, 4> kFd{"FD", "FB", "FE", "BI"};
  if (std::ranges::find(kFd, type) != kFd.end()) {
    line.kind = FrameKind::fd;
    return;
  }
  const bool asks = type == "RR";
  if (!asks && type != "DT" && type != "Rx" && type != "Tx")
    throw BadLogLine(fmt::format("{} is not a type of a PCAN trace", text::quoted(type)));

  const std::string_view digits = column(words, 'I');
  const auto id = text::hexadecimal(digits);
  const bool extended = digits.size() > kStandardDigits;
  if (!id || (!extended && *id > kMaxStandardId))
    throw BadLogLine(
        fmt::format("{} is not an identifier: four hexadecimal digits up to 07FF, or eight", text::quoted(digits)));

  // Length codes above 8 stand for eight bytes.
  const std::string_view length_word = column(words, columns_.find('l') != std::string::npos ? 'l' : 'L');
  const auto dlc = text::decimal(length_word);
  if (!dlc || *dlc > kMaxDlc)
    throw BadLogLine(fmt::format("{} is not the length of a frame: 0 to 8", text::quoted(length_word)));
  const std::size_t length = std::min<std::size_t>(*dlc, canopen::kMaxFrameBytes);
  const Words data = words.subspan(std::min(columns_.find('D'), words.size()));
  const bool remote = asks || (!data.empty() && data.front() == "RTR");
  const auto bytes = remote ? std::vector<std::uint8_t>{} : bytes_from(data);
  if (!remote && bytes.size() != length)
    throw BadLogLine(fmt::format("the frame has {} bytes and says {}", bytes.size(), length));

  if (extended) {
    line.kind = FrameKind::extended;
  } else if (remote) {
    line.kind = FrameKind::remote;
    line.frame = {.id = static_cast<std::uint16_t>(*id), .length = static_cast<std::uint8_t>(length)};
  } else {
    line.frame = canopen::make_frame(static_cast<std::uint16_t>(*id), bytes);
  }
}

}  // namespace kenaf::canlog
