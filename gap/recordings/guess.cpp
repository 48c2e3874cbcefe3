#include "gap/recordings/guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gap/recordings/guess_entries.hpp"
#include "gap/recordings/mapping.hpp"
#include "gap/recordings/name_words.hpp"
#include "gap/recordings/units.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kSameClock_s = 1;       // chosen: a stamp farther from its log time is of another clock
constexpr double kSlowerThanRows = 0.5;  // chosen: sensors below this share of the rows' rate are not interpolated
constexpr std::size_t kMostUnusedFields = 8;

// A basic string of TOML (toml.io, v1.0.0).
std::string in_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      quoted += std::string("\\") + c;
    else if (byte < 0x20 || byte == 0x7F)
      quoted += fmt::format("\\u{:04x}", byte);
    else
      quoted += c;
  }
  return quoted + '"';
}

// Text of a recording within a comment, where TOML allows no control characters and UTF-8 alone.
std::string in_comment(std::string text) {
  const bool keeps_others = is_utf8(text);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F || (byte >= 0x80 && !keeps_others)) c = '?';
  }
  return text;
}

std::string list_in_toml(std::span<const std::string> texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + in_toml(text);
  return "[" + list + "]";
}

class Writer {
 public:
  Writer(const Survey& survey, const GuessFor& options)
      : survey_(survey), options_(options), entries_(guess_entries(survey)) {}

  Guess run() {
    choose();
    head();
    for (const auto& [commanded, drive] : entries_.drives) write_drive(drive);
    for (const robot::Column& column : robot::columns())
      if (const auto guess = entries_.columns.find(std::string(column.name)); guess != entries_.columns.end())
        write_column(guess->second, column);
    if (pose_ != nullptr) write_pose(*pose_);
    list_unused();
    return std::move(guess_);
  }

 private:
  // Drops what another guess makes better, and chooses pose and rows.
  void choose() {
    for (const bool commanded : {true, false}) {
      const auto drive = entries_.drives.find(commanded);
      if (drive == entries_.drives.end()) continue;
      // Speeds of the tracks themselves are better than those of the whole robot.
      const auto columns = columns_of(DriveMapping{commanded, "", "", 1, 1, {}, {}});
      if (entries_.columns.contains(columns[0]) && entries_.columns.contains(columns[1]))
        entries_.drives.erase(drive);
      else
        for (const std::string& column : columns) entries_.columns.erase(column);
    }
    choose_pose();
    choose_rows();
  }

  // A pose with its rotation is better than places that have a run's own names; a run's own angles are as good.
  void choose_pose() {
    if (entries_.poses.empty() || entries_.poses.front().rank <= 0 || entries_.columns.contains("yaw_rad")) return;
    pose_ = &entries_.poses.front();
    for (const char* column : {"x_m", "y_m", "z_m", "roll_rad", "pitch_rad"}) entries_.columns.erase(column);
  }

  void choose_rows() {
    const auto take = [this](const std::string& column, const SurveyedTopic& topic) {
      if (!rows_.empty()) return;
      rows_ = column;
      rows_hz_ = topic.rate_hz;
    };
    if (const auto drive = entries_.drives.find(false); drive != entries_.drives.end())
      take("track_left_mps", *drive->second.topic);
    for (const char* column : {"track_left_mps", "track_left_m"})
      if (const auto found = entries_.columns.find(column); found != entries_.columns.end())
        take(column, *found->second.topic);
    if (const auto drive = entries_.drives.find(true); drive != entries_.drives.end())
      take("cmd_track_left_mps", *drive->second.topic);
    for (const auto& [column, guess] : entries_.columns) take(column, *guess.topic);
    if (pose_ != nullptr) take("pose", *pose_->topic);
  }

  void line(const std::string& text) { guess_.toml += text + "\n"; }
  // A line with its comment; `check` marks it.
  void line(const std::string& text, const std::string& why, const std::string& check) {
    std::string comment = in_comment(why);
    if (!check.empty()) {
      comment += (comment.empty() ? "CHECK " : "; CHECK ") + in_comment(check);
      ++guess_.to_check;
    }
    line(comment.empty() ? text : fmt::format("{}  # {}", text, comment));
  }

  void head() {
    std::size_t topics = 0;
    for (const SurveyedTopic& topic : survey_.topics) topics += topic.topic.name.empty() ? topic.signals.size() : 1;
    line(fmt::format("# Guessed from {}: {}, {:.1f} s, {} {}.", in_comment(options_.recording), survey_.form,
                     survey_.duration_s, topics, survey_.time_column.empty() ? "topics" : "columns"));
    line("# Check the lines marked CHECK, and that nothing is missing below \"Not used\". Then:");
    line(fmt::format("#   kenaf-gap import {} --mapping THIS-FILE --robot {} --out run.csv",
                     in_comment(options_.recording),
                     options_.robot_name.empty() ? "ROBOT" : in_comment(options_.robot_name)));
    for (const std::string& remark : survey_.remarks) line("# " + in_comment(remark));
    line("format = \"kenaf-mapping/1\"");
    line("");
    line("[recording]");
    line("form = " + in_toml(survey_.form));
    if (survey_.topics.size() == 1 && survey_.topics.front().topic.name.empty()) write_time_column();
    line("");
    line("[rows]");
    if (rows_.empty())
      line("every_s = 0.01", "", "nothing was recognised: write [[column]], [[drive]] or [pose] by hand");
    else
      line("of = " + in_toml(rows_), fmt::format("{:.1f} rows a second", rows_hz_), "");
  }

  void write_time_column() {
    if (survey_.time_column.empty() || !is_utf8(survey_.time_column))
      line("time_column = \"\"", "", "which column has the times");
    else
      line("time_column = " + in_toml(survey_.time_column));
    line("time_unit = " + in_toml(survey_.time_unit));
  }

  // Where the stamps of a topic are of another clock.
  void write_time(const SurveyedTopic& topic) {
    const std::optional<double> lag_s = topic.log_after_stamp_s;
    if (lag_s && !(std::abs(*lag_s) <= kSameClock_s))
      line("time = \"log\"", fmt::format("its stamps are of another clock, {:.1f} s behind the recorder's", *lag_s),
           "");
  }

  void write_sampling(const SurveyedTopic& topic, bool commanded) {
    if (commanded)
      line("max_gap_s = 1", "a command is held for so long", "how long the robot obeys an old command");
    else if (topic.rate_hz < kSlowerThanRows * rows_hz_)
      line("sample = \"nearest\"", fmt::format("{:.1f} values a second, fewer than rows", topic.rate_hz), "");
  }

  std::string topic_in_words(const SurveyedTopic& topic) const {
    if (topic.topic.name.empty()) return "";
    return fmt::format(", in {} ({} messages)", topic.topic.type.empty() ? "unknown type" : topic.topic.type,
                       topic.topic.count);
  }

  void write_drive(const DriveGuess& drive) {
    ++guess_.entries;
    used_.insert({drive.v, drive.w});
    line("");
    line("[[drive]]", drive.why + topic_in_words(*drive.topic), "");
    line(fmt::format("columns = \"{}\"", drive.commanded ? "command" : "measured"), "", drive.check);
    line("v = " + in_toml(drive.v));
    line("w = " + in_toml(drive.w));
    if (options_.robot != nullptr)
      line(fmt::format("gauge_m = {}", options_.robot->track_gauge_m()),
           "the robot's; left = v - w gauge / 2, right = v + w gauge / 2",
           "the gauge by which the robot itself computes");
    write_time(*drive.topic);
    write_sampling(*drive.topic, drive.commanded);
  }

  void write_column(const ColumnGuess& guess, const robot::Column& column) {
    ++guess_.entries;
    used_.insert(guess.from);
    line("");
    line("[[column]]", guess.why + topic_in_words(*guess.topic), "");
    line("column = " + in_toml(guess.column));
    line("from = " + in_toml(guess.from), numbers_of(guess), "");
    const bool known_unit = unit_factor(column.unit, guess.unit, 1.0).has_value();
    const std::string unit = known_unit ? guess.unit : std::string(column.unit);
    line("unit = " + in_toml(unit), "", guess.unit_is_sure && known_unit ? "" : "the unit");
    if (needs_radius(column.unit, unit)) write_radius();
    if (!guess.check.empty()) line("sign = 1", "", guess.check);
    write_time(*guess.topic);
    write_sampling(*guess.topic, guess.column.starts_with("cmd_"));
  }

  // Without a robot the line stays a comment, and an import says that the radius is missing.
  void write_radius() {
    const std::string check = "the radius of the shaft that is measured, with half the belt";
    if (options_.robot != nullptr)
      line(fmt::format("radius_m = {}", options_.robot->drive.sprocket_radius_m), "the robot's sprocket", check);
    else
      line("#radius_m =", "", check);
  }

  static std::string numbers_of(const ColumnGuess& guess) {
    const auto signal = std::ranges::find(guess.topic->signals, guess.from, &Signal::from);
    if (signal == guess.topic->signals.end() || !(signal->least <= signal->most)) return "";
    return fmt::format("{:.4g} to {:.4g} at first", signal->least, signal->most);
  }

  void write_pose(const PoseGuess& guess) {
    // Its sources count as used.
    ++guess_.entries;
    const TablePose& pose = guess.pose;
    for (const std::string& from : pose.position) used_.insert(from);
    for (const std::string& from : pose.rotation) used_.insert(from);

    // Place, then rotation in whichever form it has.
    line("");
    line("[pose]", guess.why + topic_in_words(*guess.topic), guess.check);
    line("position = " + list_in_toml(pose.position), "x, y, z", "");
    line("unit = " + in_toml(pose.unit));
    if (pose.order == "quaternion") {
      line("quaternion = " + list_in_toml(pose.rotation), "x, y, z, w", "");
    } else {
      if (pose.order == "vector") {
        line("rotation_vector = " + list_in_toml(pose.rotation), "axis times angle", "that it is no angles of Euler");
      } else {
        line("angles = " + list_in_toml(pose.rotation));
        line("order = " + in_toml(pose.order), "each about the axis as turned by the ones before", "the order");
      }
      line("angle_unit = " + in_toml(pose.angle_unit));
    }

    // The axis that points up is asked for where nothing says it.
    const std::string up = "up = " + in_toml(logs::name_of(pose.up));
    if (guess.asks_up)
      line(up, "by default of the program", "the axis that points up");
    else if (guess.topic->topic.name.empty())
      line("#" + up, "without this line z, unless another is seen", "the axis that points up");
    line("frame = \"start\"", "the first pose becomes the origin; \"world\" keeps the frame", "");
    write_time(*guess.topic);
  }

  void list_unused() {
    line("");
    line("# Not used (stamps and covariances are not listed):");
    // Topics of which nothing is used have a line with type and count; of the others only their fields are listed.
    std::size_t unused = 0;
    for (const SurveyedTopic& topic : survey_.topics) {
      std::vector<std::string> fields;
      for (const Signal& signal : topic.signals)
        if (!used_.contains(signal.from) && !goes_without_saying(signal.path)) fields.push_back(signal.from);
      const bool is_used =
          std::ranges::any_of(topic.signals, [this](const Signal& signal) { return used_.contains(signal.from); });
      if (topic.topic.name.empty()) {
        unused += list_columns(fields);
      } else if (!is_used) {
        ++unused;
        line(fmt::format("#   {}: {} messages of {}{}{}", in_comment(topic.topic.name), topic.topic.count,
                         topic.topic.type.empty() ? "unknown type" : in_comment(topic.topic.type),
                         topic.not_understood.empty() ? "" : ": ", in_comment(topic.not_understood)));
        list_fields(fields);
      } else {
        list_fields(fields);
      }
    }

    // Poses that lost to the chosen one, with the reason.
    for (const PoseGuess& pose : entries_.poses)
      if (&pose != pose_ && pose.rank > -2)
        line(fmt::format("#   {}: {}", in_comment(pose.pose.position[0]), in_comment(pose.why)));
    if (unused == 0) line("#   nothing else");
  }

  static bool goes_without_saying(const std::string& path) {
    return path.find("header.stamp") != path.npos || path.find("header.seq") != path.npos ||
           path.find("covariance[") != path.npos;
  }

  std::size_t list_columns(const std::vector<std::string>& columns) {
    for (const std::string& column : columns) line("#   " + in_comment(column));
    return columns.size();
  }
  void list_fields(const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < std::min(fields.size(), kMostUnusedFields); ++i) line("#     " + in_comment(fields[i]));
    if (fields.size() > kMostUnusedFields) line(fmt::format("#     and {} more", fields.size() - kMostUnusedFields));
  }

  const Survey& survey_;
  const GuessFor& options_;
  GuessedEntries entries_;
  const PoseGuess* pose_ = nullptr;
  std::string rows_;
  double rows_hz_ = 0;
  std::set<std::string> used_;  // sources
  Guess guess_;
};

}  // namespace

Guess guess_mapping(const Survey& survey, const GuessFor& options) {
  return Writer(survey, options).run();
}

}  // namespace kenaf::gap::recordings
