// One thousand commands a second through kenaf-relayd: is any lost, and what does it cost?
//
//   command_load [--seconds 60]
//
// A tap between relay and world server counts the DRIVE lines; every command has its own speed, so the tap also sees
// that each of them came through. CPU and memory are the kernel's own account of the relay's process.
// Exit status 1 if a command is missing, or the relay took at least 10 % of a core or 16 MiB.
#include <fmt/format.h>
#include <poll.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include "bench/relay_client.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "tests/support/process.hpp"

namespace {

using kenaf::bench::connected_socket;
using kenaf::bench::fail;
using kenaf::bench::loopback;
using kenaf::bench::RelayClient;
using kenaf::support::Process;
using kenaf::support::TemporaryFolder;
using kenaf::support::wait_for_port;
namespace protocol = kenaf::protocol;

// Passes bytes between the relay and the world server and keeps the speeds that were commanded.
class Tap {
 public:
  explicit Tap(std::uint16_t world_port) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 1) != 0)
      fail("listen");
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, world_port] { pass(world_port); });
  }
  ~Tap() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;
  std::uint16_t port() const { return port_; }
  std::size_t distinct_speeds() const { return distinct_.load(); }

 private:
  // One connection after the other, as the relay makes them.
  void pass(std::uint16_t world_port) {
    for (int relay; (relay = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC)) >= 0;) pass(relay, world_port);
  }
  void pass(int relay, std::uint16_t world_port) {
    // Bytes are passed on as they come, in both directions, until one end closes.
    lines_ = {};
    const int world = connected_socket(SOCK_STREAM, world_port);
    const int on = 1;
    ::setsockopt(relay, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    std::array<pollfd, 2> ends{pollfd{relay, POLLIN, 0}, pollfd{world, POLLIN, 0}};
    std::array<char, 65536> bytes;
    for (bool open = true; open;) {
      ::poll(ends.data(), ends.size(), -1);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        if (ends[i].revents == 0) continue;
        const ssize_t got = ::recv(ends[i].fd, bytes.data(), bytes.size(), 0);
        if (got <= 0) open = false;
        if (got <= 0) break;
        const std::string_view text(bytes.data(), static_cast<std::size_t>(got));
        if (i == 0) note(text);
        ::send(ends[1 - i].fd, text.data(), text.size(), MSG_NOSIGNAL);
      }
    }
    ::close(relay);
    ::close(world);
  }
  void note(std::string_view text) {
    lines_.push(text);
    while (const auto line = lines_.next()) {
      protocol::usarsim::MessageView message;
      if (protocol::usarsim::parse_message(*line, message) != protocol::usarsim::ParseError::none ||
          !message.is("DRIVE"))
        continue;
      const auto left = message.find("Left");
      const auto spin = left ? protocol::usarsim::parse_number(*left) : std::nullopt;
      if (spin && *spin != 0 && speeds_.insert(std::llround(*spin * 1e9)).second) distinct_.store(speeds_.size());
    }
  }
  int listener_ = -1;
  std::uint16_t port_ = 0;
  protocol::usarsim::LineSplitter lines_;
  std::set<long long> speeds_;
  std::atomic<std::size_t> distinct_{0};
  std::thread thread_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Commands at 1 kHz through kenaf-relayd", "command_load"};
  int seconds = 60;
  std::string bin = KENAF_BIN_DIR;
  app.add_option("--seconds", seconds, "How long")->check(kenaf::command_line::whole_number(1, 86400));
  app.add_option("--bin", bin, "Folder of kenaf-world and kenaf-relayd");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  try {
    // World server, tap, relay and a client of the relay whose states are read by a thread.
    const TemporaryFolder folder;
    Process world({bin + "/kenaf-world", "--view", "off", "--cameras", "off", "--port", "0", "--port-file",
                   (folder.path() / "world").string()},
                  folder.path() / "world.log");
    Tap tap(wait_for_port(folder.path() / "world", world));
    std::size_t arrived = 0;
    double cpu_share = 0;
    std::uint64_t resident = 0;
    const int sent = 1000 * seconds;
    {
      Process relay({bin + "/kenaf-relayd", "--world-server", fmt::format("127.0.0.1:{}", tap.port()), "--listen",
                     "127.0.0.1:0", "--port-file", (folder.path() / "relay").string()},
                    folder.path() / "relay.log");
      RelayClient client(wait_for_port(folder.path() / "relay", relay));
      client.greet(false);
      std::atomic<std::uint32_t> frame{0};
      std::atomic<bool> done{false};
      std::thread listener([&] {
        while (!done) {
          frame = client.wait_for<kenaf::protocol::relay::State>([&](const auto&) { return true; }).robot.frame;
        }
      });

      // A command each millisecond of wall-clock time, each with another speed.
      const double cpu_before = relay.cpu_s();
      const auto start = std::chrono::steady_clock::now();
      kenaf::protocol::relay::Command command{};
      command.session = RelayClient::kSession;
      for (int i = 1; i <= sent; ++i) {
        command.sequence = static_cast<std::uint32_t>(i);
        command.frame = frame;
        command.robot.track_speed_mps = {1e-6 * i, -1e-6 * i};  // up to 60 mm/s, turning in place
        client.send(command);
        std::this_thread::sleep_until(start + std::chrono::milliseconds(i));
      }
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      cpu_share = (relay.cpu_s() - cpu_before) / elapsed;
      resident = relay.resident_bytes();
      std::this_thread::sleep_for(std::chrono::milliseconds(200));  // for commands that are still on their way
      arrived = tap.distinct_speeds();
      done = true;
      listener.join();
    }
    const double mebibytes = static_cast<double>(resident) / (1 << 20);
    const bool within = arrived == static_cast<std::size_t>(sent) && cpu_share < 0.10 && mebibytes < 16;
    fmt::print("figure,value,limit\n");
    fmt::print("commands_sent,{},\ncommands_lost,{},0\n", sent, sent - static_cast<int>(arrived));
    fmt::print("relay_cpu_percent_of_a_core,{:.1f},10\nrelay_resident_mib,{:.1f},16\n", 100 * cpu_share, mebibytes);
    return within ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "command_load: {}\n", error.what());
    return 2;
  }
}
