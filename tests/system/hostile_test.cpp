// The programs in bad company: signals at any moment, a world that hangs, a network that is taken away, a world full of
// boxes.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/patience.hpp"
#include "tests/support/tcp_proxy.hpp"
#include "tests/support/usarsim_client.hpp"
#include "tests/system/chain.hpp"

using namespace kenaf;
using namespace kenaf::system_test;
using support::eventually;
using support::number_in;

namespace {

std::string read_log(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

support::Process started(std::vector<std::string> argv, const std::filesystem::path& log) {
  argv.front() = KENAF_BIN_DIR "/" + argv.front();
  return support::Process(std::move(argv), log);
}

// Where the robots of this name are, as a world controller sees them.
std::vector<double> y_of_robots(support::UsarsimClient& controller, const std::string& name) {
  controller.send("CONTROL {Type GetSTA} {Name " + name + "}\r\n");
  const std::string line = controller.line_that_begins("STA");
  std::vector<double> all;
  for (std::size_t at = line.find("{Name "); at != std::string::npos; at = line.find("{Name ", at + 1)) {
    all.push_back(number_in("STA " + line.substr(at), "Location", 1));  // start poses differ in y
  }
  return all;
}

}  // namespace

TEST_CASE("A signal ends a program that is still loading its world", "[hostile]") {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"kenaf-world", "--port", "0", "--view", "off", "--cameras", "off"},
        std::vector<std::string>{"kenaf-relayd", "--embedded", "--listen", "127.0.0.1:0", "--view", "off", "--cameras",
                                 "off"}}) {
    support::TemporaryFolder folder;
    const std::filesystem::path world = folder.path() / "world.sdf";
    REQUIRE(::mkfifo(world.c_str(), 0600) == 0);
    std::vector<std::string> argv = command;
    argv.insert(argv.end(), {"--world", world.string()});
    support::Process program = started(argv, folder.path() / "log");
    // Once it reads, writing can begin: it waits for what never comes. A program that reads no FIFO ends by itself.
    int writer = -1;
    REQUIRE(eventually([&] {
      writer = ::open(world.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      return writer >= 0 || program.status().has_value();
    }));
    const bool waits = writer >= 0 && !program.status();
    program.signal(SIGTERM);
    const auto status = program.wait();
    INFO(command.front() << ": " << read_log(folder.path() / "log"));
    REQUIRE(status.has_value());
    if (waits) CHECK((*status == -SIGTERM || *status == 0 || *status == 1));
    if (writer >= 0) ::close(writer);
  }
}

TEST_CASE("A world of a thousand boxes answers, and a signal ends it", "[hostile]") {
  support::TemporaryFolder folder;
  const std::filesystem::path port_file = folder.path() / "port";
  support::Process world =
      started({"kenaf-world", "--port", "0", "--port-file", port_file.string(), "--view", "off", "--cameras", "off"},
              folder.path() / "log");
  support::UsarsimClient client(support::wait_for_port(port_file, world));
  client.send("INIT {ClassName USARBot.P2DX} {Location 0,0,0}\r\n");
  client.line_that_begins("STA");
  // As close to each other as is allowed, in piles that overlap: whatever is refused, answers come.
  int made = 0;
  for (int i = 0; i < 1000; ++i) {
    const int column = i % 100, layer = i / 100;
    const std::string n = std::to_string(i), x = std::to_string(5 + 0.1 * column), z = std::to_string(-1 - 0.1 * layer);
    client.send("CONTROL {Type Create} {ClassName Box} {Name Box" + n + "} {Location " + x + ",0," + z +
                "} {Scale 0.5,0.5,0.5} {Physics RigidBody}\r\n");
    if (client.line_that_begins("RES").find("{Status OK}") != std::string::npos) ++made;
  }
  CHECK(made > 100);
  for (int i = 0; i < 5; ++i) {
    client.send("PING {Id " + std::to_string(i) + "}\r\n");
    CHECK(client.line_that_begins("PONG").starts_with("PONG {Id " + std::to_string(i) + "}"));
  }
  world.signal(SIGTERM);
  CHECK(world.wait() == 0);
}

TEST_CASE("A hung world server is told from a relay that is not there", "[hostile]") {
  Chain chain("1");
  chain.world().signal(SIGSTOP);
  support::Process program = chain.start_program("status_monitor_sim");
  const auto status = program.wait();
  chain.world().signal(SIGCONT);
  const std::string said = chain.log("status_monitor_sim");
  INFO(said);
  REQUIRE(status.has_value());
  CHECK(*status > 0);
  CHECK(said.find("no relay at") == std::string::npos);
  CHECK(said.find("world server") != std::string::npos);
}

TEST_CASE("A robot whose connection was cut is replaced where it began when its relay is back", "[hostile]") {
  support::TemporaryFolder folder;
  const auto port_file = [&](const std::string& of) { return (folder.path() / (of + ".port")).string(); };
  support::Process world =
      started({"kenaf-world", "--port", "0", "--port-file", port_file("world"), "--view", "off", "--cameras", "off"},
              folder.path() / "world.log");
  const std::uint16_t world_port = support::wait_for_port(port_file("world"), world);
  support::TcpProxy network(world_port);
  support::Process relay = started({"kenaf-relayd", "--listen", "127.0.0.1:0", "--port-file", port_file("relay"),
                                    "--world-server", "127.0.0.1:" + std::to_string(network.port())},
                                   folder.path() / "relay.log");
  support::UsarsimClient controller(world_port);
  REQUIRE(eventually([&] { return y_of_robots(controller, "Kenaf").size() == 1; }));
  const std::vector<double> began = y_of_robots(controller, "Kenaf");

  // The world server keeps the old connection for as long as it likes: its peer's machine, here the proxy, lives.
  const auto connections = [&] {
    const std::string log = read_log(folder.path() / "relay.log");
    std::size_t count = 0;
    for (std::size_t at = log.find("connected to the world server"); at != std::string::npos;
         at = log.find("connected to the world server", at + 1)) {
      ++count;
    }
    return count;
  };
  REQUIRE(eventually([&] { return connections() == 1; }));
  network.cut();
  REQUIRE(eventually([&] { return connections() == 2; }));
  INFO(read_log(folder.path() / "world.log"));
  const std::vector<double> now = y_of_robots(controller, "Kenaf");
  REQUIRE(now.size() == 1);
  CHECK(now.front() == Approx(began.front()).margin(0.01));
}
