// Latency of the relay: round trips to the world server and back, through kenaf-relayd and through a bare UDP-to-TCP
// forwarder, on the same loopback, in the same run, in turn.
//
//   round_trip [--rounds 8] [--count 2000]
//
// Two exchanges are timed, each with both:
//   ping   PING, answered at once by the world server: the chain alone.
//   cycle  in lock step, from a command that answers frame n to frame n + 1: the chain, one control period of physics,
//          and a whole frame of sensors back. The forwarder carries the same text that the relay makes of it.
//
// Exit status 1 if the relay's median exceeds 1.5 times, or its 99th percentile 1.8 times, the forwarder's.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/relay_client.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/protocol/relay_datagram.hpp"
#include "tests/support/process.hpp"

namespace {

using kenaf::bench::connected_socket;
using kenaf::bench::fail;
using kenaf::bench::loopback;
using kenaf::bench::RelayClient;
using kenaf::support::Process;
using kenaf::support::TemporaryFolder;
using kenaf::support::wait_for_port;
using Clock = std::chrono::steady_clock;
using Samples = std::vector<double>;  // microseconds

// The reference: one thread, no parsing, bytes from one socket to the other. A process of its own, as the relay is.
class BareForwarder {
 public:
  explicit BareForwarder(std::uint16_t world_port) {
    const int udp = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(udp, reinterpret_cast<sockaddr*>(&address), size) != 0) fail("bind");
    ::getsockname(udp, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    pid_ = ::fork();
    if (pid_ == 0) forward(udp, connected_socket(SOCK_STREAM, world_port));
    ::close(udp);
  }
  ~BareForwarder() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  BareForwarder(const BareForwarder&) = delete;
  BareForwarder& operator=(const BareForwarder&) = delete;
  std::uint16_t port() const { return port_; }

 private:
  [[noreturn]] static void forward(int udp, int tcp) {
    std::array<char, 65536> bytes;
    sockaddr_in peer{};
    std::array<pollfd, 2> waiting{pollfd{udp, POLLIN, 0}, pollfd{tcp, POLLIN, 0}};
    while (true) {
      ::poll(waiting.data(), waiting.size(), -1);
      if (waiting[0].revents != 0) {
        socklen_t size = sizeof peer;
        const ssize_t got = ::recvfrom(udp, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&peer), &size);
        if (got > 0 && ::send(tcp, bytes.data(), static_cast<std::size_t>(got), MSG_NOSIGNAL) < 0) ::_exit(1);
      }
      if (waiting[1].revents != 0) {
        const ssize_t got = ::recv(tcp, bytes.data(), bytes.size(), 0);
        if (got <= 0) ::_exit(0);
        if (peer.sin_port == 0) continue;
        ::sendto(udp, bytes.data(), static_cast<std::size_t>(got), 0, reinterpret_cast<sockaddr*>(&peer), sizeof peer);
      }
    }
  }
  pid_t pid_ = -1;
  std::uint16_t port_ = 0;
};

// A user of the bare forwarder: USARSim text in datagrams.
class TextClient {
 public:
  explicit TextClient(std::uint16_t port) : fd_(connected_socket(SOCK_DGRAM, port)) {}
  ~TextClient() { ::close(fd_); }
  TextClient(const TextClient&) = delete;
  TextClient& operator=(const TextClient&) = delete;

  void send(const std::string& text) {
    if (::send(fd_, text.data(), text.size(), 0) < 0) fail("send");
  }
  // Reads until a whole line holds `mark`.
  void wait_for(const std::string& mark) {
    while (true) {
      const std::size_t at = pending_.find(mark);
      if (at != std::string::npos && pending_.find('\n', at) != std::string::npos) break;
      std::array<char, 65536> bytes;
      const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), 0);
      if (got <= 0) fail("no answer with " + mark);
      pending_.append(bytes.data(), static_cast<std::size_t>(got));
    }
    pending_.erase(0, pending_.find('\n', pending_.find(mark)) + 1);
  }

 private:
  int fd_;
  std::string pending_;
};

Samples timed(int count, const std::function<void(int)>& exchange) {
  Samples samples;
  for (int i = 0; i < count; ++i) {
    const auto start = Clock::now();
    exchange(i);
    samples.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  return samples;
}

struct Servers {
  TemporaryFolder folder;
  std::string bin;
  Process world;
  std::uint16_t world_port;
  Servers(const std::string& bin_folder, const char* speed)
      : bin(bin_folder),
        world({bin + "/kenaf-world", "--view", "off", "--cameras", "off", "--port", "0", "--speed", speed,
               "--port-file", (folder.path() / "world").string()},
              folder.path() / "world.log"),
        world_port(wait_for_port(folder.path() / "world", world)) {}
  Process start_relay() const {
    return Process({bin + "/kenaf-relayd", "--world-server", fmt::format("127.0.0.1:{}", world_port), "--listen",
                    "127.0.0.1:0", "--port-file", (folder.path() / "relay").string()},
                   folder.path() / "relay.log");
  }
};

Samples pings_by_relay(const std::string& bin, int count) {
  const Servers servers(bin, "1");
  Process relay = servers.start_relay();
  RelayClient client(wait_for_port(servers.folder.path() / "relay", relay));
  client.greet(false);
  return timed(count, [&](int i) {
    const auto id = static_cast<std::uint32_t>(i + 1);
    client.send(kenaf::protocol::relay::Ping{RelayClient::kSession, id});
    client.wait_for<kenaf::protocol::relay::Pong>([&](const auto& pong) { return pong.id == id; });
  });
}

// Places a robot with the same stream of frames that the relay asks for.
void place_robot(TextClient& client, bool lockstep) {
  client.send("INIT {ClassName USARBot.Kenaf} {Name Kenaf} {Location 0,0,0}\r\n");
  client.wait_for("STA ");
  client.send(
      fmt::format("CONTROL {{Type Session}} {{Period 0.01}} {{Lockstep {}}} {{CommandTimeout 0.5}} "
                  "{{Precision 12}}\r\n",
                  lockstep ? "True" : "False"));
  client.wait_for("RES ");
}

Samples pings_by_forwarder(const std::string& bin, int count) {
  const Servers servers(bin, "1");
  const BareForwarder forwarder(servers.world_port);
  TextClient client(forwarder.port());
  place_robot(client, false);
  return timed(count, [&](int i) {
    client.send(fmt::format("PING {{Id {}}}\r\n", i + 1));
    client.wait_for(fmt::format("PONG {{Id {}}}", i + 1));
  });
}

Samples cycles_by_relay(const std::string& bin, int count) {
  const Servers servers(bin, "0");
  Process relay = servers.start_relay();
  RelayClient client(wait_for_port(servers.folder.path() / "relay", relay));
  client.greet(true);
  std::uint32_t frame = client.wait_for<kenaf::protocol::relay::State>([](const auto&) { return true; }).robot.frame;
  kenaf::protocol::relay::Command command{};
  command.session = RelayClient::kSession;
  return timed(count, [&](int i) {
    command.sequence = static_cast<std::uint32_t>(i + 1);
    command.frame = frame;
    client.send(command);
    frame = client.wait_for<kenaf::protocol::relay::State>([&](const auto& state) { return state.robot.frame > frame; })
                .robot.frame;
  });
}

Samples cycles_by_forwarder(const std::string& bin, int count) {
  const Servers servers(bin, "0");
  const BareForwarder forwarder(servers.world_port);
  TextClient client(forwarder.port());
  place_robot(client, true);
  int frame = 1;
  client.wait_for(fmt::format("{{Frame {}}}", frame));
  return timed(count, [&](int) {
    client.send(fmt::format("DRIVE {{Left 0}} {{Right 0}} {{Frame {}}}\r\n", frame));
    client.wait_for(fmt::format("{{Frame {}}}", ++frame));
  });
}

double quantile(Samples samples, double share) {
  std::sort(samples.begin(), samples.end());
  return samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1))];
}

using Measurement = Samples (*)(const std::string&, int);

bool compare(const char* name, Measurement relay, Measurement forwarder, const std::string& bin, int rounds,
             int count) {
  // Relay and forwarder in turn, so that both see the same load.
  Samples by_relay, by_forwarder;
  for (int round = 0; round < rounds; ++round) {
    const Samples a = relay(bin, count), b = forwarder(bin, count);
    by_relay.insert(by_relay.end(), a.begin(), a.end());
    by_forwarder.insert(by_forwarder.end(), b.begin(), b.end());
  }

  // Quantiles of all samples against the limits of their ratio.
  bool within = true;
  for (const auto& [label, share, limit] : {std::tuple{"median", 0.5, 1.5}, std::tuple{"p99", 0.99, 1.8}}) {
    const double a = quantile(by_relay, share), b = quantile(by_forwarder, share);
    fmt::print("{},{},{:.1f},{:.1f},{:.2f},{:.1f},{}\n", name, label, a, b, a / b, limit,
               a <= limit * b ? "yes" : "NO");
    within = within && a <= limit * b;
  }
  return within;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Round trips through kenaf-relayd compared with a bare UDP-to-TCP forwarder", "round_trip"};
  int rounds = 8, count = 2000;
  std::string bin = KENAF_BIN_DIR;
  app.add_option("--rounds", rounds, "Pairs of runs, relay and forwarder in turn")
      ->check(kenaf::command_line::whole_number(1, 1000));
  app.add_option("--count", count, "Round trips a run")->check(kenaf::command_line::whole_number(1, 1'000'000));
  app.add_option("--bin", bin, "Folder of kenaf-world and kenaf-relayd");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  try {
    fmt::print("exchange,figure,relay_us,forwarder_us,ratio,limit,within\n");
    const bool pings = compare("ping", pings_by_relay, pings_by_forwarder, bin, rounds, count);
    const bool cycles = compare("cycle", cycles_by_relay, cycles_by_forwarder, bin, rounds, count);
    return pings && cycles ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "round_trip: {}\n", error.what());
    return 2;
  }
}
