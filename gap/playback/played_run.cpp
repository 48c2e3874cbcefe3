#include "gap/playback/played_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/parallel.hpp"
#include "gap/playback/columns_in_time.hpp"
#include "gap/playback/dead_reckoning.hpp"
#include "robot/parts.hpp"

namespace kenaf::gap::playback {
namespace {

constexpr std::array<std::string_view, 3> kPosition{"x_m", "y_m", "z_m"}, kAngles{"roll_rad", "pitch_rad", "yaw_rad"};
constexpr std::array<std::string_view, 2> kBelts{"left", "right"};
constexpr std::string_view kCommands[] = {"cmd_track_left_mps", "cmd_track_right_mps"};

// Fills unknown values with the one before; with `otherwise` at the start and if there are none.
std::vector<double> held(std::vector<double> values, std::size_t count, double otherwise) {
  if (values.empty()) values.assign(count, otherwise);
  double last = otherwise;
  for (double& value : values) last = value = std::isnan(value) ? last : value;
  return values;
}

void add_column(runs::Run& run, std::string_view name, const std::vector<double>& values) {
  if (const auto there = std::ranges::find(run.columns, name); there != run.columns.end()) {
    run.values[static_cast<std::size_t>(there - run.columns.begin())] = values;
  } else {
    run.columns.emplace_back(name);
    run.values.push_back(values);
  }
}

std::map<std::string, std::vector<double>> channels_of(const runs::Run& run, std::span<const double> times_s) {
  std::map<std::string, std::vector<double>> channels;
  const auto add = [&](std::string_view column) {
    if (auto values = column_at(run, column, times_s); runs::any_measured(values))
      channels[std::string(column)] = std::move(values);
  };
  for (const diagnose::Channel& channel : diagnose::diagnosis_channels()) add(channel.column);
  for (const std::string_view command : kCommands) add(command);
  return channels;
}

PlayedBody body_of(std::string_view kind, const runs::Run& run, std::span<const double> times_s) {
  PlayedBody body;
  body.kind = kind;
  const std::size_t count = times_s.size();
  for (std::size_t i = 0; i < 3; ++i) {
    body.p_WB_m[i] = column_at(run, kPosition[i], times_s);
    body.angles_rad[i] = column_at(run, kAngles[i], times_s);
  }
  // Flippers by their measured angles, else by their commands.
  for (std::size_t i = 0; i < robot::kFlipperNames.size(); ++i) {
    auto angle = column_at(run, fmt::format("flipper_{}_rad", robot::kFlipperNames[i]), times_s);
    if (angle.empty()) angle = column_at(run, fmt::format("cmd_flipper_{}_rad", robot::kFlipperNames[i]), times_s);
    body.flipper_rad[i] = held(std::move(angle), count, 0);
  }
  runs::Run travel{{"t_s", "left", "right"}, {}};
  travel.values.emplace_back(run.column("t_s").begin(), run.column("t_s").end());
  for (const std::string_view belt : kBelts) travel.values.push_back(travel_of(run, belt));
  for (std::size_t i = 0; i < 2; ++i) body.track_m[i] = held(column_at(travel, kBelts[i], times_s), count, 0);
  body.channels = channels_of(run, times_s);
  return body;
}

// The recorded run with a pose in it, as far as there is any.
runs::Run with_pose(const runs::Run& run, const physics::RobotDescription& robot, PoseFrom& from,
                    std::vector<std::string>& notes) {
  const auto has = [&run](std::string_view column) { return runs::any_measured(run.column(column)); };
  // A measured pose is kept.
  if (has("x_m") && has("y_m") && has("yaw_rad")) {
    from = PoseFrom::measured;
    return run;
  }

  // Otherwise dead reckoning replaces it, or there is none; a note says so.
  runs::Run result = run;
  if (const auto path = reckon(run, robot)) {
    from = PoseFrom::dead_reckoning;
    add_column(result, "x_m", path->x_m);
    add_column(result, "y_m", path->y_m);
    add_column(result, "yaw_rad", path->yaw_rad);
    notes.push_back(
        "This run has no measured pose (x_m, y_m, yaw_rad): the recorded robot is drawn at its position by dead "
        "reckoning from tracks and posture.");
  } else {
    from = PoseFrom::nothing;
    notes.push_back(
        "This run has neither a measured pose (x_m, y_m, yaw_rad) nor the travel or speed of both tracks: the recorded "
        "robot is not drawn.");
  }
  return result;
}

// Adds heights and tilts that were not measured.
void complete_pose(PlayedBody& body, const PlayedBody* nominal, double standing_m, std::vector<std::string>& notes) {
  const std::size_t count = body.p_WB_m[0].size();
  if (body.p_WB_m[2].empty()) {
    body.p_WB_m[2] = held(nominal ? nominal->p_WB_m[2] : std::vector<double>(), count, standing_m);
    if (body.kind == "recorded")
      notes.push_back(nominal
                          ? "Its height (z_m) was not measured: it is drawn at the height of the nominal simulation."
                          : "Its height (z_m) was not measured: it is drawn as on level ground.");
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!body.angles_rad[i].empty()) continue;
    body.angles_rad[i].assign(count, 0);
    if (body.kind == "recorded")
      notes.push_back(fmt::format("Its {} was not measured: it is drawn level.", kAngles[i]));
  }
}

// The runs of the nominal and, if there is one, the corrected robot.
std::vector<runs::Run> simulate_robots(const diagnose::Observation& observation, const PlayedRobots& robots,
                                       const physics::WorldDescription& world) {
  // A set of one run, for the diagnosis' own predictor; both robots are simulated at the same time.
  diagnose::Observations one;
  one.robot = robots.nominal;
  one.worlds.push_back(world);
  one.runs.push_back(observation);
  const diagnose::ComparedFeatures no_features;
  const diagnose::Predictor predictor(one, no_features, {}, 1);
  std::vector<diagnose::Variation> variations{predictor.unvaried()};
  std::vector<runs::Run> simulated(robots.corrected ? 2 : 1);
  if (robots.corrected) {
    variations.push_back(predictor.unvaried());
    variations.back().robot = *robots.corrected;
  }
  for_each_job(simulated.size(), 0, [&](std::size_t i) { simulated[i] = predictor.simulate(0, variations[i]); });
  return simulated;
}

}  // namespace

PlayedRun play_run(const runs::DatasetRun& entry, const runs::Run& run, const std::string& path,
                   const PlayedRobots& robots, const physics::WorldDescription& world, std::size_t most_times,
                   const std::map<std::string, Floor>& floors) {
  PlayedRun played{entry, run.row_count(), shown_times(run.column("t_s"), most_times), {}, {}, {}, {}, {}};

  // The recorded robot.
  PoseFrom from = PoseFrom::nothing;
  const runs::Run posed = with_pose(run, robots.nominal, from, played.notes);
  played.bodies.push_back(body_of("recorded", posed, played.times_s));
  played.bodies.front().pose_from = from;
  // Reckoned columns are no measurements, and may have replaced some.
  if (from == PoseFrom::dead_reckoning) played.bodies.front().channels = channels_of(run, played.times_s);
  if (!entry.fault.empty()) played.notes.push_back("This simulated run failed: " + entry.fault);

  // Phases by the recorded run, and its simulations.
  diagnose::Observation observation{entry.file, entry.manoeuvre, 0, posed, {}, {}, 0};
  if (played.times_s.back() <= rollout::kLongestManoeuvre_s) played.phases = diagnose::phases_of(observation);
  try {
    observation = diagnose::observation_of(entry, posed, path);
    for (const runs::Run& simulated : simulate_robots(observation, robots, world)) {
      played.bodies.push_back(body_of(played.gaps.empty() ? "nominal" : "corrected", simulated, played.times_s));
      // with what was measured, not what was reckoned from it
      played.gaps.push_back(gap_of_run(run, simulated, floors));
    }
  } catch (const std::exception& error) {
    played.notes.push_back(fmt::format("Not simulated: {}.", error.what()));
  }

  // The simulations come first, since the recorded robot may take its height from the nominal one.
  const PlayedBody* nominal = played.bodies.size() > 1 ? &played.bodies[1] : nullptr;
  const double standing_m = robots.nominal.ride_height_m();
  for (std::size_t i = played.bodies.size(); i-- > 0;) {
    if (played.bodies[i].pose_from == PoseFrom::nothing) continue;
    complete_pose(played.bodies[i], i == 0 ? nominal : nullptr, standing_m, played.notes);
  }

  if (std::ranges::any_of(world.boxes, [](const physics::Box& box) { return box.mass_kg > 0; }))
    played.notes.push_back(
        "The world has movable boxes, which are not drawn, because runs do not record their positions.");
  if (played.times_s.size() < run.row_count())
    played.notes.push_back(
        fmt::format("{} of its {} rows are shown, evenly spaced.", played.times_s.size(), run.row_count()));
  return played;
}

}  // namespace kenaf::gap::playback
