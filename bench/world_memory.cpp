// Resident memory of the world server with 16 robots, each of which gets its sensor readings.
//
//   world_memory
//
// Exit status 1 at 100 MiB or more.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "bench/relay_client.hpp"
#include "command_line/parse.hpp"
#include "tests/support/process.hpp"

int main(int argc, char** argv) {
  using namespace kenaf;
  CLI::App app{"Memory of kenaf-world with 16 robots", "world_memory"};
  std::string bin = KENAF_BIN_DIR;
  app.add_option("--bin", bin, "Folder of kenaf-world");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  try {
    const support::TemporaryFolder folder;
    support::Process world({bin + "/kenaf-world", "--view", "off", "--cameras", "off", "--port", "0", "--port-file",
                            (folder.path() / "world").string()},
                           folder.path() / "world.log");
    const std::uint16_t port = support::wait_for_port(folder.path() / "world", world);

    // 16 robots in a grid, each with a connection, that turn in place.
    constexpr int kRobots = 16;
    std::vector<int> robots;
    for (int i = 0; i < kRobots; ++i) {
      robots.push_back(bench::connected_socket(SOCK_STREAM, port));
      const std::string text = fmt::format(
          "INIT {{ClassName USARBot.Kenaf}} {{Name R{}}} {{Location {},{},0}}\r\nDRIVE {{Left 1}} {{Right -1}}\r\n", i,
          2 * (i % 4), 2 * (i / 4));
      if (::send(robots.back(), text.data(), text.size(), MSG_NOSIGNAL) < 0) bench::fail("send");
    }
    // Every robot's stream is read until each has turned for a while: 50 status messages are 10 s of robot time.
    for (const int robot : robots) {
      std::string stream;
      std::array<char, 65536> bytes;
      int status_messages = 0;
      while (status_messages < 50) {
        const ssize_t got = ::recv(robot, bytes.data(), bytes.size(), 0);
        if (got <= 0) bench::fail("the world server sends nothing");
        stream.append(bytes.data(), static_cast<std::size_t>(got));
        for (std::size_t at; (at = stream.find("STA {")) != std::string::npos; ++status_messages)
          stream.erase(0, at + 5);
      }
    }
    const double mebibytes = static_cast<double>(world.resident_bytes()) / (1 << 20);
    fmt::print("figure,value,limit\nworld_server_resident_mib_16_robots,{:.1f},100\n", mebibytes);
    return mebibytes < 100 ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "world_memory: {}\n", error.what());
    return 2;
  }
}
