#include "server/world_server/frame_schedule.hpp"

#include <catch2/catch.hpp>

namespace kenaf::world_server {

using Answer = FrameSchedule::Answer;

TEST_CASE("Frames are numbered from 1 and one period apart") {
  FrameSchedule schedule;
  schedule.start(100, 10, true);
  CHECK(schedule.due(100));
  schedule.begin_frame(100);
  CHECK(schedule.frame() == 1);
  CHECK_FALSE(schedule.due(109));
  CHECK(schedule.due(110));
  schedule.begin_frame(110);
  CHECK(schedule.frame() == 2);
}

TEST_CASE("An answer to the newest frame is in time, one to an older frame late, one to a coming frame is none") {
  FrameSchedule schedule;
  schedule.start(0, 10, true);
  schedule.begin_frame(0);
  schedule.begin_frame(10);
  CHECK(schedule.take_answer(2, true) == Answer::in_time);
  CHECK(schedule.late() == 0);
  CHECK(schedule.take_answer(1, true) == Answer::late);
  CHECK(schedule.take_answer(0, true) == Answer::late);
  CHECK(schedule.late() == 2);
  CHECK(schedule.take_answer(3, true) == Answer::ahead);
  CHECK(schedule.late() == 2);
}

TEST_CASE("An answer is counted as late once, by the DRIVE that ends it") {
  FrameSchedule schedule;
  schedule.start(0, 10, true);
  schedule.begin_frame(0);
  schedule.begin_frame(10);
  CHECK(schedule.take_answer(1, false) == Answer::late);
  CHECK(schedule.take_answer(1, true) == Answer::late);
  CHECK(schedule.late() == 1);
}

TEST_CASE("Lock step holds the beginning of the next frame until a DRIVE ends the answer") {
  FrameSchedule schedule;
  schedule.set_lockstep(true);
  schedule.start(0, 10, true);
  CHECK(schedule.due(0));  // nothing was asked yet
  schedule.begin_frame(0);
  CHECK_FALSE(schedule.holds(9));
  CHECK(schedule.holds(10));
  CHECK_FALSE(schedule.due(10));
  schedule.take_answer(1, false);
  CHECK(schedule.holds(10));
  schedule.take_answer(1, true);
  CHECK_FALSE(schedule.holds(10));
  CHECK(schedule.due(10));
}

TEST_CASE("Lock step lets go after a time, until the newest frame is answered") {
  FrameSchedule schedule;
  schedule.set_lockstep(true);
  schedule.start(0, 10, true);
  schedule.begin_frame(0);
  CHECK_FALSE(schedule.let_go(50.0, 0.25));
  CHECK(schedule.holds_since_wall_s() == 50.0);
  CHECK_FALSE(schedule.let_go(50.2, 0.25));
  CHECK(schedule.let_go(50.25, 0.25));
  schedule.begin_frame(10);
  schedule.begin_frame(20);
  CHECK_FALSE(schedule.holds(30));
  schedule.take_answer(2, true);  // late: not the newest
  CHECK_FALSE(schedule.holds(30));
  schedule.take_answer(3, true);
  schedule.begin_frame(30);
  CHECK(schedule.holds(40));
}

TEST_CASE("Plain outputs never hold the world") {
  FrameSchedule schedule;
  schedule.set_lockstep(true);
  schedule.start(0, 200, false);
  schedule.begin_frame(0);
  CHECK_FALSE(schedule.holds(200));
}

TEST_CASE("After the world was put back the numbers go on and the next frame comes at once") {
  FrameSchedule schedule;
  schedule.set_lockstep(true);
  schedule.start(500, 10, true);
  schedule.begin_frame(500);
  schedule.restart_at(0);
  CHECK(schedule.due(0));
  schedule.begin_frame(0);
  CHECK(schedule.frame() == 2);
  CHECK(schedule.holds(10));
}

}  // namespace kenaf::world_server
