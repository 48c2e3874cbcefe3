#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen::text {
namespace {

constexpr std::size_t kMaxQuoted = 60, kMaxWholeDigits = 10, kMaxFractionDigits = 9;
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // larger values do not fit in 64-bit nanoseconds

std::int64_t number_of(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown = "\"";
  for (const char c : text.substr(0, kMaxQuoted)) shown += c >= 0x20 && c < 0x7f ? c : '?';
  return shown + (text.size() > kMaxQuoted ? "...\"" : "\"");
}

std::optional<std::uint32_t> hexadecimal(std::string_view digits, std::size_t max_digits) {
  if (digits.empty() || digits.size() > max_digits) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : digits) {
    if (digit(c) < 0) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(digit(c));
  }
  return value;
}

std::optional<std::uint32_t> decimal(std::string_view digits) {
  if (!is_decimal(digits) || digits.size() > 9) return std::nullopt;
  return static_cast<std::uint32_t>(number_of(digits));
}

std::optional<Time> time_of(std::string_view number, Time unit) {
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const std::string_view whole = number.substr(0, point), fraction = number.substr(point + 1);
  if (!is_decimal(whole) || !is_decimal(fraction)) return std::nullopt;
  if (whole.size() > kMaxWholeDigits || fraction.size() > kMaxFractionDigits) return std::nullopt;
  if (number_of(whole) > kMaxSeconds) return std::nullopt;

  // The fraction in billionths of the unit, which is at most a second: the product stays below 1e18.
  std::int64_t billionths = number_of(fraction);
  for (std::size_t i = fraction.size(); i < kMaxFractionDigits; ++i) billionths *= 10;
  return number_of(whole) * unit + Time(billionths * unit.count() / 1'000'000'000);
}

}  // namespace kenaf::canopen::text
