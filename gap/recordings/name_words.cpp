#include "gap/recordings/name_words.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace kenaf::gap::recordings {
namespace {

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}
bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_digit_of_name(char c) {
  return c >= '0' && c <= '9';
}

struct UnitWord {
  std::string_view ending, unit;
};
// Endings of names, longer ones first.
constexpr UnitWord kUnitWords[] = {
    {"rad/s", "rad/s"}, {"radps", "rad/s"}, {"rad_s", "rad/s"}, {"deg/s", "deg/s"}, {"degps", "deg/s"},
    {"dps", "deg/s"},   {"rpm", "rpm"},     {"km/h", "km/h"},   {"kmh", "km/h"},    {"mm/s", "mm/s"},
    {"mmps", "mm/s"},   {"cm/s", "cm/s"},   {"m/s^2", "m/s^2"}, {"mps2", "m/s^2"},  {"m/s", "m/s"},
    {"mps", "m/s"},     {"_deg", "deg"},    {"_rad", "rad"},    {"_mm", "mm"},      {"_cm", "cm"},
    {"_ma", "mA"},      {"_mv", "mV"},      {"_g", "g"},        {"_m", "m"},        {"_a", "A"},
    {"_v", "V"},
};

}  // namespace

Words words_in(std::string_view name) {
  Words words;
  bool in_word = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool fits = is_lower(c) || is_upper(c) || is_digit_of_name(c);
    const bool begins = !in_word || (i > 0 && is_lower(name[i - 1]) && is_upper(c));
    in_word = fits;
    if (!fits) continue;
    if (begins) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

bool has_any(const Words& words, std::initializer_list<std::string_view> any) {
  return std::ranges::any_of(any,
                             [&words](std::string_view word) { return std::ranges::find(words, word) != words.end(); });
}

std::optional<Side> side_in(const Words& words) {
  const bool left = has_any(words, {"left", "l", "lhs"}), right = has_any(words, {"right", "r", "rhs"});
  if (left == right) return std::nullopt;
  return left ? Side::left : Side::right;
}

std::string corner_in(const Words& words) {
  for (const char* corner : {"fl", "fr", "rl", "rr"})
    if (has_any(words, {corner})) return corner;
  const bool front = has_any(words, {"front", "f"}), rear = has_any(words, {"rear", "back", "b"});
  const std::optional<Side> side = side_in(words);
  if (!side || front == rear) return {};
  return std::string(front ? "f" : "r") + (*side == Side::left ? "l" : "r");
}

std::string unit_in(std::string_view name) {
  std::string small(name);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  // "speed [m/s]" ends as "speed m/s"
  while (!small.empty() && (small.back() == ']' || small.back() == ')')) small.pop_back();
  for (const UnitWord& word : kUnitWords)
    if (small.ends_with(word.ending)) return std::string(word.unit);
  return {};
}

bool is_utf8(std::string_view name) {
  try {
    return !nlohmann::json(name).dump().empty();  // strict
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

}  // namespace kenaf::gap::recordings
