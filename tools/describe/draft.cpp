#include "tools/describe/draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/description/description_error.hpp"

namespace kenaf::describe {
namespace {

using description::DescriptionError;

constexpr std::size_t kCommentColumn = 42;  // as in share/robots

std::string remark_of(const Entry& entry) {
  if (entry.source == Source::given) return "given";
  const std::string word = entry.source == Source::urdf ? "URDF" : "chosen";
  return entry.comment.empty() ? word : word + ": " + entry.comment;
}

std::string line_of(const Entry& entry) {
  const std::string assignment = entry.key + " = " + entry.value;
  return fmt::format("{:<{}}# {}\n", assignment, std::max(kCommentColumn, assignment.size() + 1), remark_of(entry));
}

// Returns all tables of that name; with `nth` > 0 the n-th alone.
std::vector<Table*> tables_at(Draft& draft, std::string_view name, std::size_t nth) {
  std::vector<Table*> found;
  for (Table& table : draft.tables)
    if (table.name == name) found.push_back(&table);
  if (nth == 0) return found;
  return nth <= found.size() ? std::vector<Table*>{found[nth - 1]} : std::vector<Table*>{};
}

std::string keys_of(const Draft& draft) {
  std::vector<std::string> keys;
  for (const Table& table : draft.tables) {
    if (table.name == "sensor" || table.name == "camera") continue;
    for (const Entry& entry : table.entries) {
      const std::string key = table.name.empty() ? entry.key : table.name + "." + entry.key;
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    }
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

void check_value(std::string_view assignment, std::string_view value) {
  bool single = false;
  try {
    const toml::table table = toml::parse(fmt::format("x = {}", value));
    single = table.size() == 1 && value.find_first_of("\n#") == std::string_view::npos;
  } catch (const toml::parse_error&) {
  }
  if (!single)
    throw DescriptionError(fmt::format(
        "--set {}: \"{}\" is no value of TOML; give 1.5, [1.0, 0.0, 0.2], true or '\"text\"'", assignment, value));
}

}  // namespace

void Table::add(std::string key, std::string value, Source source, std::string comment) {
  entries.push_back({std::move(key), std::move(value), source, std::move(comment)});
}

void Table::from_urdf(std::string key, std::string value, std::string comment) {
  add(std::move(key), std::move(value), Source::urdf, std::move(comment));
}

void Table::chosen(std::string key, std::string value, std::string comment) {
  add(std::move(key), std::move(value), Source::chosen, std::move(comment));
}

std::string toml_number(double value) {
  if (std::abs(value) < 1e-12) return "0.0";
  const std::string text = fmt::format("{:.12g}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_vector(const Eigen::Vector3d& value) {
  return fmt::format("[{}, {}, {}]", toml_number(value.x()), toml_number(value.y()), toml_number(value.z()));
}

std::string toml_text(std::string_view value) {
  std::string text = "\"";
  for (const char c : comment_text(value)) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

std::string comment_text(std::string_view text) {
  std::string plain(text);
  std::ranges::replace_if(
      plain, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return plain;
}

void set_value(Draft& draft, std::string_view assignment) {
  // KEY=VALUE, where KEY is key, table.key or table.2.key
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) throw DescriptionError(fmt::format("--set {}: give KEY=VALUE", assignment));
  std::string_view path = assignment.substr(0, equals);
  const std::string_view value = assignment.substr(equals + 1);
  check_value(assignment, value);
  const std::size_t last = path.rfind('.');
  const std::string_view key = last == std::string_view::npos ? path : path.substr(last + 1);
  std::string_view name = last == std::string_view::npos ? std::string_view() : path.substr(0, last);
  std::size_t nth = 0;
  if (const std::size_t dot = name.find('.'); dot != std::string_view::npos) {
    const std::string_view digits = name.substr(dot + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), nth);
    if (error != std::errc() || end != digits.data() + digits.size() || nth == 0)
      throw DescriptionError(fmt::format("--set {}: \"{}\" is no number of a table, from 1", assignment, digits));
    name = name.substr(0, dot);
  }

  bool set = false;
  for (Table* table : tables_at(draft, name, nth))
    for (Entry& entry : table->entries)
      if (entry.key == key) {
        entry.value = value;
        entry.source = Source::given;
        set = true;
      }
  if (!set)
    throw DescriptionError(
        fmt::format("--set {}: this robot has no \"{}\"; it has {}", assignment, path, keys_of(draft)));
}

std::string toml_of(const Draft& draft) {
  std::string text;
  for (const std::string& line : draft.heading) text += line.empty() ? "#\n" : "# " + comment_text(line) + "\n";
  for (const Table& table : draft.tables) {
    text += "\n";
    if (!table.name.empty()) text += table.one_of_several ? "[[" + table.name + "]]\n" : "[" + table.name + "]\n";
    for (const Entry& entry : table.entries) text += line_of(entry);
  }
  return text;
}

std::vector<std::string> chosen_keys(const Draft& draft) {
  std::vector<std::string> lines, keys;
  for (const Table& table : draft.tables) {
    if (table.name == "sensor" || table.name == "camera") continue;
    for (const Entry& entry : table.entries) {
      const std::string key = table.name.empty() ? entry.key : table.name + "." + entry.key;
      if (entry.source != Source::chosen || std::ranges::find(keys, key) != keys.end()) continue;
      keys.push_back(key);
      const std::string assignment = key + " = " + entry.value;
      lines.push_back(entry.comment.empty() ? assignment : fmt::format("{:<48} {}", assignment, entry.comment));
    }
  }
  return lines;
}

}  // namespace kenaf::describe
