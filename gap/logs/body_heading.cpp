#include "gap/logs/body_heading.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "gap/logs/run_checks.hpp"

namespace kenaf::gap::logs {
namespace {

// All chosen.
constexpr double kPiece_s = 6, kLevelGround_rad = 0.1;
constexpr std::size_t kFewestPieces = 3;
constexpr double kFewestWay_m = 2;
constexpr double kGoesWith = 0.8, kGoesApart = 0.5;
constexpr double kLeastOwn = 0.1;  // share of the belts' motion that does not go with the turns
constexpr double kOdd_rad = 15 * std::numbers::pi / 180, kWrong_rad = 45 * std::numbers::pi / 180;
constexpr double kInDegrees = 180 / std::numbers::pi;

HeadingPiece sum_of(const std::vector<HeadingPiece>& pieces) {
  HeadingPiece sum;
  for (const HeadingPiece& piece : pieces) {
    sum.belts += piece.belts, sum.turn += piece.turn, sum.forward += piece.forward, sum.left += piece.left;
    sum.mirrored += piece.mirrored, sum.belts_turn += piece.belts_turn, sum.belts_forward += piece.belts_forward;
    sum.belts_left += piece.belts_left, sum.belts_mirrored += piece.belts_mirrored;
    sum.turn_forward += piece.turn_forward, sum.turn_left += piece.turn_left, sum.way_m += piece.way_m;
  }
  return sum;
}

// The way that the belts carry the robot, without what goes with its turns: with b' = b - t sum bt / sum tt, the part
// of the belts' rate that does not go with the turn rate, sum b' forward and sum b' left.
struct Way {
  double forward, left;
};
Way way_of(const HeadingPiece& piece, double belts_by_turn) {
  return {piece.belts_forward - belts_by_turn * piece.turn_forward, piece.belts_left - belts_by_turn * piece.turn_left};
}

}  // namespace

std::vector<HeadingPiece> RunChecks::heading_pieces() const {
  const Course belt = belts(0.5, 0.5), ahead = along(0, 1, kLevelGround_rad),
               aside = along(std::numbers::pi / 2, 1, kLevelGround_rad), mirrored = along(0, -1, kLevelGround_rad),
               heading = upright_angle("yaw_rad", kLevelGround_rad);
  if (belt.t_s.size() < 2 || ahead.t_s.size() < 2) return {};
  const double window_s =
      comparing_window_s(std::max(median_step(belt.t_s, belt.t_s), median_step(ahead.t_s, ahead.t_s)));
  const double step_s = window_s / kStepsPerWindow;
  std::map<long, HeadingPiece> pieces;
  double next_s = belt.t_s.front();
  for (const double t_s : belt.t_s) {
    if (t_s < next_s) continue;
    next_s = t_s + step_s;
    const double b = mean_rate(belt, t_s, window_s), f = mean_rate(ahead, t_s, window_s),
                 l = mean_rate(aside, t_s, window_s), m = mean_rate(mirrored, t_s, window_s),
                 w = mean_rate(heading, t_s, window_s);
    if (std::isnan(b + f + l + m + w)) continue;
    HeadingPiece& piece = pieces[std::lround(std::floor((t_s - belt.t_s.front()) / kPiece_s))];
    piece.belts += b * b, piece.forward += f * f, piece.left += l * l, piece.mirrored += m * m;
    piece.turn += w * w, piece.belts_turn += b * w, piece.turn_forward += w * f, piece.turn_left += w * l;
    piece.belts_forward += b * f, piece.belts_left += b * l, piece.belts_mirrored += b * m;
    piece.way_m += std::abs(b) * step_s;
  }
  std::vector<HeadingPiece> result;
  for (const auto& [number, piece] : pieces) result.push_back(piece);
  return result;
}

void BodyHeading::look_at(const runs::Run& run) {
  RunChecks checks(run, "", nullptr);
  checks.check_wraps();
  const std::vector<HeadingPiece> pieces = checks.heading_pieces();
  pieces_.insert(pieces_.end(), pieces.begin(), pieces.end());
}

std::vector<Finding> BodyHeading::findings() const {
  const HeadingPiece sum = sum_of(pieces_);
  if (pieces_.size() < kFewestPieces || sum.way_m < kFewestWay_m) return {};
  const auto correlation = [](double product, double first, double second) {
    return first > 0 && second > 0 ? product / std::sqrt(first * second) : 0;
  };

  const double as_read = correlation(sum.belts_forward, sum.belts, sum.forward),
               mirrored = correlation(sum.belts_mirrored, sum.belts, sum.mirrored);
  if (mirrored >= kGoesWith && as_read <= kGoesApart)
    return {{Finding::Severity::refuse, "dataset.toml", 0, "y_m",
             fmt::format("is mirrored against yaw_rad: with the other sign the pose goes where the tracks carry it "
                         "(correlation {:.2f}, as it is {:.2f}); x is forward at the start, y left, z up and yaw "
                         "positive to the left: turn the sign of y_m",
                         mirrored, as_read)}};

  // The angle, where the way in the plane goes with the belts, and those not with the turns alone.
  const double together = std::hypot(sum.belts_forward, sum.belts_left);
  if (correlation(together, sum.belts, sum.forward + sum.left) < kGoesWith) return {};
  const double belts_by_turn = sum.turn > 0 ? sum.belts_turn / sum.turn : 0;
  if (sum.belts - belts_by_turn * sum.belts_turn < kLeastOwn * sum.belts) return {};
  const Way way = way_of(sum, belts_by_turn);
  const double angle_rad = std::atan2(way.left, way.forward);
  const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  // Across that way the pose moves with the turns alone; what is left of it in each piece is scatter.
  const double across_by_turn = sum.turn > 0 ? (sum.turn_left * cosine - sum.turn_forward * sine) / sum.turn : 0;
  double scatter = 0;
  for (const HeadingPiece& piece : pieces_) {
    const Way of_piece = way_of(piece, belts_by_turn);
    scatter += std::pow(of_piece.left * cosine - of_piece.forward * sine -
                            across_by_turn * (piece.belts_turn - belts_by_turn * piece.turn),
                        2);
  }
  const double error_rad = std::sqrt(scatter) / std::hypot(way.forward, way.left);
  const double certain_rad = std::abs(angle_rad) - 2 * error_rad;
  if (certain_rad < kOdd_rad) return {};
  return {{certain_rad < kWrong_rad ? Finding::Severity::warn : Finding::Severity::refuse, "dataset.toml", 0, "yaw_rad",
           fmt::format("is not where the robot's front points: the tracks carry it {:.0f} degrees further {} (standard "
                       "error {:.1g}); yaw_rad must be the heading of the body in the frame of x_m and y_m: add {:.3g} "
                       "rad to it",
                       std::abs(angle_rad) * kInDegrees, angle_rad > 0 ? "left" : "right", error_rad * kInDegrees,
                       angle_rad)}};
}

}  // namespace kenaf::gap::logs
