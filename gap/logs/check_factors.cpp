// Checks of scale: two logs of one quantity that differ by a factor that neither slip nor a drive explains.
#include <array>
#include <numbers>

#include "gap/logs/run_checks.hpp"
#include "gap/logs/scale_factor.hpp"
#include "gap/logs/unit_names.hpp"

namespace kenaf::gap::logs {
namespace {

// Factors that robots have, wider than the catalogue's effects make them. All chosen.
struct Band {
  double least, most;
  bool contains(double factor) const { return factor >= least && factor <= most; }
};
constexpr Band kSameEncoder{0.8, 1.25};   // travel over speed
constexpr Band kSameTurn{1 / 1.5, 1.5};   // yaw over gyro
constexpr Band kCommanded{1 / 2.1, 2.1};  // command over speed
constexpr Band kAlong{0.4, 1.5};          // pose over tracks, straight on and on level ground
constexpr Band kTurning{0.08, 1.5};       // turn over that of belts without slip
constexpr Band kUsualTurning{0.3, 1.1};   // of skid steering
constexpr Band kCertainAlong{0.2, 2}, kCertainTurning{0.05, 4}, kCertainCommand{0.4, 2.5}, kCertainTurn{0.5, 2};
constexpr double kOnLevel_rad = 0.1, kFarEnough_m = 0.3, kSeenAtAll_m = 0.02, kFarEnough_rad = 0.5,
                 kSeenAtAll_rad = 0.03;
constexpr double kIdle = 0.2;  // share of the travel commanded to the other track: it may be dragged
constexpr double kLevels = 0.3, kProportional = 0.99;  // of commands that no limit cuts
constexpr double kSlipOfUnit = 0.08;                   // within which a unit is recognised although belts slip

std::string in_words(const ScaleFactor& factor) {
  return fmt::format("{:.3g} (standard error {:.2g}) times", factor.factor, factor.standard_error);
}

ScaleFactor inverse(const ScaleFactor& factor) {
  ScaleFactor result = factor;
  result.factor = 1 / factor.factor;
  result.standard_error = factor.standard_error / (factor.factor * factor.factor);
  std::swap(result.first_change, result.second_change);
  return result;
}

// ": looks like km/h: divide by 3.6", or that the unit is wrong.
std::string what_it_looks_like(const std::optional<UnitName>& unit, const char* right_unit) {
  if (unit) return fmt::format(": it looks like {}", unit->words);
  return fmt::format(": its unit or its scale is wrong; it is in {}", right_unit);
}

bool went_far(const std::optional<ScaleFactor>& factor, double far, double at_all) {
  return is_certain(factor) && std::max(factor->first_change, factor->second_change) >= far &&
         std::min(factor->first_change, factor->second_change) >= at_all;
}

double tolerance_of(const ScaleFactor& factor) {
  return 3 * factor.standard_error / factor.factor;
}

// How far a factor lies from a band, as a logarithm; 0 inside.
double distance_from(const Band& band, double factor) {
  return std::max({0.0, std::log(band.least / factor), std::log(factor / band.most)});
}

}  // namespace

std::optional<double> RunChecks::sprocket_radius_m() const {
  if (robot_ == nullptr) return std::nullopt;
  return robot_->drive.sprocket_radius_m;
}

void RunChecks::check_travel_factor() {
  for (const std::string side : kSides) {
    const std::string speed = "track_" + side + "_mps", travel = "track_" + side + "_m",
                      command = "cmd_track_" + side + "_mps";
    const auto factor = scale_factor(adding(travel), rate(speed));
    if (!went_far(factor, kFarEnough_m, kSeenAtAll_m) || kSameEncoder.contains(factor->factor)) continue;
    if (found(speed) || found(travel)) continue;

    // The command, or else the pose, contradicts one of the two more than the other.
    const auto contradiction = [&](const Course& course) {
      if (const auto by_command = scale_factor(rate(command), course); is_certain(by_command))
        return std::abs(std::log(by_command->factor));
      const auto by_pose = scale_factor(forward(kOnLevel_rad), course);
      return is_certain(by_pose) ? std::abs(std::log(by_pose->factor)) : 0.0;
    };
    const double of_travel = contradiction(adding(travel)), of_speed = contradiction(rate(speed));
    const auto as_travel = unit_name(Measure::belt_travel, factor->factor, tolerance_of(*factor), sprocket_radius_m());
    const ScaleFactor other_way = inverse(*factor);
    const auto as_speed = unit_name(Measure::belt_speed, other_way.factor, tolerance_of(*factor), sprocket_radius_m());
    if (of_travel > of_speed)
      add(Severity::refuse, travel,
          fmt::format("is {} what {} adds up to{}", in_words(*factor), speed, what_it_looks_like(as_travel, "m")));
    else if (of_speed > of_travel)
      add(Severity::refuse, speed,
          fmt::format("is {} what {} says{}", in_words(other_way), travel, what_it_looks_like(as_speed, "m/s")));
    else
      add(Severity::refuse, travel,
          fmt::format("is {} what {} adds up to: one of the two has a wrong unit or scale", in_words(*factor), speed));
  }
}

void RunChecks::check_distance_factor() {
  const auto along = scale_factor(belts(0.5, 0.5), forward(kOnLevel_rad));
  if (!went_far(along, kFarEnough_m, kSeenAtAll_m) || kAlong.contains(1 / along->factor)) return;
  std::vector<std::string> tracks;
  for (const char* name : {"track_{}_mps", "track_{}_m", "cmd_track_{}_mps"})
    for (const std::string side : kSides)
      if (const std::string column = fmt::format(fmt::runtime(name), side); has(column)) tracks.push_back(column);
  if (found("x_m") || std::ranges::any_of(tracks, [this](const std::string& name) { return found(name); })) return;

  // In turns the tracks tell by themselves whether their speeds may be right: with a factor of their own, the robot
  // would turn more, or less, than any skid steering.
  const bool is_travel = has("track_left_m"), is_command = !is_travel && !has("track_left_mps");
  const Measure measure = is_travel && !has("track_left_mps") ? Measure::belt_travel : Measure::belt_speed;
  const auto as_tracks = unit_name(measure, along->factor, kSlipOfUnit, sprocket_radius_m());
  const auto as_pose = unit_name(Measure::place, 1 / along->factor, kSlipOfUnit, std::nullopt);
  double against_tracks = 0, against_pose = 0;
  if (robot_ != nullptr) {
    const Course turned = has("gyro_z_radps") ? rate("gyro_z_radps") : upright_angle("yaw_rad", kOnLevel_rad);
    const auto turning = scale_factor(turned, belts(-1, 1));
    if (is_certain(turning)) {
      const double grip = turning->factor * robot_->track_gauge_m();
      against_tracks = distance_from(kUsualTurning, grip);
      against_pose = distance_from(kUsualTurning, grip * along->factor);
    }
  }
  const bool is_known = (as_tracks && as_tracks->is_known) || (as_pose && as_pose->is_known);
  const auto severity = is_known || !kCertainAlong.contains(1 / along->factor) ? Severity::refuse : Severity::warn;

  // The columns of the tracks have the same unit where they agree with each other.
  std::string others;
  for (std::size_t i = 1; i < tracks.size(); ++i) {
    const bool is_commanded = tracks[i].starts_with("cmd_");
    if (is_commanded && !is_command && found("cmd_track_left_mps")) continue;
    others += (i + 1 == tracks.size() ? " and " : ", ") + tracks[i];
  }
  const std::string& first = tracks.front();
  if (against_pose > against_tracks)
    return add(severity, "x_m",
               fmt::format("is {} what the tracks say, with y_m{}", in_words(inverse(*along)),
                           what_it_looks_like(as_pose, "m")));
  if (against_tracks > against_pose || (as_tracks && as_tracks->is_known && !(as_pose && as_pose->is_known)))
    return add(severity, first,
               fmt::format("is {} what the pose says, with{}{}", in_words(*along),
                           others.starts_with(",") ? others.substr(1) : others,
                           what_it_looks_like(as_tracks, measure == Measure::belt_speed ? "m/s" : "m")));
  add(severity, first,
      fmt::format("is {} what the pose says: the tracks, or x_m and y_m, have a wrong unit or scale{}",
                  in_words(*along), as_tracks ? "; speeds of tracks would be " + as_tracks->words : ""));
}

void RunChecks::check_command_factor() {
  // Commands of both tracks share their unit: a track alone may be dragged, blocked or limited.
  std::vector<std::pair<std::string, ScaleFactor>> sides;
  double most_asked_m = 0;
  for (const std::string side : kSides) {
    const std::string command = "cmd_track_" + side + "_mps", speed = "track_" + side + "_mps",
                      travel = "track_" + side + "_m";
    if (found(command) || found(speed) || found(travel)) return;
    const Course asked = rate(command);
    const auto itself = scale_factor(asked, asked);
    if (!itself) continue;
    most_asked_m = std::max(most_asked_m, itself->first_change);
    const auto factor = scale_factor(asked, has(speed) ? rate(speed) : adding(travel));
    if (!went_far(factor, kFarEnough_m, kSeenAtAll_m)) {
      if (itself->first_change > kFarEnough_m) return;
      continue;
    }
    sides.emplace_back(command, *factor);
  }
  std::erase_if(sides, [&](const auto& side) { return side.second.first_change < kIdle * most_asked_m; });
  if (sides.empty()) return;

  const ScaleFactor& factor = sides.front().second;
  const ScaleFactor& other = sides.back().second;
  if (std::abs(std::log(factor.factor / other.factor)) > std::log(1.5)) return;
  if (kCommanded.contains(factor.factor) || kCommanded.contains(other.factor)) return;
  const auto as_command = unit_name(Measure::belt_speed, factor.factor, tolerance_of(factor), sprocket_radius_m());
  const bool is_known = as_command && as_command->is_known;
  // Drives cannot go faster than commanded, but slower, at a limit that cuts commands of every size to one speed.
  const bool proportional = std::max(factor.levels, other.levels) >= kLevels &&
                            std::min(factor.correlation, other.correlation) >= kProportional;
  if (factor.factor > 1 && !proportional && !is_known) return;
  add(is_known || !kCertainCommand.contains(factor.factor) ? Severity::refuse : Severity::warn, sides.front().first,
      fmt::format("is {} what the track does{}{}", in_words(factor), sides.size() > 1 ? ", on both sides" : "",
                  what_it_looks_like(as_command, "m/s")));
}

void RunChecks::check_gyro_factor() {
  const auto factor = scale_factor(upright_angle("yaw_rad"), rate("gyro_z_radps"));
  if (!went_far(factor, kFarEnough_rad, kSeenAtAll_rad) || kSameTurn.contains(factor->factor)) return;
  if (found("yaw_rad") || found("gyro_z_radps")) return;
  const ScaleFactor other_way = inverse(*factor);
  const auto as_yaw = unit_name(Measure::angle, factor->factor, tolerance_of(*factor), std::nullopt);
  const auto as_gyro = unit_name(Measure::turn_rate, other_way.factor, tolerance_of(*factor), std::nullopt);

  // The tracks tell which of the two is no turn of a skid-steered robot.
  double against_yaw = 0, against_gyro = 0;
  if (robot_ != nullptr) {
    const auto grip = scale_factor(rate("gyro_z_radps"), belts(-1, 1));
    if (is_certain(grip)) {
      against_gyro = distance_from(kUsualTurning, grip->factor * robot_->track_gauge_m());
      against_yaw = distance_from(kUsualTurning, grip->factor * robot_->track_gauge_m() * factor->factor);
    }
  }
  const auto severity =
      (as_yaw && as_yaw->is_known) || (as_gyro && as_gyro->is_known) || !kCertainTurn.contains(factor->factor)
          ? Severity::refuse
          : Severity::warn;
  if (against_gyro > against_yaw)
    add(severity, "gyro_z_radps",
        fmt::format("is {} what yaw_rad says{}", in_words(other_way), what_it_looks_like(as_gyro, "rad/s")));
  else if (against_yaw > against_gyro)
    add(severity, "yaw_rad",
        fmt::format("is {} what gyro_z_radps says{}", in_words(*factor), what_it_looks_like(as_yaw, "rad")));
  else
    add(severity, "yaw_rad",
        fmt::format("is {} what gyro_z_radps says: one of the two has a wrong unit or scale{}", in_words(*factor),
                    as_gyro ? "; the gyro would be in " + as_gyro->words : ""));
}

void RunChecks::check_turn_factor() {
  if (robot_ == nullptr || found("yaw_rad") || found("gyro_z_radps")) return;
  for (const std::string side : kSides)
    if (found("track_" + side + "_mps") || found("track_" + side + "_m") || found("cmd_track_" + side + "_mps")) return;
  const std::string name = has("gyro_z_radps") ? "gyro_z_radps" : "yaw_rad";
  const Course turned = has("gyro_z_radps") ? rate(name) : upright_angle(name, kOnLevel_rad);
  const auto turning = scale_factor(turned, belts(-1, 1));
  if (!is_certain(turning) || turning->first_change < kSeenAtAll_rad || turning->second_change < kFarEnough_m) return;
  const double gauge_m = robot_->track_gauge_m();
  ScaleFactor grip = *turning;
  grip.factor *= gauge_m, grip.standard_error *= gauge_m;
  if (kTurning.contains(grip.factor)) return;
  // The unit shows through any usual slip.
  const auto fits = [&](double of_unit) { return kUsualTurning.contains(grip.factor / of_unit); };
  const char* unit = fits(180 / std::numbers::pi)                         ? ", or it is in degrees"
                     : has("gyro_z_radps") && fits(30 / std::numbers::pi) ? ", or it is in rpm"
                                                                          : "";
  add(kCertainTurning.contains(grip.factor) ? Severity::warn : Severity::refuse, name,
      fmt::format("is {} the turn of belts that do not slip, {:.3g} m apart; skid steering has 0.3 to 1.1: the tracks' "
                  "distance in the robot's description is wrong, or the unit of this column or of the tracks{}",
                  in_words(grip), gauge_m, unit));
}

void RunChecks::check_factors() {
  check_travel_factor();
  check_distance_factor();
  check_command_factor();
  check_gyro_factor();
  check_turn_factor();
}

}  // namespace kenaf::gap::logs
