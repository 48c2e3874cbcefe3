#include "formats/protocol/log_limiter.hpp"

#include <catch2/catch.hpp>

using kenaf::protocol::LogLimiter;
using namespace std::chrono_literals;

TEST_CASE("One line an interval is written, and says how many were not") {
  LogLimiter log;
  const LogLimiter::TimePoint start{100h};
  CHECK(log.allow(start) == 0u);
  CHECK_FALSE(log.allow(start));
  CHECK_FALSE(log.allow(start + 999999999ns));
  CHECK(log.allow(start + 1s) == 2u);
  CHECK_FALSE(log.allow(start + 1999999999ns));
  // after a pause it is still one line
  CHECK(log.allow(start + 1h) == 1u);
  CHECK_FALSE(log.allow(start + 1h));
}

TEST_CASE("Lines that are suppressed do not put off the next one") {
  LogLimiter log(1, 1);
  CHECK(log.allow(0.0));
  for (int tenth = 1; tenth < 10; ++tenth) CHECK_FALSE(log.allow(tenth * 0.1));
  CHECK(log.allow(1.0) == 9u);
}

TEST_CASE("A burst is written at once, and again after as many intervals") {
  LogLimiter log(20, 0.5);
  for (int i = 0; i < 20; ++i) CHECK(log.allow(50.0) == 0u);
  for (int i = 0; i < 7; ++i) CHECK_FALSE(log.allow(50.4));
  CHECK(log.allow(50.5) == 7u);
  CHECK_FALSE(log.allow(50.9));
  for (int i = 0; i < 20; ++i) CHECK(log.allow(60.9));
  CHECK_FALSE(log.allow(60.9));
}

TEST_CASE("A clock that is put back neither frees a line nor holds one back for ever") {
  LogLimiter log(1, 5);
  CHECK(log.allow(100.0));
  CHECK_FALSE(log.allow(0.0));
  CHECK_FALSE(log.allow(104.0));
  CHECK(log.allow(105.0) == 2u);
}
