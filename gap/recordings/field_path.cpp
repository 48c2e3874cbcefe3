#include "gap/recordings/field_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::string_view kListsOfNames[] = {"name", "names", "joint_names", "joint_name"};
constexpr std::string_view kNamesOfElements[] = {"child_frame_id", "name", "joint_name", "id"};

[[noreturn]] void fail_path(std::string_view text) {
  throw RecordingError(fmt::format("'{}' is no path of a field, as twist.linear.x, position[2] or velocity[left] are",
                                   std::string(text.substr(0, 80))));
}

// The step up to `end`, without what is in brackets.
PathStep step_of(std::string_view field, std::string_view in_brackets, bool has_brackets) {
  PathStep step{std::string(field)};
  if (!has_brackets) return step;
  std::uint64_t index = 0;
  const auto [end, error] = std::from_chars(in_brackets.data(), in_brackets.data() + in_brackets.size(), index);
  if (error == std::errc{} && end == in_brackets.data() + in_brackets.size())
    step.index = index;
  else
    step.key = in_brackets;
  return step;
}

}  // namespace

FieldPath parse_field_path(std::string_view text) {
  FieldPath path;
  for (std::string_view rest = text;;) {
    const std::size_t field_end = std::min(rest.size(), rest.find_first_of(".["));
    const std::string_view field = rest.substr(0, field_end);
    if (field.empty() || field.find(']') != field.npos) fail_path(text);
    rest.remove_prefix(field_end);
    const bool has_brackets = rest.starts_with('[');
    const std::size_t close = has_brackets ? rest.find(']') : 0;
    if (close == rest.npos || (has_brackets && close < 2)) fail_path(text);
    path.push_back(step_of(field, has_brackets ? rest.substr(1, close - 1) : "", has_brackets));
    if (has_brackets) rest.remove_prefix(close + 1);
    if (rest.empty()) return path;
    if (!rest.starts_with('.')) fail_path(text);
    rest.remove_prefix(1);
  }
}

std::string with_key(std::string_view field, std::string_view key) {
  return fmt::format("{}[{}]", field, key);
}

bool is_list_of_names(std::string_view field) {
  return std::ranges::find(kListsOfNames, field) != std::end(kListsOfNames);
}

bool is_name_of_element(std::string_view field) {
  return std::ranges::find(kNamesOfElements, field) != std::end(kNamesOfElements);
}

}  // namespace kenaf::gap::recordings
