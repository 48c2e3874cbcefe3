#include "gap/candidates/write_candidates.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <sstream>
#include <vector>

#include "gap/candidates/robot_numbers.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::RobotDescription;

// The location of a number in a file: nested tables, or the [[sensor]] of a name, or a [[wheel]] or [[caster]] by its
// index; a key; the index in an array.
struct TomlPlace {
  std::vector<std::string> tables;
  std::string sensor;
  std::optional<std::size_t> table_index{};  // in the array of tables `tables`.back()
  std::string key;
  std::optional<std::size_t> index;
};

// Cuts "[2]" off the end of a name; arrays of numbers have at most three elements, those of wheels at most eight.
std::optional<std::size_t> take_index(std::string_view& name) {
  const std::size_t bracket = name.find('[');
  if (bracket == name.npos) return std::nullopt;
  const auto index = static_cast<std::size_t>(name[bracket + 1] - '0');
  name = name.substr(0, bracket);
  return index;
}

TomlPlace place_of(std::string_view written_as) {
  constexpr std::string_view kSensor = "sensor[";
  TomlPlace place;
  if (written_as.starts_with(kSensor)) {
    const std::size_t end = written_as.rfind("].");  // a sensor's name may contain both
    place.sensor = written_as.substr(kSensor.size(), end - kSensor.size());
    place.key = written_as.substr(end + 2);
    return place;
  }
  for (std::size_t point; (point = written_as.find('.')) != written_as.npos; written_as.remove_prefix(point + 1)) {
    std::string_view table = written_as.substr(0, point);
    place.table_index = take_index(table);
    place.tables.emplace_back(table);
  }
  place.index = take_index(written_as);
  place.key = written_as;
  return place;
}

// Returns null if there is none.
toml::table* table_at(toml::table& root, const TomlPlace& place) {
  if (!place.sensor.empty()) {
    for (toml::node& sensor : *root["sensor"].as_array())
      if (sensor.as_table()->get("name")->value<std::string>() == place.sensor) return sensor.as_table();
    return nullptr;
  }
  if (place.table_index) return root[place.tables.back()].as_array()->get(*place.table_index)->as_table();
  toml::table* table = &root;
  for (const std::string& name : place.tables)
    if (toml::node* next = table->get(name); !next || !(table = next->as_table())) return nullptr;
  return table;
}

const toml::node* node_at(const toml::table& table, const TomlPlace& place) {
  const toml::node* node = table.get(place.key);
  return node && place.index ? node->as_array()->get(*place.index) : node;
}

void set_number(toml::table& root, const TomlPlace& place, double value) {
  toml::table* table = table_at(root, place);
  if (!table) {
    table = &root;
    for (const std::string& name : place.tables) table = table->insert(name, toml::table{}).first->second.as_table();
  }
  if (place.index)
    table->get(place.key)->as_array()->replace(
        table->get(place.key)->as_array()->cbegin() + static_cast<std::ptrdiff_t>(*place.index), value);
  else
    table->insert_or_assign(place.key, value);
}

// Integers are a different type in TOML.
std::string as_float(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// Offset in bytes; TOML columns count code points.
std::size_t offset_of(const std::string& text, toml::source_position at) {
  std::size_t offset = 0;
  for (toml::source_index line = 1; line < at.line; ++line) offset = text.find('\n', offset) + 1;
  for (toml::source_index column = 1; column < at.column; ++column) do
      ++offset;
    while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xC0) == 0x80);
  return offset;
}

std::string edited(std::string text, toml::table& root, const TomlPlace& place, double value) {
  if (!text.ends_with('\n')) text += '\n';
  const std::string number = as_float(value);
  const toml::table* table = table_at(root, place);
  if (!table) {
    const bool effect = place.tables.front() == "effects";
    return text + fmt::format("\n[{}]{}\n{} = {}\n", fmt::join(place.tables, "."),
                              effect ? "                # found by a diagnosis of runs" : "", place.key, number);
  }
  if (const toml::node* node = node_at(*table, place)) {
    const std::size_t begin = offset_of(text, node->source().begin), end = offset_of(text, node->source().end);
    return text.replace(begin, end - begin, number);
  }
  const std::size_t end_of_header = text.find('\n', offset_of(text, table->source().begin));
  return text.insert(end_of_header + 1, fmt::format("{} = {}\n", place.key, number));
}

bool reads_as_table(const std::string& text, const toml::table& root) try {
  return toml::parse(text) == root;
} catch (const toml::parse_error&) {
  return false;
}

std::string with_number(const std::string& text, const std::string& written_as, double value) {
  const TomlPlace place = place_of(written_as);
  toml::table root = toml::parse(text);
  std::string result = edited(text, root, place, value);
  set_number(root, place, value);
  if (reads_as_table(result, root)) return result;
  std::ostringstream out;  // an inline table, which cannot be extended, or dotted keys
  out << root << '\n';
  return out.str();
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

std::string robot_toml_with(const std::string& toml_text, std::span<const std::pair<Candidate, double>> values) {
  const RobotDescription before = physics::parse_robot(toml_text, "robot.toml");
  RobotDescription after = before;
  std::vector<std::string> keys;
  for (const auto& [candidate, value] : values) {
    candidate.set(after, value);
    for (const std::string& key : candidate.keys)
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  }
  std::string text = toml_text;
  for (const std::string& key : keys) {
    const std::optional<RobotNumber> number = find_robot_number(before, key);
    if (!number)
      throw description::DescriptionError(
          fmt::format("the robot has no {}: the candidates belong to another robot", key));
    if (!same_bits(number->get(before), number->get(after))) text = with_number(text, key, number->get(after));
  }
  physics::parse_robot(text, "robot.toml");
  return text;
}

}  // namespace kenaf::gap::candidates
