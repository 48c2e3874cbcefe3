// How large a gap is, by hand.
#include "gap/diagnose/gap_size.hpp"

#include <catch2/catch.hpp>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;
using test::WorldChannel;

namespace {

// The rms of each channel in noise; those that are not named have none.
Whole in_channels(double battery, double track) {
  // 48 bins of each channel
  return world().in_channel(WorldChannel::battery, battery * std::sqrt(48.0)) +
         world().in_channel(WorldChannel::track, track * std::sqrt(48.0));
}

KindSquares squares(const Whole& differences, const std::vector<std::vector<bool>>& counted = {}) {
  return squares_by_kind(world().features, world().floor(), world().by_run(differences), counted);
}

double share(const Whole& before, const Whole& after) {
  const std::vector<double> weights = kind_weights(squares(before), no_squares());
  return explained_share(weighted_rms(squares(before), weights), weighted_rms(squares(after), weights), 1);
}

}  // namespace

TEST_CASE("Squares are summed kind by kind, of the bins that count") {
  const std::size_t track = kind_of(0), battery = kind_of(14);
  const KindSquares all = squares(in_channels(3, 2));
  CHECK(all.bins[track] == 48);
  CHECK(all.sum[track] == Approx(48 * 4));
  CHECK(all.sum[battery] == Approx(48 * 9));
  // of four runs alike, all of the first, and nothing of the others
  std::vector<std::vector<bool>> of_first;
  for (const StageFeatures& run : world().features) of_first.emplace_back(run.bins.size(), of_first.empty());
  const KindSquares first = squares(in_channels(3, 2), of_first);
  CHECK(first.bins[track] == 12);
  CHECK(first.sum[track] == Approx(12 * 4));
}

TEST_CASE("Bins that one repeat alone has say nothing of how repeats differ") {
  // deviations of 2 in the first half of each run, the only one that its repeat has, too
  Deviations repeats{world().by_run(in_channels(2, 2)), {}};
  for (std::size_t r = 0; r < repeats.of_runs.size(); ++r) {
    std::vector<bool>& shared = repeats.shared.emplace_back();
    for (const Bin& bin : world().features[r].bins) shared.push_back(bin.span % 2 == 0);
    for (std::size_t b = 0; b < shared.size(); ++b)
      if (!shared[b]) repeats.of_runs[r][static_cast<Eigen::Index>(b)] = 0;
  }
  const KindSquares floor = squares_of_floor(world().features, world().floor(), repeats);
  const std::size_t track = kind_of(0), pose = kind_of(LinearWorld::channel_of("x_m"));
  CHECK(floor.sum[track] / floor.bins[track] == Approx(4));
  CHECK(floor.sum[pose] / floor.bins[pose] == Approx(1));  // repeats agree there beyond noise: noise is the floor
}

TEST_CASE("A kind that is off by 300 times its noise does not hide one that is off by 20 times its own") {
  // each counts by its own gap, so half of all: to explain the one is as good as to explain the other
  CHECK(share(in_channels(300, 20), in_channels(300, 1)) == Approx(0.5).margin(0.005));
  CHECK(share(in_channels(300, 20), in_channels(1, 20)) == Approx(0.5).margin(0.005));
  CHECK(share(in_channels(300, 20), in_channels(1, 1)) == Approx(1).margin(0.005));
  CHECK(share(in_channels(300, 20), in_channels(300, 20)) == 0);
}

TEST_CASE("A bin's weight is what of its kind is a gap, over its square") {
  // mean squares of 9 and 4, of which noise has 1; the pose has none
  const std::vector<double> weights = kind_weights(squares(in_channels(3, 2)), no_squares());
  CHECK(weights[kind_of(14)] == Approx(8.0 / 81));
  CHECK(weights[kind_of(0)] == Approx(3.0 / 16));
  CHECK(weights[kind_of(15)] == 0);
  // repeats that differ by as much as a kind is off leave it no gap
  CHECK(kind_weights(squares(in_channels(3, 2)), squares(in_channels(1, 2)))[kind_of(0)] == 0);
  // without any gap all bins count once
  for (const double weight : kind_weights(squares(in_channels(1, 0.5)), no_squares())) CHECK(weight == 1);
}

TEST_CASE("A weighted root mean square is that of the kinds that count") {
  std::vector<double> weights(kind_count(), 0);
  weights[kind_of(14)] = 1;
  CHECK(weighted_rms(squares(in_channels(3, 2)), weights) == Approx(3));
  weights[kind_of(0)] = 3;
  CHECK(weighted_rms(squares(in_channels(3, 2)), weights) == Approx(std::sqrt((9 + 3 * 4) / 4.0)));
  CHECK(weighted_rms(no_squares(), weights) == 0);
}

TEST_CASE("Shrink: the share of what was beyond the floor that is gone") {
  CHECK(shrink(3, 1, 1) == Approx(1));
  CHECK(shrink(3, 3, 1) == Approx(0));
  CHECK(shrink(3, 2, 1) == Approx(0.5));
  CHECK(shrink(3, 4, 1) == Approx(-0.5));  // worse than before
  CHECK(shrink(1, 0.9, 1) == 0);           // nothing to shrink
  CHECK(shrink(3, 0.5, 1) == 1);
}

TEST_CASE("A share of squares, at most all of them") {
  CHECK(explained_share(5, 3, 1) == Approx(16.0 / 24));
  CHECK(explained_share(5, 1, 1) == Approx(1));
  CHECK(explained_share(5, 0.2, 1) == 1);
  CHECK(explained_share(5, 6, 1) == Approx(-11.0 / 24));
  CHECK(explained_share(1, 3, 1) == 0);
}
