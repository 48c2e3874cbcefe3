// Reads a TOML table completely: each key with its range, and no key left over. Errors are DescriptionErrors with file,
// line and column. Thread safety: parse_toml is pure; a TomlReader belongs to one thread.
#pragma once

#include <toml++/toml.h>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "formats/description/description_error.hpp"

namespace kenaf::description {

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  // min itself is excluded
};
inline constexpr Range kAny{};
inline constexpr Range kNotNegative{.min = 0};
inline constexpr Range kPositive{.min = 0, .open_min = true};

// Throws DescriptionError if `text` is no TOML.
toml::table parse_toml(std::string_view text, const std::string& file);

class TomlReader {
 public:
  // `where` is the table's dotted name for messages, empty for the file itself. Both references must outlive this.
  TomlReader(const toml::table& table, std::string where, const std::string& file);

  const std::string& file() const { return file_; }
  bool has(std::string_view key) const;
  double number(std::string_view key, Range range = kAny);
  double number_or(std::string_view key, double fallback, Range range = kAny);
  int integer(std::string_view key, int min, int max);
  bool boolean(std::string_view key);
  std::string text(std::string_view key);
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range = kAny);  // a list of so many
  std::vector<std::string> texts(std::string_view key, std::size_t min, std::size_t max);    // a list of min to max
  std::array<double, 3> vector3(std::string_view key, Range range = kAny);
  TomlReader table(std::string_view key);
  std::vector<TomlReader> tables(std::string_view key);              // an array of tables; empty if the key is missing
  std::vector<TomlReader> one_or_more_tables(std::string_view key);  // a table, or an array of them that is not empty

  // Ignores the key, which another reader reads.
  void leave(std::string_view key) { read_.emplace_back(key); }
  // Throws if the table has a key that was not read; names a similar one that the table may have, if there is one.
  void finish() const;
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

 private:
  const toml::node& node(std::string_view key);
  std::string name_of(std::string_view key) const;
  double checked(std::string_view key, const toml::node& node, Range range) const;
  [[noreturn]] void fail_at(const toml::source_region& source, const std::string& what) const;

  const toml::table& table_;
  std::string where_;
  const std::string& file_;
  std::vector<std::string> read_;
  mutable std::vector<std::string> asked_;  // optional keys, whether they are there or not
};

}  // namespace kenaf::description
