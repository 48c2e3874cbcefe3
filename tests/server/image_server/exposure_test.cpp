// When pictures are taken, by hand: at 30 Hz and 1 ms a step, tick k is at 33.33 k ms, so at step 0, 34, 67, 100, 134.
#include "server/image_server/exposure.hpp"

#include <catch2/catch.hpp>

namespace kenaf::image_server {

TEST_CASE("A tick is exposed at the first step at or after it") {
  for (const auto& [tick, step] : {std::pair<Tick, std::uint64_t>{0, 0}, {1, 34}, {2, 67}, {3, 100}, {4, 134}}) {
    CHECK(step_of(tick, 0.001, 30) == step);
    CHECK(tick_at(step, 0.001, 30) == tick);
    if (step > 0) CHECK(tick_at(step - 1, 0.001, 30) == tick - 1);
  }
  // a day later it still is
  CHECK(step_of(30 * 86400, 0.001, 30) == 86400000);
  CHECK(tick_at(86400000, 0.001, 30) == 30 * 86400);
  // twice a step and more: each step is exposed, once
  for (std::uint64_t step = 0; step < 100; ++step) CHECK(step_of(tick_at(step, 0.02, 120), 0.02, 120) == step);
}

TEST_CASE("The next exposure is the next tick of any camera, at once for one that has none yet") {
  CHECK(next_exposure({{30, 0}}, 0, 0.001) == 34);
  CHECK(next_exposure({{30, 0}}, 33, 0.001) == 34);
  CHECK(next_exposure({{30, 0}}, 34, 0.001) == 34);
  CHECK(next_exposure({{30, 1}}, 34, 0.001) == 67);
  CHECK(next_exposure({{30, 0}}, 40, 0.001) == 67);  // late: the tick at 34 is left out
  CHECK(next_exposure({{30, 0}, {100, 0}}, 5, 0.001) == 10);
  CHECK(next_exposure({{30, 3}, {30, std::nullopt}}, 101, 0.001) == 101);
  CHECK(next_exposure({{30, 700}}, 0, 0.001) == 0);  // after a reset
  CHECK(next_exposure({{120, 0}}, 0, 0.02) == 1);
  for (std::uint64_t step = 1; step < 300; ++step) {
    const std::uint64_t next = next_exposure({{30, tick_at(step, 0.001, 30)}}, step, 0.001);
    CHECK(next > step);
    CHECK(exposes_at({30, tick_at(step, 0.001, 30)}, next, 0.001));
  }
}

}  // namespace kenaf::image_server
