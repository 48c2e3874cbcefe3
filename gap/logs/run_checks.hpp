// Shared by the checks of plausibility.hpp: one run with its robot's limits, and the findings so far.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gap/logs/body_heading.hpp"
#include "gap/logs/course.hpp"
#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

inline constexpr std::array<const char*, 2> kSides = {"left", "right"};  // as in the columns of tracks
inline constexpr double kUpright_rad = 1;                                // chosen

// How well two quantities that should be equal go together, by their mean rates over windows of 0.2 s or more.
struct Relation {
  double ratio;          // of their root mean squares
  double correlation;    // without subtracting means
  double first, second;  // total variation of each: the sum of the sizes of its changes
};

class RunChecks {
 public:
  RunChecks(const runs::Run& run, std::string file, const physics::RobotDescription* robot)
      : run_(run), file_(std::move(file)), robot_(robot) {}

  void check_clock();    // must precede check_scales(): false times falsify all rates
  void check_wraps();    // must precede those below: jumps of travel falsify them
  void check_scales();   // units and signs of quantities that go together
  void check_factors();  // smaller factors between them; after check_scales()
  void check_ranges();   // impossible values
  void check_commands();
  void check_constants();
  void check_held();
  void check_pose();
  void check_drift();   // of the pose's clock; long
  void check_replay();  // whether a simulation can repeat it; after all others

  // How the belts and the pose's travel go together on level ground, in pieces of a few seconds; after check_wraps().
  std::vector<HeadingPiece> heading_pieces() const;

  std::vector<Finding> take() { return std::exchange(findings_, {}); }

 private:
  using Severity = Finding::Severity;
  std::span<const double> column(const std::string& name) const { return run_.column(name); }
  bool has(const std::string& name) const;  // with at least one value
  std::size_t line(std::size_t row) const { return run_.first_line + row; }
  void add(Severity severity, const std::string& name, const std::string& text, std::size_t at_line = 0) {
    findings_.push_back({severity, file_, at_line, name, text});
  }
  bool found(const std::string& name) const;  // has a finding already
  bool refused(const std::string& name) const;

  Course adding(const std::string& name) const;  // of an accumulated column: travel, an angle
  // Unwrapped roll, pitch or yaw while the robot is upright: near pitch pi/2 yaw jumps, and upside down the angles
  // turn the other way.
  Course upright_angle(const std::string& name, double most_tilt_rad = kUpright_rad,
                       double units_in_a_radian = 1) const;  // of roll, pitch and yaw in the file
  // For each row, by the newest roll and pitch of the pose, or else of the orientation sensor, if there are any.
  std::vector<bool> upright(double most_tilt_rad = kUpright_rad) const;
  Course rate(const std::string& name) const;             // of a column of rates
  Course forward(double most_tilt_rad = INFINITY) const;  // travel of the pose along its heading
  // Travel of the pose along a direction that is fixed to its heading. `y_sign`: -1 reads y as mirrored.
  Course along(double left_of_heading_rad, double y_sign, double most_tilt_rad) const;
  Course belts(double left, double right) const;  // weighted sum of both tracks: measured, else commanded
  std::optional<Relation> relate(const Course& first, const Course& second) const;
  // Compares values about their means instead of rates, as a slow servo follows in value and not in rate. An empty cell
  // holds the value before it. `first` and `second` are the ranges of the two.
  std::optional<Relation> relate_values(const std::string& name, const std::string& other) const;
  double distance_of_belts() const;    // path length, to and fro, of the belt that goes farther
  double farthest_from_start() const;  // largest distance of the pose from its start, in the plane

  void check_same_length(const std::string& name, const std::string& other, const std::optional<Relation>& relation);
  void check_same_angle(const std::string& name, const std::string& other, const std::optional<Relation>& relation,
                        double enough, double least_factor);
  void check_turned_sign(const std::string& name, const std::string& other, const std::optional<Relation>& relation,
                         double enough_first, double enough_second, const std::string& what_to_do);
  void check_pose_against_tracks();
  void check_coarse_degrees();
  // `on_level` is the same relation on level ground only. The ratio of a robot that obeys its tracks lies between
  // `least_ratio` and `most_ratio`.
  void check_against_tracks(const std::string& name, const std::optional<Relation>& relation,
                            const std::optional<Relation>& on_level, double enough, double least_ratio,
                            double most_ratio, const std::string& what_to_do);
  // Each compares two quantities and names the one that the others contradict, or both.
  void check_travel_factor();    // travel against speed of a track
  void check_command_factor();   // commands against speeds
  void check_distance_factor();  // tracks against the pose's path
  void check_gyro_factor();      // gyro against yaw
  void check_turn_factor();      // tracks against turns of the body
  std::optional<double> sprocket_radius_m() const;
  bool turns() const;  // by its gyro, or without one by its measured tracks

  const runs::Run& run_;
  std::string file_;
  const physics::RobotDescription* robot_;
  std::vector<Finding> findings_;
  bool travel_wraps_ = false;  // then speeds stand for the tracks
};

}  // namespace kenaf::gap::logs
