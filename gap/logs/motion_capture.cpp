#include "gap/logs/motion_capture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "physics/pose.hpp"

namespace kenaf::gap::logs {
namespace {

// Tolerance of a quaternion's norm, which may have been written with few digits.
constexpr double kNormTolerance = 0.01;
// Largest absolute place and angle of a robot, as kLatest_s of its times.
constexpr double kFarthest_m = 1e6, kLargest_rad = 1e6;

class Table {
 public:
  Table(const runs::Run& run, std::string_view name) : run_(run), name_(name) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw runs::RunFileError(fmt::format("{}:1:1: {}", name_, what));
  }
  bool has(const std::string& column) const { return !run_.column(column).empty(); }

  // A column that may have one of two names; `factor` converts to SI.
  struct Column {
    std::span<const double> values;
    double factor = 1;
  };
  std::optional<Column> either(const std::string& si, double si_factor, const std::string& other,
                               double other_factor) const {
    if (has(si) && has(other)) fail(fmt::format("contains both {} and {}; leave one of them out", si, other));
    if (has(si)) return Column{run_.column(si), si_factor};
    if (has(other)) return Column{run_.column(other), other_factor};
    return std::nullopt;
  }
  Column needed(const std::optional<Column>& column, const std::string& names) const {
    if (run_.row_count() == 0) fail("has no rows");
    if (!column) fail(fmt::format("no column {}; the first line names the columns", names));
    return *column;
  }

 private:
  const runs::Run& run_;
  std::string_view name_;
};

}  // namespace

MotionCapture parse_motion_capture(std::string_view text, std::string_view name_for_errors, LengthUnit unit) {
  return motion_capture_of(runs::parse_run(text, name_for_errors), name_for_errors, unit);
}

MotionCapture motion_capture_of(const runs::Run& table, std::string_view name_for_errors, LengthUnit unit) {
  using Column = Table::Column;
  const Table in(table, name_for_errors);
  // Finds the columns, whichever unit and form of rotation they have.
  const auto length = [&](const std::string& axis) {
    return in.either(axis + "_m", unit == LengthUnit::millimetres ? 1e-3 : 1, axis + "_mm", 1e-3);
  };
  const auto angle = [&](const std::string& axis) {
    return in.either(axis + "_rad", 1, axis + "_deg", std::numbers::pi / 180);
  };
  const Column x = in.needed(length("x"), "x_m"), y = in.needed(length("y"), "y_m");
  const std::optional<Column> z = length("z"), roll = angle("roll"), pitch = angle("pitch"), yaw = angle("yaw");
  const bool quaternion = in.has("qx") && in.has("qy") && in.has("qz") && in.has("qw");
  if (quaternion && (roll || pitch || yaw)) in.fail("contains both a quaternion and angles; leave one of them out");
  if (!quaternion && !yaw)
    in.fail("contains neither yaw_rad nor qx, qy, qz, qw: a pose without a heading cannot be merged");
  if (roll.has_value() != pitch.has_value()) in.fail("contains only one of roll and pitch");

  // The columns of a pose, in order; the rotation's come last.
  std::vector<Column> columns{x, y};
  if (z) columns.push_back(*z);
  const std::size_t rotation = columns.size();
  if (quaternion) {
    for (const char* name : {"qw", "qx", "qy", "qz"}) columns.push_back({table.column(name), 1});
  } else {
    columns.push_back(*yaw);
    if (roll) columns.insert(columns.end(), {*roll, *pitch});
  }

  MotionCapture capture{{}, z.has_value(), quaternion || roll.has_value()};
  const auto t_s = table.column("t_s");
  std::vector<double> cell(columns.size());
  for (std::size_t row = 0; row < t_s.size(); ++row) {
    // A row in which any of them is empty is no measurement.
    bool measured = true;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      cell[i] = columns[i].values[row] * columns[i].factor;
      measured = measured && !std::isnan(cell[i]);
    }
    if (!measured) continue;
    const auto refuse = [&](const std::string& what) {
      throw runs::RunFileError(fmt::format("{}:{}:1: {}", name_for_errors, table.first_line + row, what));
    };

    // Refuses values that no robot has, and a quaternion that is no rotation.
    CapturedPose pose{t_s[row], {cell[0], cell[1], z ? cell[2] : 0}, Eigen::Quaterniond::Identity()};
    if (std::abs(pose.t_s) > kLatest_s || pose.p_m.cwiseAbs().maxCoeff() > kFarthest_m)
      refuse("an implausible time or position");
    const double* const q = cell.data() + rotation;
    if (quaternion) {
      pose.q = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
      if (!(std::abs(pose.q.norm() - 1) <= kNormTolerance))
        refuse(
            fmt::format("qx, qy, qz, qw are not a rotation: their norm is {:.3g}, not 1; leave the cells empty where "
                        "nothing was measured",
                        pose.q.norm()));
      pose.q.normalize();
    } else {
      const Eigen::Vector3d rpy(roll ? q[1] : 0, roll ? q[2] : 0, q[0]);
      if (rpy.cwiseAbs().maxCoeff() > kLargest_rad) refuse("an implausible angle");
      pose.q = physics::rotation_from(rpy);
    }
    capture.poses.push_back(pose);
  }
  if (capture.poses.size() < 2) in.fail("fewer than two rows have a whole pose");
  return capture;
}

}  // namespace kenaf::gap::logs
