#include "formats/description/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/settings/nearest_word.hpp"

namespace kenaf::description {
namespace {

std::string range_text(Range range) {
  if (std::isinf(range.max)) return fmt::format("{} {}", range.open_min ? "more than" : "at least", range.min);
  return fmt::format("{} {} to {}", range.open_min ? "more than" : "from", range.min, range.max);
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw DescriptionError(fmt::format("{}:{}:{}: {}", file, at.line, at.column, error.description()));
  }
}

TomlReader::TomlReader(const toml::table& table, std::string where, const std::string& file)
    : table_(table), where_(std::move(where)), file_(file) {}

std::string TomlReader::name_of(std::string_view key) const {
  return where_.empty() ? std::string(key) : where_ + "." + std::string(key);
}

void TomlReader::fail_at(const toml::source_region& source, const std::string& what) const {
  throw DescriptionError(fmt::format("{}:{}:{}: {}", file_, source.begin.line, source.begin.column, what));
}

void TomlReader::fail(std::string_view key, const std::string& what) const {
  const toml::node* found = table_.get(key);
  fail_at(found ? found->source() : table_.source(), fmt::format("{} {}", name_of(key), what));
}

const toml::node& TomlReader::node(std::string_view key) {
  read_.emplace_back(key);
  const toml::node* found = table_.get(key);
  if (!found) fail(key, "is missing");
  return *found;
}

bool TomlReader::has(std::string_view key) const {
  asked_.emplace_back(key);
  return table_.contains(key);
}

double TomlReader::checked(std::string_view key, const toml::node& node, Range range) const {
  const auto value = node.value<double>();
  if (!value || !node.is_number()) fail_at(node.source(), fmt::format("{} must be a number", name_of(key)));
  const bool inside = range.open_min ? *value > range.min : *value >= range.min;
  if (!std::isfinite(*value) || !inside || *value > range.max)
    fail_at(node.source(), fmt::format("{} is {}, but must be {}", name_of(key), *value,
                                       std::isinf(range.min) ? "finite" : range_text(range)));
  return *value;
}

double TomlReader::number(std::string_view key, Range range) {
  return checked(key, node(key), range);
}

double TomlReader::number_or(std::string_view key, double fallback, Range range) {
  return has(key) ? number(key, range) : fallback;
}

int TomlReader::integer(std::string_view key, int min, int max) {
  const toml::node& found = node(key);
  const auto value = found.value<std::int64_t>();
  if (!found.is_integer() || !value) fail(key, "must be a whole number");
  if (*value < min || *value > max) fail(key, fmt::format("is {}, but must be from {} to {}", *value, min, max));
  return static_cast<int>(*value);
}

bool TomlReader::boolean(std::string_view key) {
  const toml::node& found = node(key);
  if (!found.is_boolean()) fail(key, "must be true or false");
  return *found.value<bool>();
}

std::string TomlReader::text(std::string_view key) {
  const toml::node& found = node(key);
  if (!found.is_string()) fail(key, "must be a string in quotes");
  return *found.value<std::string>();
}

std::vector<double> TomlReader::numbers(std::string_view key, std::size_t count, Range range) {
  const toml::array* list = node(key).as_array();
  if (!list || list->size() != count) fail(key, fmt::format("must be a list of {} numbers", count));
  std::vector<double> out;
  for (const toml::node& item : *list) out.push_back(checked(key, item, range));
  return out;
}

std::vector<std::string> TomlReader::texts(std::string_view key, std::size_t min, std::size_t max) {
  const toml::array* list = node(key).as_array();
  const std::string count = min == max ? fmt::to_string(min) : fmt::format("{} to {}", min, max);
  if (!list || list->size() < min || list->size() > max) fail(key, fmt::format("must be a list of {} strings", count));
  std::vector<std::string> out;
  for (const toml::node& item : *list) {
    if (!item.is_string()) fail(key, fmt::format("must be a list of {} strings", count));
    out.push_back(*item.value<std::string>());
  }
  return out;
}

std::array<double, 3> TomlReader::vector3(std::string_view key, Range range) {
  const std::vector<double> components = numbers(key, 3, range);
  return {components[0], components[1], components[2]};
}

TomlReader TomlReader::table(std::string_view key) {
  const toml::table* found = node(key).as_table();
  if (!found) fail(key, "must be a table");
  return {*found, name_of(key), file_};
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
  std::vector<TomlReader> out;
  if (!has(key)) return out;
  const toml::array* list = node(key).as_array();
  if (!list) fail(key, "must be an array of tables");
  for (const toml::node& item : *list) {
    if (!item.is_table()) fail_at(item.source(), fmt::format("{} must hold tables only", name_of(key)));
    out.emplace_back(*item.as_table(), fmt::format("{}[{}]", name_of(key), out.size()), file_);
  }
  return out;
}

std::vector<TomlReader> TomlReader::one_or_more_tables(std::string_view key) {
  const toml::node& found = node(key);
  if (found.is_table()) return {table(key)};
  if (!found.is_array()) fail(key, "must be a table, or a list of tables");
  std::vector<TomlReader> out = tables(key);
  if (out.empty()) fail(key, "is empty");
  return out;
}

void TomlReader::finish() const {
  for (const auto& [key, value] : table_) {
    const std::string_view name = key.str();
    if (std::find(read_.begin(), read_.end(), name) != read_.end()) continue;

    // A key that is there beside it cannot be the one that was meant.
    std::vector<std::string> possible;
    for (const std::string& known : asked_) {
      if (!table_.contains(known)) possible.push_back(known);
    }
    fail_at(key.source(),
            fmt::format("{} is not a known key{}", name_of(name), settings::did_you_mean(name, possible)));
  }
}

}  // namespace kenaf::description
