#include "gap/recordings/payload_cursor.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace kenaf::gap::recordings {

PayloadCursor PayloadCursor::of_cdr(std::string_view bytes) {
  constexpr std::size_t kHead = 4;  // the encoding, big endian, and options
  if (bytes.size() < kHead) throw RecordingError("a CDR message of less than 4 bytes");
  const auto encoding = number_at<std::uint16_t>(bytes.data(), std::endian::big);
  if (encoding > 1)
    throw RecordingError(
        fmt::format("CDR of the encoding 0x{:04x}, which is not supported: only plain CDR 1 is", encoding));
  // Alignment counts from behind the head.
  return {bytes.substr(kHead), encoding == 0 ? std::endian::big : std::endian::little, true};
}

PayloadCursor PayloadCursor::of_ros1(std::string_view bytes) {
  return {bytes, std::endian::little, false};
}

void PayloadCursor::align(std::size_t size) {
  if (!aligned_) return;
  const std::size_t beyond = cursor_.position() % size;
  if (beyond != 0) cursor_.take(size - beyond);
}

template <class Number>
Number PayloadCursor::read() {
  align(sizeof(Number));
  return number_at<Number>(cursor_.take(sizeof(Number)).data(), order_);
}

double PayloadCursor::number(FieldKind kind) {
  switch (kind) {
    case FieldKind::boolean:
    case FieldKind::uint8:
      return read<std::uint8_t>();
    case FieldKind::int8:
      return read<std::int8_t>();
    case FieldKind::int16:
      return read<std::int16_t>();
    case FieldKind::uint16:
      return read<std::uint16_t>();
    case FieldKind::int32:
      return read<std::int32_t>();
    case FieldKind::uint32:
      return read<std::uint32_t>();
    case FieldKind::int64:
      return static_cast<double>(read<std::int64_t>());
    case FieldKind::uint64:
      return static_cast<double>(read<std::uint64_t>());
    case FieldKind::float32:
      return static_cast<double>(read<float>());
    case FieldKind::float64:
      return read<double>();
    case FieldKind::time:
      return 1e-9 * static_cast<double>(time_ns());
    case FieldKind::duration: {
      const double seconds = read<std::int32_t>();
      return seconds + 1e-9 * read<std::int32_t>();
    }
    case FieldKind::string:
    case FieldKind::wstring:
    case FieldKind::message:
      break;
  }
  throw std::logic_error("a field that is no number");
}

std::int64_t PayloadCursor::time_ns() {
  const std::int64_t seconds = read<std::uint32_t>();
  return seconds * 1000000000 + read<std::uint32_t>();
}

std::uint32_t PayloadCursor::length() {
  return read<std::uint32_t>();
}

std::string_view PayloadCursor::text() {
  std::string_view text = cursor_.take(length());
  // CDR counts the zero at its end
  if (aligned_ && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

void PayloadCursor::skip(FieldKind kind, std::uint64_t count) {
  if (count == 0) return;
  if (kind == FieldKind::wstring) throw RecordingError("a wstring lies before it, which is not supported");
  if (kind == FieldKind::string) {
    for (std::uint64_t i = 0; i < count; ++i) text();
    return;
  }
  const std::uint64_t size = size_of(kind);
  align(kind == FieldKind::time || kind == FieldKind::duration ? 4 : size);
  if (count > cursor_.left() / size)
    throw RecordingError(fmt::format("{} numbers of {} bytes are beyond its end", count, size));
  cursor_.take(count * size);
}

}  // namespace kenaf::gap::recordings
