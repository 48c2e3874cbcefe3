#include "command_line/checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "formats/settings/nearest_word.hpp"
#include "formats/settings/numbers.hpp"

namespace kenaf::command_line {
namespace {

using settings::shown;

// `wrong` returns what the value must be, or nothing.
template <typename Wrong>
CLI::Validator check(Wrong wrong, std::string description) {
  return {[wrong = std::move(wrong)](std::string& value) {
            const std::string words = wrong(value);
            return words.empty() ? words : fmt::format("{}: {}", shown(value), words);
          },
          std::move(description)};
}

std::string wrong_word(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::find(words, text) != words.end()
             ? std::string()
             : "must be " + settings::either_of(words) + settings::did_you_mean(text, words);
}

std::string in_braces(const std::vector<std::string>& words) {
  return fmt::format("{{{}}}", fmt::join(words, ","));
}

}  // namespace

CLI::Validator whole_number(std::uint64_t min, std::uint64_t max) {
  return check(
      [min, max](const std::string& text) {
        const std::optional<std::uint64_t> value = settings::whole_number_from(text);
        return value && *value >= min && *value <= max ? std::string() : settings::must_be_whole_number(min, max);
      },
      fmt::format("{} to {}", min, max));
}

CLI::Validator number_in(double min, double max) {
  return check(
      [min, max](const std::string& text) {
        const std::optional<double> value = settings::number_from(text);
        return value && *value >= min && *value <= max ? std::string() : settings::must_be_number(min, max);
      },
      fmt::format("{} to {}", min, max));
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return check([words](const std::string& text) { return wrong_word(text, words); }, in_braces(words));
}

CLI::Validator log_level() {
  const std::vector<std::string> levels{"trace", "debug", "info", "warn", "error", "off"};
  return check(
      [levels](std::string& text) {
        if (text == "warning") text = "warn";
        return wrong_word(text, levels);
      },
      in_braces(levels));
}

CLI::Validator not_empty() {
  return check([](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); }, "");
}

CLI::Validator readable_by(std::function<void(const std::string& value)> read) {
  return check(
      [read = std::move(read)](const std::string& text) {
        try {
          read(text);
          return std::string();
        } catch (const std::runtime_error& error) {
          return std::string(error.what());
        }
      },
      "");
}

}  // namespace kenaf::command_line
