#include "gap/diagnose/curve_fit.hpp"

#include <algorithm>
#include <limits>

namespace kenaf::gap::diagnose {
namespace {

// Between two neighbouring points of a curve, from `a` (share 0) to `b` (share 1).
struct Segment {
  CurvePoint a, b;
  bool jumps() const { return b.jump; }
};

constexpr double kEnds[] = {0, 1};  // of a segment

double gap_product(const Products& p, int column) {
  return column < 0 ? 0 : p.shift_gap[column];
}
double shift_product(const Products& p, int i, int j) {
  return i < 0 || j < 0 ? 0 : p.shift_shift(i, j);
}

// squared residual = constant - 2 linear . s + s . square s for shares s of the segments, each in [0, 1]
struct Quadratic {
  double constant;
  double linear[2];
  double square[2][2];
  double at(double s, double t) const {
    return constant - 2 * (linear[0] * s + linear[1] * t) + square[0][0] * s * s + 2 * square[0][1] * s * t +
           square[1][1] * t * t;
  }
};

// Optimum of one term, clamped to the segment: linear / square.
double best_share(double linear, double square) {
  return square > 0 ? std::clamp(linear / square, 0.0, 1.0) : 0;
}

// For a segment that jumps, the better end.
double best_share_of(const Segment& segment, const Quadratic& q) {
  if (segment.jumps()) return q.at(1, 0) < q.at(0, 0) ? 1 : 0;
  return best_share(q.linear[0], q.square[0][0]);
}

OnCurve on_segment(std::size_t curve, const Segment& segment, double share) {
  return {curve,
          segment.a.value + share * (segment.b.value - segment.a.value),
          {segment.a.column, segment.b.column},
          {1 - share, share},
          segment.b.value - segment.a.value};
}

}  // namespace

Products products_of(const std::vector<GroupWhitener>& whiteners, const std::vector<Eigen::MatrixXd>& shifts,
                     const GroupVectors& target) {
  std::vector<Eigen::MatrixXd> columns;
  for (std::size_t g = 0; g < target.size(); ++g) {
    columns.emplace_back(target[g].size(), shifts[g].cols() + 1);
    columns.back() << shifts[g], target[g];
  }
  const Eigen::MatrixXd all = inner_products(whiteners, columns);
  const Eigen::Index count = all.cols() - 1;
  return {all(count, count), all.col(count).head(count), all.topLeftCorner(count, count)};
}

OnCurve at_value(const std::vector<EffectCurve>& curves, std::size_t curve, double value) {
  const std::vector<CurvePoint>& points = curves[curve].points;
  // the segment around the value; beyond an end of the curve the outermost one, extrapolated
  auto above = std::ranges::lower_bound(points, value, {}, &CurvePoint::value);
  if (above == points.begin()) ++above;
  if (above == points.end()) --above;
  const Segment segment{*(above - 1), *above};
  const double share = (value - segment.a.value) / (segment.b.value - segment.a.value);
  if (!segment.jumps()) return on_segment(curve, segment, share);

  // the segment before or after the jump
  if (share < 0.5 && above - 1 != points.begin()) {
    const Segment before{*(above - 2), *(above - 1)};
    if (!before.jumps()) return on_segment(curve, before, 1);
  } else if (share >= 0.5 && above + 1 != points.end()) {
    const Segment behind{*above, *(above + 1)};
    if (!behind.jumps()) return on_segment(curve, behind, 0);
  }
  const CurvePoint& end = share < 0.5 ? segment.a : segment.b;
  return on_segment(curve, {end, end}, 0);
}

CurveFit fit_one(const Products& p, const std::vector<EffectCurve>& curves, std::size_t curve) {
  CurveFit best{{}, std::numeric_limits<double>::infinity()};
  const std::vector<CurvePoint>& points = curves[curve].points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    // on a segment a + s (b - a): |gap|^2 - 2 s (gap - a).(b - a) + s^2 |b - a|^2, with the optimum clamped to [0, 1]
    const Segment segment{points[i - 1], points[i]};
    const int a = segment.a.column, b = segment.b.column;
    const double aa = shift_product(p, a, a), ab = shift_product(p, a, b), bb = shift_product(p, b, b);
    const Quadratic q{p.gap_gap - 2 * gap_product(p, a) + aa,
                      {gap_product(p, b) - gap_product(p, a) - ab + aa, 0},
                      {{aa - 2 * ab + bb, 0}, {0, 0}}};
    const double share = best_share_of(segment, q);
    if (const double left = q.at(share, 0); left < best.left) {
      const OnCurve place = on_segment(curve, segment, share);
      best = {{segment.jumps() ? at_value(curves, curve, place.value) : place}, left};
    }
  }
  return best;
}

CurveFit fit_two(const Products& p, const std::vector<EffectCurve>& curves, std::size_t first, std::size_t second) {
  CurveFit best{{}, std::numeric_limits<double>::infinity()};
  const auto &one = curves[first].points, &two = curves[second].points;
  for (std::size_t i = 1; i < one.size(); ++i)
    for (std::size_t j = 1; j < two.size(); ++j) {
      const Segment s{one[i - 1], one[i]}, t{two[j - 1], two[j]};
      const int a = s.a.column, b = s.b.column, c = t.a.column, d = t.b.column;
      const auto dot = [&](int x, int y) { return shift_product(p, x, y); };
      const auto dots = [&](int x, int y, int u, int v) { return dot(x, u) - dot(x, v) - dot(y, u) + dot(y, v); };
      // origin o = a + c, directions e = b - a and f = d - c
      const double o_gap = gap_product(p, a) + gap_product(p, c);
      const double oo = dot(a, a) + 2 * dot(a, c) + dot(c, c);
      const double oe = dot(a, b) - dot(a, a) + dot(c, b) - dot(c, a);
      const double of = dot(a, d) - dot(a, c) + dot(c, d) - dot(c, c);
      const double ef = dots(b, a, d, c);
      const Quadratic q{p.gap_gap - 2 * o_gap + oo,
                        {gap_product(p, b) - gap_product(p, a) - oe, gap_product(p, d) - gap_product(p, c) - of},
                        {{dots(b, a, b, a), ef}, {ef, dots(d, c, d, c)}}};

      // keeps the better of this and the best so far; a fit at a jump gets the slope beyond it
      const auto consider = [&](double share_s, double share_t) {
        const double left = q.at(share_s, share_t);
        if (left >= best.left) return;
        best = {{on_segment(first, s, share_s), on_segment(second, t, share_t)}, left};
        for (OnCurve& place : best.places)
          if ((&place == &best.places.front() ? s : t).jumps()) place = at_value(curves, place.curve, place.value);
      };

      // on a jump only its ends are allowed; the other effect is optimal given each end
      if (s.jumps() || t.jumps()) {
        for (const double end : kEnds)
          if (s.jumps() && t.jumps())
            for (const double other_end : kEnds) consider(end, other_end);
          else if (s.jumps())
            consider(end, best_share(q.linear[1] - ef * end, q.square[1][1]));
          else
            consider(best_share(q.linear[0] - ef * end, q.square[0][0]), end);
        continue;
      }

      // the stationary point of both shares, if it is inside the square
      const double determinant = q.square[0][0] * q.square[1][1] - ef * ef;
      if (determinant > 1e-12 * q.square[0][0] * q.square[1][1]) {
        const double inner_s = (q.linear[0] * q.square[1][1] - q.linear[1] * ef) / determinant;
        const double inner_t = (q.linear[1] * q.square[0][0] - q.linear[0] * ef) / determinant;
        if (inner_s >= 0 && inner_s <= 1 && inner_t >= 0 && inner_t <= 1) {
          consider(inner_s, inner_t);
          continue;
        }
      }

      // else the optimum is on an edge: one share fixed at an end, the other optimal given it
      for (const double edge : kEnds) {
        consider(best_share(q.linear[0] - ef * edge, q.square[0][0]), edge);
        consider(edge, best_share(q.linear[1] - ef * edge, q.square[1][1]));
      }
    }
  return best;
}

CurveFit fit_together(const Products& p, const std::vector<EffectCurve>& curves, std::span<const std::size_t> effects) {
  constexpr int kMostTurns = 50;
  constexpr double kGained = 1e-6;  // share of the squared residual that a round must gain to be followed by another

  // exact for one and two effects
  if (effects.size() == 1) return fit_one(p, curves, effects[0]);
  CurveFit fit = fit_two(p, curves, effects[0], effects[1]);
  if (effects.size() == 2) return fit;

  // a start for more: each further effect fitted to the residual of the ones before
  for (std::size_t e = 2; e < effects.size(); ++e) {
    fit.places.push_back(fit_one(without_places(p, fit.places), curves, effects[e]).places.front());
    fit.left = left_with(p, fit.places);
  }

  // pairs in turn, the others fixed, until a whole round gains next to nothing
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const double before = fit.left;
    for (std::size_t a = 0; a < effects.size(); ++a)
      for (std::size_t b = a + 1; b < effects.size(); ++b) {
        std::vector<OnCurve> others;
        for (std::size_t e = 0; e < effects.size(); ++e)
          if (e != a && e != b) others.push_back(fit.places[e]);
        const CurveFit two = fit_two(without_places(p, others), curves, effects[a], effects[b]);
        if (two.left >= fit.left) continue;
        fit.places[a] = two.places[0];
        fit.places[b] = two.places[1];
        fit.left = two.left;
      }
    if (before - fit.left <= kGained * before) break;
  }
  return fit;
}

double left_with(const Products& p, std::span<const OnCurve> places) {
  double left = p.gap_gap;
  for (const OnCurve& one : places)
    for (std::size_t i = 0; i < 2; ++i) {
      left -= 2 * one.weight[i] * gap_product(p, one.column[i]);
      for (const OnCurve& two : places)
        for (std::size_t j = 0; j < 2; ++j)
          left += one.weight[i] * two.weight[j] * shift_product(p, one.column[i], two.column[j]);
    }
  return left;
}

Products without_places(const Products& p, std::span<const OnCurve> places) {
  Products rest = p;
  rest.gap_gap = left_with(p, places);
  for (const OnCurve& place : places)
    for (std::size_t i = 0; i < 2; ++i)
      if (place.column[i] >= 0) rest.shift_gap -= place.weight[i] * p.shift_shift.col(place.column[i]);
  return rest;
}

Eigen::VectorXd shift_at(const Eigen::MatrixXd& shifts, std::span<const OnCurve> places) {
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(shifts.rows());
  for (const OnCurve& place : places)
    for (std::size_t i = 0; i < 2; ++i)
      if (place.column[i] >= 0) shift += place.weight[i] * shifts.col(place.column[i]);
  return shift;
}

GroupVectors shift_of(const EffectCurves& curves, std::span<const OnCurve> places) {
  GroupVectors shift;
  for (const Eigen::MatrixXd& group : curves.shifts) shift.push_back(shift_at(group, places));
  return shift;
}

Settings settings_of(std::span<const OnCurve> places) {
  Settings settings;
  for (const OnCurve& place : places) settings.push_back({place.curve, place.value});
  return settings;
}

}  // namespace kenaf::gap::diagnose
