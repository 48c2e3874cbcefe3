#include "server/world_server/world_server.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "formats/protocol/log_limiter.hpp"
#include "server/world_server/connection.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

// Robots, world controllers and a few observers.
constexpr std::size_t kMostConnections = 2 * kMostRobots;
// Longest time for steps without serving the sockets, and for sockets without a step.
constexpr double kSteppingSlice_s = 100e-6;
constexpr double kServingSlice_s = 500e-6;

std::chrono::steady_clock::time_point time_point(double seconds) {
  return std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds)));
}

tcp::acceptor listen(asio::io_context& io, const ServerOptions& options) {
  error_code error;
  const asio::ip::address address =
      asio::ip::make_address(options.listen_address == "localhost" ? "127.0.0.1" : options.listen_address, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("\"{}\" is not an address to listen on; give one such as 127.0.0.1", options.listen_address));
  }
  if (!address.is_loopback()) {
    spdlog::warn("listening on {}: any program that reaches this address can command the robots; there is no password",
                 options.listen_address);
  }
  try {
    return tcp::acceptor(io, tcp::endpoint(address, options.port));
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(fmt::format("cannot listen on {}:{}: {}; choose another --port or --listen",
                                         options.listen_address, options.port, failure.code().message()));
  }
}

}  // namespace

struct WorldServer::Implementation {
  explicit Implementation(const ServerOptions& options) : simulation(options), acceptor(listen(io, options)) {}

  void accept();
  void welcome(tcp::socket socket);
  void serve_sockets();
  void flush();
  void sleep_until(std::optional<double> wake_s);
  void close_all();

  asio::io_context io{1};
  Simulation simulation;
  tcp::acceptor acceptor;
  asio::steady_timer accept_again{io};
  asio::steady_timer wake_timer{io};
  std::optional<double> armed_s;  // time for which wake_timer is set
  std::vector<std::shared_ptr<Connection>> connections;
  protocol::LogLimiter connection_log{20, 0.5};
  std::atomic<bool> stopping = false;
};

void WorldServer::Implementation::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor.is_open()) return;
    if (!error) {
      welcome(std::move(socket));
      return accept();
    }
    // Mostly too many open files: retrying at once would only use processor time.
    if (connection_log.allow(steady_seconds())) spdlog::error("cannot accept a client: {}", error.message());
    accept_again.expires_after(std::chrono::milliseconds(100));
    accept_again.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void WorldServer::Implementation::welcome(tcp::socket socket) {
  error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return;  // gone already
  const std::string name = fmt::format("client {}:{}", peer.address().to_string(), peer.port());
  const bool log = connection_log.allow(steady_seconds()).has_value();
  if (connections.size() >= kMostConnections) {
    if (log) spdlog::warn("{}: refused: {} clients are connected already", name, connections.size());
    return;
  }
  if (log) spdlog::info("{}: connected", name);
  const auto gone = [this](Connection& connection) {
    std::erase_if(connections, [&](const auto& other) { return other.get() == &connection; });
  };
  connections.push_back(std::make_shared<Connection>(std::move(socket), simulation, name, gone));
  const auto connection = connections.back();  // start() may close it
  connection->start();
}

void WorldServer::Implementation::serve_sockets() {
  const double until_s = steady_seconds() + kServingSlice_s;
  while (io.poll_one() > 0 && steady_seconds() < until_s && !stopping) {
  }
}

void WorldServer::Implementation::flush() {
  // By index from the end: a broken connection removes itself from the list.
  for (std::size_t i = connections.size(); i-- > 0;) {
    if (i < connections.size()) std::shared_ptr(connections[i])->flush();
  }
}

void WorldServer::Implementation::sleep_until(std::optional<double> wake_s) {
  if (wake_s && wake_s != armed_s) {
    wake_timer.expires_at(time_point(*wake_s));
    wake_timer.async_wait([this](error_code cancelled) {
      if (!cancelled) armed_s.reset();
    });
    armed_s = wake_s;
  }
  io.run_one();
}

void WorldServer::Implementation::close_all() {
  error_code ignored;
  acceptor.close(ignored);
  wake_timer.cancel();
  accept_again.cancel();
  while (!connections.empty()) std::shared_ptr(connections.back())->close();
  io.poll();  // runs the handlers of closed connections
}

WorldServer::WorldServer(const ServerOptions& options) : impl_(std::make_unique<Implementation>(options)) {}
WorldServer::~WorldServer() = default;

std::uint16_t WorldServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

const physics::WorldDescription& WorldServer::world_description() const {
  return impl_->simulation.world.description();
}

double WorldServer::time_step_s() const {
  return impl_->simulation.options.time_step_s;
}

void WorldServer::run() {
  Implementation& server = *impl_;
  server.accept();
  double served_s = 0;
  while (!server.stopping) {
    if (const double now_s = steady_seconds(); now_s >= served_s + kSteppingSlice_s) {
      server.serve_sockets();
      served_s = steady_seconds();
    }
    const Simulation::Progress progress = server.simulation.advance(steady_seconds());
    server.flush();
    if (!progress.stepped && !server.stopping) {
      server.sleep_until(progress.wake_s);
      served_s = 0;
    }
  }
  server.close_all();
}

void WorldServer::stop() {
  impl_->stopping = true;
  asio::post(impl_->io, [] {});  // wakes run()
}

void WorldServer::ask(std::function<void(Simulation&)> request) {
  asio::post(impl_->io, [this, request = std::move(request)] {
    if (impl_->stopping) return;
    impl_->simulation.wall_s = steady_seconds();
    request(impl_->simulation);
  });
}

}  // namespace kenaf::world_server
