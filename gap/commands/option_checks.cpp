#include "gap/commands/option_checks.hpp"

#include <fmt/format.h>

#include <charconv>

namespace kenaf::gap::commands {
namespace {

template <typename Number>
bool reads_as(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

OptionCheck whole_number(std::uint64_t max) {
  return [max](const std::string& text) {
    std::uint64_t value = 0;
    const bool good = reads_as(text, value) && value <= max && text == fmt::to_string(value);
    return good ? std::string() : fmt::format("\"{}\" is not a whole number from 0 to {}", text, max);
  };
}

OptionCheck number_in(double min, double max) {
  return [min, max](const std::string& text) {
    double value = 0;
    const bool good = reads_as(text, value) && value >= min && value <= max;
    return good ? std::string() : fmt::format("\"{}\" is not a number from {} to {}", text, min, max);
  };
}

}  // namespace kenaf::gap::commands
