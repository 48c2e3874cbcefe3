#include "gap/recordings/table_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "gap/recordings/recording_error.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kLatestTime_s = 9e9;  // nanoseconds of later times do not fit

std::string group_of(const std::string& column) {
  const robot::Column* known = robot::find_column(column);
  if (known == nullptr) return "other";
  switch (known->quantity) {
    case robot::Quantity::track_command:
    case robot::Quantity::flipper_command:
      return "commands";
    case robot::Quantity::track_speed:
    case robot::Quantity::track_travel:
    case robot::Quantity::track_current:
      return "tracks";
    case robot::Quantity::flipper_angle:
    case robot::Quantity::flipper_current:
      return "flippers";
    case robot::Quantity::battery_voltage:
      return "battery";
    case robot::Quantity::position:
    case robot::Quantity::tilt:
    case robot::Quantity::yaw:
      return "pose";
    case robot::Quantity::turn_rate:
    case robot::Quantity::acceleration:
      return "imu";
    case robot::Quantity::posture:
      return "posture";
    case robot::Quantity::time:
    case robot::Quantity::robot_time:
    case robot::Quantity::frame:
    case robot::Quantity::late_commands:
      return "cycle";
  }
  return "other";
}

std::string unit_of_column(const std::string& column) {
  const robot::Column* known = robot::find_column(column);
  return known == nullptr ? std::string() : std::string(known->unit);
}

// A channel and the columns in its messages.
struct Group {
  std::vector<std::size_t> columns;
  std::vector<std::string> keys;  // of the columns, in quotes as JSON has them
  std::uint16_t channel = 0;
};

std::string schema_of(const Table& table, const Group& group) {
  nlohmann::json properties = nlohmann::json::object();
  for (const std::size_t column : group.columns) {
    nlohmann::json property{{"type", "number"}};
    if (const std::string unit = unit_of_column(table.columns[column]); !unit.empty()) {
      property["unit"] = unit;
      property["description"] = "in " + unit;
    }
    properties[table.columns[column]] = property;
  }
  return nlohmann::json{{"type", "object"}, {"properties", properties}}.dump(-1, ' ', false,
                                                                             nlohmann::json::error_handler_t::replace);
}

std::map<std::string, Group> groups_of(const Table& table) {
  std::map<std::string, Group> groups;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i] == table.time_column) continue;
    Group& group = groups[group_of(table.columns[i])];
    group.columns.push_back(i);
    group.keys.push_back(
        nlohmann::json(table.columns[i]).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
  return groups;
}

// The values of a row as an object; empty text if there are none.
std::string message_of(const Table& table, const Group& group, std::size_t row) {
  std::string json;
  for (std::size_t i = 0; i < group.columns.size(); ++i) {
    const double value = table.values[group.columns[i]][row];
    if (std::isfinite(value))
      fmt::format_to(std::back_inserter(json), "{}{}:{}", json.empty() ? "{" : ",", group.keys[i], value);
  }
  return json.empty() ? json : json + "}";
}

}  // namespace

WrittenTable write_table(McapWriter& writer, const Table& table, const std::string& prefix) {
  const std::span<const double> times = table.column(table.time_column);
  if (times.empty()) throw RecordingError("no column of time; name one t_s");
  const double unit_s = seconds_of_time_unit(table.time_unit).value_or(1);

  // MCAP has no times before 0: then the first row's becomes 0.
  double first = INFINITY;
  for (const double t : times) first = std::fmin(first, t);
  const double begin = first < 0 ? first : 0;

  // A channel for each group of columns.
  WrittenTable written;
  std::map<std::string, Group> groups = groups_of(table);
  for (auto& [name, group] : groups) {
    written.topics.push_back(prefix + name);
    group.channel = writer.add_channel(prefix + name, "kenaf." + name, schema_of(table, group));
  }

  // A message for each row and group in which something was measured.
  for (std::size_t row = 0; row < times.size(); ++row) {
    const double t_s = unit_s * (times[row] - begin);
    if (!(t_s < kLatestTime_s)) {
      ++written.rows_without_time;
      continue;
    }
    const auto log_ns = static_cast<std::uint64_t>(std::llround(1e9 * t_s));
    for (const auto& [name, group] : groups) {
      const std::string json = message_of(table, group, row);
      if (json.empty()) continue;
      writer.add_message(group.channel, log_ns, json);
      ++written.messages;
    }
  }
  return written;
}

}  // namespace kenaf::gap::recordings
