#include "formats/settings/nearest_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kenaf::settings {
namespace {

constexpr std::size_t kLongestWord = 100;  // no option or key is longer; bounds the time for hostile input
constexpr std::size_t kMostShownBytes = 60;

// ASCII only: std::tolower depends on the program's locale.
std::string folded(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '_') c = '-';
  }
  return out;
}

std::size_t most_differences(std::size_t length) {
  return length < 3 ? 0 : std::max<std::size_t>(1, length / 3);
}

// distances[i][j]: of the first i characters of `a` from the first j of `b`, in three rows that take turns.
std::size_t differences(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t wrong = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + wrong});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_.,:/=+@%[]").find(c) != std::string_view::npos;
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > kLongestWord || std::ranges::find(candidates, word) != candidates.end()) return {};
  const std::string wanted = folded(word);

  // The beginning of one candidate alone.
  const auto begins = [&](const std::string& candidate) { return folded(candidate).starts_with(wanted); };
  if (wanted.size() >= 2 && std::ranges::count_if(candidates, begins) == 1)
    return *std::ranges::find_if(candidates, begins);

  std::string_view nearest;
  std::size_t fewest = most_differences(wanted.size()) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), wanted.size());
    const std::size_t shorter = std::min(candidate.size(), wanted.size());
    if (longer - shorter >= fewest) continue;
    const std::size_t count = differences(wanted, folded(candidate));
    if (count >= fewest) continue;
    fewest = count;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  const std::string_view nearest = nearest_word(word, candidates);
  return nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest);
}

std::string either_of(std::span<const std::string> words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
    out += words[i];
  }
  return out;
}

std::string shown(std::string_view value) {
  const std::string_view begin = value.substr(0, kMostShownBytes);
  std::string out;
  for (const char c : begin) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += c;
  }
  if (begin.size() < value.size()) out += "...";
  return !value.empty() && std::ranges::all_of(value, is_plain) ? out : "'" + out + "'";
}

}  // namespace kenaf::settings
