#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {
namespace {

using Column = std::span<const double>;
constexpr double kLongest_s = 3600;
constexpr std::array<std::string_view, physics::kFlipperCount> kFlippers{"fl", "fr", "rl", "rr"};

std::optional<double> first_measured(Column column) {
  const auto found = std::ranges::find_if(column, [](double value) { return !std::isnan(value); });
  return found == column.end() ? std::nullopt : std::optional(*found);
}

double at_start(const runs::Run& run, std::string_view name, const std::string& file) {
  const auto value = first_measured(run.column(name));
  if (!value) throw runs::RunFileError(fmt::format("{}: has no {}; a replay starts where its run started", file, name));
  return *value;
}

// Of all flippers or of none.
std::optional<std::array<double, physics::kFlipperCount>> flippers_at_start(const runs::Run& run) {
  std::array<double, physics::kFlipperCount> angles{};
  for (std::size_t i = 0; i < kFlippers.size(); ++i) {
    auto angle = first_measured(run.column(fmt::format("flipper_{}_rad", kFlippers[i])));
    if (!angle) angle = first_measured(run.column(fmt::format("cmd_flipper_{}_rad", kFlippers[i])));
    if (!angle) return std::nullopt;
    angles[i] = *angle;
  }
  return angles;
}

}  // namespace

Manoeuvre replay_of(const runs::Run& run, const std::string& name_for_errors) {
  const Column time = run.column("t_s");
  const std::array<Column, physics::kTrackCount> tracks{run.column("cmd_track_left_mps"),
                                                        run.column("cmd_track_right_mps")};
  if (time.empty() || !first_measured(tracks[0]) || !first_measured(tracks[1]))
    throw runs::RunFileError(fmt::format(
        "{}: has no commands to repeat; they are in cmd_track_left_mps and cmd_track_right_mps", name_for_errors));
  if (!(time.back() - time.front() <= kLongest_s))
    throw runs::RunFileError(fmt::format("{}: lasts more than {} s", name_for_errors, kLongest_s));
  Manoeuvre replay;
  replay.name = name_for_errors;
  replay.summary = "the commands of " + name_for_errors;
  replay.start = {.x_m = at_start(run, "x_m", name_for_errors),
                  .y_m = at_start(run, "y_m", name_for_errors),
                  .yaw_rad = at_start(run, "yaw_rad", name_for_errors),
                  .z_m = first_measured(run.column("z_m")),
                  .flipper_rad = flippers_at_start(run)};

  std::array<Column, physics::kFlipperCount> flippers;
  physics::RobotCommand command;  // stands until the first one
  for (std::size_t i = 0; i < flippers.size(); ++i) {
    flippers[i] = run.column(fmt::format("cmd_flipper_{}_rad", kFlippers[i]));
    if (replay.start->flipper_rad) command.flipper[i].value = (*replay.start->flipper_rad)[i];
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

}  // namespace kenaf::rollout
