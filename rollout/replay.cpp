#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "robot/parts.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {
namespace {

using Column = std::span<const double>;

std::optional<double> first_measured(Column column) {
  const auto found = std::ranges::find_if(column, [](double value) { return !std::isnan(value); });
  return found == column.end() ? std::nullopt : std::optional(*found);
}

bool measures_both_tracks(const runs::Run& run) {
  return std::ranges::all_of(robot::kTrackNames, [&run](std::string_view track) {
    return first_measured(run.column(fmt::format("track_{}_mps", track))) ||
           first_measured(run.column(fmt::format("track_{}_m", track)));
  });
}

// The first value of the pose. Of a robot that nothing saw the drives and the gyro can be compared wherever it stood:
// it starts at 0. Without its tracks there is nothing left to compare.
double at_start(const runs::Run& run, std::string_view name, const std::string& file) {
  const auto value = first_measured(run.column(name));
  if (value) return *value;
  if (measures_both_tracks(run)) return 0;
  throw runs::RunFileError(
      fmt::format("{}: has no {}, and its tracks were not measured either; a replay starts where its run started: add "
                  "the pose by kenaf-gap merge",
                  file, name));
}

// The first angle of each flipper, measured or else commanded; empty if it has neither.
std::array<std::optional<double>, robot::kFlipperCount> flippers_at_start(const runs::Run& run) {
  std::array<std::optional<double>, robot::kFlipperCount> angles;
  for (std::size_t i = 0; i < robot::kFlipperNames.size(); ++i) {
    angles[i] = first_measured(run.column(fmt::format("flipper_{}_rad", robot::kFlipperNames[i])));
    if (!angles[i]) angles[i] = first_measured(run.column(fmt::format("cmd_flipper_{}_rad", robot::kFlipperNames[i])));
  }
  return angles;
}

Manoeuvre replay(const runs::Run& run, const std::string& file) {
  const Column time = run.column("t_s");
  if (!(time.back() - time.front() <= kLongestManoeuvre_s))
    throw runs::RunFileError(
        fmt::format("{}: lasts {:.0f} s, more than the {:.0f} s of the longest replay; cut the "
                    "file into one for each drive",
                    file, time.back() - time.front(), kLongestManoeuvre_s));
  const std::array<Column, robot::kTrackCount> tracks{run.column("cmd_track_left_mps"),
                                                      run.column("cmd_track_right_mps")};

  // The start.
  Manoeuvre replay;
  replay.name = file;
  replay.start = {.x_m = at_start(run, "x_m", file),
                  .y_m = at_start(run, "y_m", file),
                  .yaw_rad = at_start(run, "yaw_rad", file),
                  .z_m = first_measured(run.column("z_m")),
                  .flipper_rad = flippers_at_start(run),
                  .motion = motion_at_start(run)};

  // The commands, row by row; an empty cell repeats the one before.
  std::array<Column, robot::kFlipperCount> flippers;
  robot::Command command;  // at rest until the first one
  for (std::size_t i = 0; i < flippers.size(); ++i) {
    flippers[i] = run.column(fmt::format("cmd_flipper_{}_rad", robot::kFlipperNames[i]));
    if (const std::optional<double> angle = replay.start->flipper_rad[i])
      command.flipper[i] = {robot::JointMode::angle, *angle};  // others stay where the robot's description has them
  }
  for (std::size_t row = 0; row < time.size(); ++row) {
    const auto take = [row](Column column, double& value) {
      if (!column.empty() && !std::isnan(column[row])) value = column[row];
    };
    for (std::size_t i = 0; i < tracks.size(); ++i) take(tracks[i], command.track_speed_mps[i]);
    for (std::size_t i = 0; i < flippers.size(); ++i) take(flippers[i], command.flipper[i].value);
    replay.timed.push_back({time[row] - time.front(), command});
  }
  return replay;
}

bool has_track_commands(const runs::Run& run) {
  return first_measured(run.column("cmd_track_left_mps")) && first_measured(run.column("cmd_track_right_mps"));
}

}  // namespace

Manoeuvre replay_of(const runs::Run& run, const std::string& name_for_errors) {
  if (!has_track_commands(run))
    throw runs::RunFileError(fmt::format(
        "{}: has no commands to repeat; they are in cmd_track_left_mps and cmd_track_right_mps", name_for_errors));
  Manoeuvre out = replay(run, name_for_errors);
  out.summary = "the commands of " + name_for_errors;
  return out;
}

Manoeuvre replay_measured_of(const runs::Run& run, const std::string& name_for_errors) {
  MeasuredMotion measured = measured_motion(run);
  if (measured.empty())
    throw runs::RunFileError(fmt::format(
        "{}: has no measured tracks or flippers to repeat; they are in track_left_mps or track_left_m, flipper_fl_rad "
        "and so on",
        name_for_errors));
  if (std::ranges::any_of(measured.track_mps, &TimeSeries::empty) && !has_track_commands(run))
    throw runs::RunFileError(
        fmt::format("{}: has neither commands nor measured speeds of both tracks to repeat", name_for_errors));
  Manoeuvre out = replay(run, name_for_errors);
  out.summary = "tracks and flippers of " + name_for_errors + " as measured";
  out.measured = std::move(measured);
  return out;
}

}  // namespace kenaf::rollout
