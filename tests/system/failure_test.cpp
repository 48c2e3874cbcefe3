// A part of the chain of processes dies. If the world server is killed during a run, the program gets an error within 1
// s and ends by itself; once the server is started again, the relay reconnects and a new run succeeds with nothing else
// restarted. If the user program is killed, the robot stands within 0.5 s of robot time; if the relay is killed, the
// program gets an error and ends by itself. A second commander is refused with words that say why, and the first one is
// not disturbed.
#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "tests/support/usarsim_client.hpp"
#include "tests/system/chain.hpp"

using namespace kenaf;
using namespace kenaf::system_test;
using namespace std::chrono_literals;
using support::number_in;

namespace {

// Watches the relay's robot over a connection of its own, as a world controller does.
class Observer {
 public:
  explicit Observer(std::uint16_t port) : client_(port) {
    client_.send(
        "INIT {ClassName USARBotAPI.WorldController} {Name Observer}\r\nCONTROL {Type Session} {Precision 9}\r\n");
  }
  struct Sighting {
    double time_s, x_m, y_m;
  };
  // Waits until there is a robot to be seen: the relay places it anew when a program begins.
  Sighting look() {
    while (true) {
      client_.send("PING {Id 1}\r\nCONTROL {Type GetSTA} {Name Kenaf}\r\n");
      const std::string time = client_.line_that_begins("PONG");
      const std::string status = client_.line_that_begins("STA");
      if (status.find("Location") != std::string::npos) {
        return {number_in(time, "Time"), number_in(status, "Location", 0), number_in(status, "Location", 1)};
      }
      std::this_thread::sleep_for(5ms);
    }
  }

 private:
  support::UsarsimClient client_;
};

// Waits until the robot has moved 20 mm from where it stood.
Observer::Sighting wait_for_motion(Observer& observer) {
  const Observer::Sighting start = observer.look();
  while (true) {
    const Observer::Sighting now = observer.look();
    if (std::hypot(now.x_m - start.x_m, now.y_m - start.y_m) > 0.02) return now;
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace

TEST_CASE("The world server dies and comes back") {
  Chain chain("3");
  support::Process program = chain.start_program("square_sim");
  Observer observer(chain.world_port());
  wait_for_motion(observer);

  chain.world().signal(SIGKILL);
  const auto status = program.wait();
  INFO(chain.log("square_sim"));
  REQUIRE(status.has_value());
  CHECK(*status > 0);  // an error of the program's own, not a signal
  CHECK(chain.log("square_sim").find("world server") != std::string::npos);

  chain.start_world();
  // The relay retries at least once a second, and refuses commanders until it has a robot again.
  std::optional<int> again;
  for (int tries = 0; tries < 10 && again != 0; ++tries) {
    support::Process retry = chain.start_program("square_sim");
    again = retry.wait();
    if (again != 0) std::this_thread::sleep_for(500ms);
  }
  INFO(chain.log("square_sim") << chain.log("relay"));
  CHECK(again == 0);
}

TEST_CASE("The robot stands within 0.5 s of robot time after its program was killed") {
  Chain chain("1");
  support::Process program = chain.start_program("square_sim");
  Observer observer(chain.world_port());
  wait_for_motion(observer);

  program.signal(SIGKILL);
  const Observer::Sighting killed = observer.look();
  std::vector<Observer::Sighting> after{killed};
  while (after.back().time_s < killed.time_s + 1.5) {
    after.push_back(observer.look());
    std::this_thread::sleep_for(2ms);
  }
  // It stands from the first sighting on after which it is never farther than 0.1 mm from where it ends.
  const Observer::Sighting end = after.back();
  const auto last_moving = std::find_if(after.rbegin(), after.rend(), [&](const Observer::Sighting& seen) {
    return std::hypot(seen.x_m - end.x_m, seen.y_m - end.y_m) > 1e-4;
  });
  REQUIRE(last_moving != after.rend());  // it was moving when its program was killed
  INFO("killed at " << killed.time_s << " s, still moving at " << last_moving->time_s << " s");
  CHECK(last_moving->time_s - killed.time_s < 0.5);
}

TEST_CASE("A second commander is refused with a reason") {
  Chain chain("3");
  const auto record = chain.folder() / "first.csv";
  support::Process first = chain.start_program("square_sim", {{"KENAF_RECORD", record.string()}});
  Observer observer(chain.world_port());
  wait_for_motion(observer);

  support::Process second = chain.start_program("status_monitor_sim");
  const auto refused = second.wait();
  REQUIRE(refused.has_value());
  CHECK(*refused > 0);
  CHECK(chain.log("status_monitor_sim").find("has commanded the robot") != std::string::npos);
  CHECK(first.wait() == 0);
}

TEST_CASE("The relay dies") {
  Chain chain("1");
  support::Process program = chain.start_program("square_sim");
  Observer observer(chain.world_port());
  wait_for_motion(observer);
  chain.relay().signal(SIGKILL);
  const auto status = program.wait();
  REQUIRE(status.has_value());
  CHECK(*status > 0);
}
