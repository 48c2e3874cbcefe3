#include "gap/candidates/own_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "formats/description/description_file.hpp"
#include "formats/description/toml_reader.hpp"
#include "gap/candidates/robot_numbers.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::RobotDescription;
using physics::Stage;

constexpr std::size_t kMaxEffects = 64, kMaxMoves = 64;
constexpr Stage kStages[] = {Stage::command, Stage::drive, Stage::body, Stage::contact, Stage::terrain, Stage::sensor};

struct OwnMove {
  RobotNumber number;
  double add = 0, scale = 0;  // per unit of the parameter from neutral
};

bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 &&
         std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

std::string read_name(description::TomlReader& table, std::string_view key) {
  std::string name = table.text(key);
  if (!is_plain_name(name)) table.fail(key, "must consist of the letters a to z, digits and _, at most 64 in all");
  return name;
}

std::string read_line(description::TomlReader& table, std::string_view key) {
  std::string text = table.text(key);
  const bool one_line = std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (text.empty() || text.size() > 200 || !one_line) table.fail(key, "must be one line of text of at most 200 bytes");
  return text;
}

Stage read_stage(description::TomlReader& table) {
  const std::string name = table.text("stage");
  std::vector<std::string_view> names;
  for (const Stage stage : kStages) {
    if (physics::stage_name(stage) == name) return stage;
    names.push_back(physics::stage_name(stage));
  }
  table.fail("stage", fmt::format("is \"{}\", but must be one of {}", name, fmt::join(names, ", ")));
}

// The robot's keys in the same table as `key`; if there are none, the names of its tables.
std::string keys_like(std::string_view key, const RobotDescription& robot) {
  const std::string_view table = key.substr(0, key.find_first_of(".["));
  std::vector<std::string> keys;
  std::set<std::string> tables;
  for (const RobotNumber& number : robot_numbers(robot)) {
    tables.insert(number.key.substr(0, number.key.find_first_of(".[")));
    if (number.key.starts_with(table) && number.key.find_first_of(".[") == table.size()) keys.push_back(number.key);
  }
  return keys.empty() ? fmt::format("its tables with numbers are {}", fmt::join(tables, ", "))
                      : fmt::format("it has {}", fmt::join(keys, ", "));
}

OwnMove read_move(description::TomlReader& table, const RobotDescription& robot) {
  const std::string key = table.text("key");
  std::optional<RobotNumber> number = find_robot_number(robot, key);
  if (!number)
    table.fail("key", fmt::format("is \"{}\", which is not a number of this robot: {}", key, keys_like(key, robot)));
  OwnMove move{std::move(*number)};
  const bool adds = table.has("add");
  if (adds == table.has("scale")) table.fail("key", "needs either add or scale in the same table");
  const std::string_view how = adds ? "add" : "scale";
  (adds ? move.add : move.scale) = table.number(how);
  if (table.number(how) == 0) table.fail(how, "is 0, which has no effect");
  table.finish();
  return move;
}

std::vector<OwnMove> read_moves(description::TomlReader& table, const RobotDescription& robot) {
  std::vector<OwnMove> moves;
  std::set<std::string> keys;  // as in the file: a number moved twice would not move linearly
  for (description::TomlReader& move : table.tables("moves")) {
    moves.push_back(read_move(move, robot));
    for (const std::string& key : moves.back().number.written_as)
      if (!keys.insert(key).second) move.fail("key", "is already changed by this effect");
    if (moves.size() > kMaxMoves)
      move.fail("key", fmt::format("is one too many: an effect changes at most {} numbers", kMaxMoves));
  }
  if (moves.empty()) table.fail("moves", "is missing: an effect has at least one [[effect.moves]]");
  return moves;
}

// A number that moves linearly is within its limits everywhere if it is at both ends.
void check_end(const description::TomlReader& table, std::string_view end, double value, const Candidate& candidate,
               RobotDescription robot) {
  candidate.set(robot, value);
  const std::string why = why_impossible(robot);
  if (!why.empty()) table.fail(end, fmt::format("is {}, which makes an invalid robot: {}", value, why));
}

Candidate read_effect(description::TomlReader& table, const RobotDescription& robot) {
  Candidate candidate;
  // its description, range and moves
  candidate.name = candidate.effect = read_name(table, "name");
  if (physics::find_effect(candidate.name)) table.fail("name", "is already the name of an effect in the catalogue");
  candidate.summary = read_line(table, "summary");
  candidate.stage = read_stage(table);
  candidate.parameter = read_name(table, "parameter");
  candidate.unit = read_line(table, "unit");
  candidate.neutral = candidate.present = table.number("neutral");
  candidate.min = table.number("min");
  candidate.max = table.number("max");
  if (candidate.min > candidate.neutral) table.fail("min", "must not be more than neutral");
  if (candidate.max < candidate.neutral) table.fail("max", "must not be less than neutral");
  if (candidate.min == candidate.max) table.fail("max", "must be more than min");
  const std::vector<OwnMove> moves = read_moves(table, robot);
  table.finish();
  for (const OwnMove& move : moves)
    candidate.keys.insert(candidate.keys.end(), move.number.written_as.begin(), move.number.written_as.end());

  candidate.is_relative = true;

  // each number x becomes x (1 + scale by) + add by, with by = value - neutral
  candidate.set = [moves, neutral = candidate.neutral](RobotDescription& varied, double value) {
    if (value == neutral) return;  // -0 + 0 would not be -0
    const double by = value - neutral;
    for (const OwnMove& move : moves)
      move.number.set(varied, move.number.get(varied) * (1 + move.scale * by) + move.add * by);
  };

  // both ends have to be valid robots
  check_end(table, "min", candidate.min, candidate, robot);
  check_end(table, "max", candidate.max, candidate, robot);
  return candidate;
}

}  // namespace

std::vector<Candidate> read_own_effects(const std::filesystem::path& file, const RobotDescription& robot) {
  // always a path, never a name that is searched for among the project's files
  const std::filesystem::path path = file.has_parent_path() ? file : "." / file;
  const description::DescriptionFile read = description::read_description_file("effect", path.string(), ".toml");
  return parse_own_effects(read.text, file.string(), robot);
}

std::vector<Candidate> parse_own_effects(std::string_view toml, const std::string& name_for_errors,
                                         const RobotDescription& robot) {
  const toml::table root = description::parse_toml(toml, name_for_errors);
  description::TomlReader file(root, "", name_for_errors);
  std::vector<Candidate> candidates;
  std::set<std::string> names;
  for (description::TomlReader& table : file.tables("effect")) {
    candidates.push_back(read_effect(table, robot));
    if (!names.insert(candidates.back().name).second) table.fail("name", "is also the name of another effect");
    if (candidates.size() > kMaxEffects)
      table.fail("name", fmt::format("is one effect too many: at most {}", kMaxEffects));
  }
  if (candidates.empty()) file.fail("effect", "is missing: there is at least one [[effect]]");
  file.finish();
  return candidates;
}

}  // namespace kenaf::gap::candidates
