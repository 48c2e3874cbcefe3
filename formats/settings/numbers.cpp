#include "formats/settings/numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace kenaf::settings {
namespace {

template <typename Number>
std::optional<Number> read(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> number_from(std::string_view text) {
  const std::optional<double> value = read<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::uint64_t> whole_number_from(std::string_view text) {
  const bool has_leading_zero = text.size() > 1 && text.front() == '0';
  return has_leading_zero ? std::nullopt : read<std::uint64_t>(text);
}

std::string must_be_number(double min, double max) {
  return fmt::format("must be a number from {} to {}", min, max);
}

std::string must_be_whole_number(std::uint64_t min, std::uint64_t max) {
  return fmt::format("must be a whole number from {} to {}", min, max);
}

}  // namespace kenaf::settings
