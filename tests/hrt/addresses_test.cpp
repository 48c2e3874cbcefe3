// Names of the configuration are looked up within a time limit, whatever the name server does.
#include "libkenaf_sim/addresses.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <memory>

#include "hrt/error.hpp"
#include "tests/hrt/name_servers.hpp"

using namespace kenaf::sim;
using namespace kenaf::hrt::test;
using namespace std::chrono_literals;

namespace {

TimePoint now() {
  return TimePoint::clock::now();
}

// The code of the error that a look-up of robot.example:45454 ends with, and its text.
std::pair<int, std::string> failure(TimePoint deadline, const AskForAddresses& ask,
                                    const std::string& host_port = "robot.example:45454") {
  try {
    (void)look_up("relay", host_port, SOCK_DGRAM, deadline, -1, ask);
  } catch (const kenaf::hrt::Error& error) {
    return {error.code(), error.what()};
  }
  return {HRT_OK, ""};
}

}  // namespace

TEST_CASE("A name server that does not answer ends the look-up at its deadline, or when it is cancelled") {
  const SilentNameServer names;
  const auto [code, text] = failure(now() + 20ms, names.ask());
  CHECK(code == HRT_E_LINK);
  CHECK_THAT(text, Catch::Contains("relay 'robot.example:45454'") && Catch::Contains("no name server"));

  const int cancel = eventfd(1, EFD_CLOEXEC | EFD_NONBLOCK);
  REQUIRE(cancel >= 0);
  CHECK_FALSE(look_up("relay", "robot.example:45454", SOCK_DGRAM, now() + 1h, cancel, names.ask()));
  ::close(cancel);
}

TEST_CASE("A name that is none is an error of the configuration, a name server in trouble is one of the link") {
  const auto says = [](int wrong) {
    return [wrong](const kenaf::protocol::HostPort&, int, Addresses&) { return wrong; };
  };
  CHECK(failure(now() + 1h, says(EAI_NONAME)).first == HRT_E_CONFIG);
  CHECK(failure(now() + 1h, says(EAI_AGAIN)).first == HRT_E_LINK);
  CHECK_THAT(failure(now() + 1h, says(EAI_AGAIN)).second, Catch::Contains("robot.example:45454"));
  CHECK(failure(now() + 1h, says(EAI_FAIL)).first == HRT_E_LINK);
  CHECK(failure(now() + 1h, says(0)).first == HRT_E_CONFIG);  // no error and no address
  CHECK(failure(now() + 1h, says(0), "robot.example:0").first == HRT_E_CONFIG);
}

TEST_CASE("An address in digits is looked up nowhere and takes no time") {
  const SilentNameServer names;
  for (const auto& [host_port, family] : {std::pair{"127.0.0.2:45454", AF_INET}, std::pair{"[::1]:45454", AF_INET6}}) {
    const auto found = look_up("relay", host_port, SOCK_DGRAM, now(), -1, names.ask());
    REQUIRE(found);
    REQUIRE(found->size() == 1);
    CHECK(found->front().address.ss_family == family);
  }
  CHECK(names.asked() == 0);
}

TEST_CASE("The system finds localhost") {
  const auto found = look_up("relay", "localhost:45454", SOCK_STREAM, now() + 1h, -1);
  REQUIRE(found);
  CHECK_FALSE(found->empty());
}

TEST_CASE("Each address has the same share of the time, and what one leaves is the others'") {
  const TimePoint start{}, deadline = start + 6s;
  // Three in 6 s: a silent first one until 2 s, a silent second one until 2 + 4 / 2 = 4 s, the third one until the end.
  CHECK(end_of_share(start, deadline, 3) == start + 2s);
  CHECK(end_of_share(start + 2s, deadline, 2) == start + 4s);
  CHECK(end_of_share(start + 4s, deadline, 1) == deadline);
  // The first one refused at once: 3 s for each of the others.
  CHECK(end_of_share(start, deadline, 2) == start + 3s);
}
