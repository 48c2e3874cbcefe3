// Memory that is out: it ends the connection for which it was needed, or that of the newest robot, and nothing else.
#include <spdlog/spdlog.h>

#include <future>
#include <new>
#include <string>
#include <thread>

#include "server/world_server/manual_drive.hpp"
#include "server/world_server/world_server.hpp"
#include "tests/server/world_server/conversation.hpp"
#include "tests/support/heap_calls.hpp"

namespace kenaf::world_server {

namespace {

// A first client that has a robot, and drives, whatever happens to others.
struct Driven : Conversation {
  spdlog::level::level_enum before = spdlog::get_level();

  Driven() {
    spdlog::set_level(spdlog::level::off);  // what is logged allocates too, and there is much of it
    send("INIT {ClassName USARBot.P2DX} {Name First}\r\n");
  }
  ~Driven() { spdlog::set_level(before); }
  Driven(const Driven&) = delete;
  Driven& operator=(const Driven&) = delete;

  // Does `work` with the heap failing at call `n`. Returns whether it threw; `failed`: there was such a call.
  template <typename Work>
  bool throws_with_failing(long n, bool& failed, Work work) {
    bool threw = false;
    test::fail_heap_call(n);
    try {
      work();
    } catch (const std::exception&) {
      threw = true;
    }
    failed = test::heap_call_failed();
    test::fail_heap_call(0);
    return threw;
  }
  // Everybody else leaves; what is in the world belongs to somebody, and the first client drives on.
  void check_and_clear() {
    CHECK(simulation.world.robots().size() == simulation.robot_count());
    CHECK(simulation.world.boxes().size() == simulation.objects.size());
    std::vector<Session*> others;
    for (const auto& other : simulation.sessions) {
      if (other.get() != session) others.push_back(other.get());
    }
    for (Session* other : others) simulation.disconnect(*other);
    send("CONTROL {Type KillAll}\r\nCONTROL {Type Resume}\r\nDRIVE {Left 1} {Right 1}\r\n");
    REQUIRE(run(0.002));
    REQUIRE(command().track_speed_mps[robot::kLeft] > 0);
    REQUIRE(truth().X_WB.p.allFinite());
    session->out.clear();
  }
};

}  // namespace

TEST_CASE("A request for which there is no memory ends its connection at most, and the others drive on", "[hostile]") {
  for (const std::string request : {
           "INIT {ClassName USARBot.P2AT} {Name Second}\r\n",
           "CONTROL {Type Create} {ClassName Box} {Name A box with a name that is long} {Location 3,3,-1}\r\n",
           "CONTROL {Type Reset}\r\n",
           "CONTROL {Type Session} {Period 0.01} {Owner 0123456789abcdef0123456789abcdef}\r\n",
           "CONTROL {Type Step} {Steps 3}\r\nCONTROL {Type Resume}\r\n",
           "CONTROL {Type GetSTA}\r\nGETSTARTPOSES\r\nGETCONF {Type Robot}\r\n",
       }) {
    INFO(request);
    Driven talk;
    long n = 0;
    for (bool failed = true; failed;) {
      Session& other = talk.simulation.connect("other");
      talk.throws_with_failing(++n, failed, [&] { talk.send(other, request); });
      talk.check_and_clear();
    }
    CHECK(n > 1);
  }
}

TEST_CASE("A client or an operator's robot for whom there is no memory has not come", "[hostile]") {
  for (const bool by_operator : {false, true}) {
    Driven talk;
    long n = 0;
    for (bool failed = true; failed;) {
      const bool threw = talk.throws_with_failing(++n, failed, [&] {
        std::uint32_t id = 0;
        if (by_operator) {
          place_robot_by_hand(talk.simulation, OperatorId{1}, id);
        } else {
          talk.simulation.connect("a client whose name is not short");
        }
      });
      CHECK(talk.simulation.sessions.size() == (threw ? 1 : 2));
      talk.check_and_clear();
    }
    CHECK(n > 1);
  }
}

TEST_CASE("A turn in which memory is out throws nothing, ends one session at most, and time goes on", "[hostile]") {
  Driven talk;
  long n = 0;
  for (bool failed = true; failed;) {
    Session& second = talk.simulation.connect("second");
    talk.send(second, "CONTROL {Type Session} {Period 0.002}\r\nINIT {ClassName USARBot.Kenaf} {Name Second}\r\n");
    const std::uint64_t step = talk.simulation.world.step_count();
    CHECK_FALSE(talk.throws_with_failing(++n, failed, [&] {
      for (int i = 0; i < 5; ++i) talk.simulation.advance(talk.wall_s);
    }));
    CHECK(talk.simulation.world.step_count() >= step + 4);
    CHECK_FALSE((talk.session->close && second.close));
    if (talk.session->close) {  // it was its own output that failed
      talk.simulation.disconnect(*talk.session);
      talk.session = &second;
    }
    talk.check_and_clear();
  }
  CHECK(n > 1);
}

TEST_CASE("A server whose memory is out while it welcomes a client serves the next one", "[hostile]") {
  const spdlog::level::level_enum before = spdlog::get_level();
  spdlog::set_level(spdlog::level::off);
  ServerOptions options;
  options.port = 0;
  WorldServer server(options);
  std::thread thread([&] { server.run(); });
  // The heap of the server's own thread.
  const auto in_its_thread = [&](auto work) {
    std::promise<bool> done;
    server.ask([&](Simulation&) { done.set_value(work()); });
    return done.get_future().get();
  };

  long n = 0;
  for (bool failed = true; failed;) {
    ++n;
    in_its_thread([n] {
      test::fail_heap_call(n);
      return true;
    });
    try {
      support::UsarsimClient client(server.port());
      client.send("PING {Id 1}\r\nCONTROL {Type Session} {Period 0.1}\r\n");
      client.line_that_begins("RES");
    } catch (const std::exception&) {  // closed: its memory was out
    }
    failed = in_its_thread([] {
      const bool has_failed = test::heap_call_failed();
      test::fail_heap_call(0);
      return has_failed;
    });
    support::UsarsimClient next(server.port());
    next.send("PING {Id 2}\r\n");
    CHECK(next.line_that_begins("PONG").starts_with("PONG {Id 2}"));
  }
  CHECK(n > 3);
  server.stop();
  thread.join();
  spdlog::set_level(before);
}

}  // namespace kenaf::world_server
