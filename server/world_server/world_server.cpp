#include "server/world_server/world_server.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "formats/protocol/host_port.hpp"
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
constexpr std::chrono::milliseconds kWatchPeersEvery{250};

std::chrono::steady_clock::time_point time_point(double seconds) {
  return std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds)));
}

tcp::acceptor listen(asio::io_context& io, const ServerOptions& options) {
  const std::optional<std::string> host = protocol::parse_listen_host(options.listen_address);
  error_code error;
  const asio::ip::address address = asio::ip::make_address(host.value_or(""), error);
  if (!host || error)
    throw std::runtime_error(fmt::format("\"{}\" {}", options.listen_address, protocol::kMustBeListenHost));
  if (!address.is_loopback()) {
    spdlog::warn("listening on {}: any program that reaches this address can command the robots; there is no password",
                 options.listen_address);
  }
  try {
    return tcp::acceptor(io, tcp::endpoint(address, options.port));
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}; choose another --port or --listen",
                                         protocol::to_text({*host, options.port}), failure.code().message()));
  }
}

}  // namespace

struct WorldServer::Implementation {
  explicit Implementation(const ServerOptions& options) : simulation(options), acceptor(listen(io, options)) {}

  void accept();
  void welcome(tcp::socket socket);
  bool make_room();
  void watch_peers();
  void turn(double& served_s);
  void note_failure(const std::exception& failure);
  void serve_sockets();
  void flush();
  void sleep_until(std::optional<double> wake_s);
  void close_all();

  asio::io_context io{1};
  // Without it the context would stop for good in a moment without any pending operation, after a failed accept.
  asio::executor_work_guard<asio::io_context::executor_type> always_work{io.get_executor()};
  Simulation simulation;
  tcp::acceptor acceptor;
  asio::steady_timer accept_again{io};
  asio::steady_timer wake_timer{io};
  asio::steady_timer next_watch{io};
  std::optional<double> armed_s;  // time for which wake_timer is set
  std::vector<std::shared_ptr<Connection>> connections;
  protocol::LogLimiter connection_log{20, 0.5};
  protocol::LogLimiter failure_log{1, 1};
  bool accepting = false;  // an accept, or the pause after one that failed, is under way
  bool watching = false;   // next_watch is under way
  std::atomic<bool> stopping = false;
};

void WorldServer::Implementation::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    accepting = false;  // run() goes on with the next
    if (!error) return welcome(std::move(socket));
    // Mostly too many open files: retrying at once would only use processor time.
    if (connection_log.allow(steady_seconds())) spdlog::error("cannot accept a client: {}", error.message());
    accept_again.expires_after(std::chrono::milliseconds(100));
    accept_again.async_wait([this](error_code cancelled) {
      if (!cancelled) accepting = false;
    });
    accepting = true;
  });
  accepting = true;
}

void WorldServer::Implementation::welcome(tcp::socket socket) {
  error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return;  // gone already
  const std::string name = fmt::format("client {}:{}", peer.address().to_string(), peer.port());
  const bool log = connection_log.allow(steady_seconds()).has_value();
  if (connections.size() >= kMostConnections && !make_room()) {
    if (log) spdlog::warn("{}: refused: {} clients are connected already", name, connections.size());
    return;
  }
  if (log) spdlog::info("{}: connected", name);
  const auto gone = [this](Connection& connection) {
    std::erase_if(connections, [&](const auto& other) { return other.get() == &connection; });
  };
  connections.reserve(connections.size() + 1);  // so that whoever is in the simulation is in the list too
  connections.push_back(std::make_shared<Connection>(std::move(socket), simulation, name, gone));
  const auto connection = connections.back();  // start() may close it
  try {
    connection->start();
  } catch (...) {
    connection->close();
    throw;
  }
}

// Closes the connection without a robot that has been silent longest; false: none has been so for long enough.
bool WorldServer::Implementation::make_room() {
  const auto silent_since_s = [](const auto& connection) {
    return connection->has_robot() ? std::numeric_limits<double>::infinity() : connection->heard_s();
  };
  const double now_s = steady_seconds();
  const auto found = std::ranges::min_element(connections, {}, silent_since_s);
  if (found == connections.end() || silent_since_s(*found) > now_s - simulation.options.idle_s) return false;
  const std::shared_ptr idlest(*found);
  if (connection_log.allow(now_s)) {
    spdlog::warn("{}: closed: silent for {:.0f} s and without a robot, and another client needs its place",
                 idlest->peer(), now_s - idlest->heard_s());
  }
  idlest->close();
  return true;
}

void WorldServer::Implementation::watch_peers() {
  simulation.catch_up(steady_seconds());
  for (const auto& connection : connections) connection->watch_peer();
  next_watch.expires_after(kWatchPeersEvery);
  next_watch.async_wait([this](error_code) { watching = false; });  // run() watches on while anybody is connected
  watching = true;
}

// Of anything in run(): whom it concerns is gone already, and the others are served on.
void WorldServer::Implementation::note_failure(const std::exception& failure) {
  // It may have been an accept, whose handler Asio then never calls.
  error_code ignored;
  acceptor.cancel(ignored);
  accept_again.cancel();
  accepting = false;
  if (failure_log.allow(steady_seconds())) spdlog::error("the world server goes on after: {}", failure.what());
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
  next_watch.cancel();
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

// Serves the sockets if it is time, lets the world advance, and sleeps if it need not.
void WorldServer::Implementation::turn(double& served_s) {
  if (!accepting) accept();
  if (!watching && !connections.empty()) watch_peers();
  if (const double now_s = steady_seconds(); now_s >= served_s + kSteppingSlice_s) {
    serve_sockets();
    served_s = steady_seconds();
  }
  const Simulation::Progress progress = simulation.advance(steady_seconds());
  flush();
  if (!progress.stepped && !stopping && accepting) {
    sleep_until(progress.wake_s);
    served_s = 0;
  }
}

void WorldServer::run() {
  double served_s = 0;
  while (!impl_->stopping) {
    try {
      impl_->turn(served_s);
    } catch (const std::exception& failure) {
      impl_->note_failure(failure);
    }
  }
  impl_->close_all();
}

void WorldServer::stop() {
  impl_->stopping = true;
  for (;;) {
    try {
      return asio::post(impl_->io, [] {});  // wakes run()
    } catch (const std::bad_alloc&) {       // the program must end also when memory is out
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

void WorldServer::ask(std::function<void(Simulation&)> request) {
  asio::post(impl_->io, [this, request = std::move(request)] {
    if (impl_->stopping) return;
    impl_->simulation.catch_up(steady_seconds());
    impl_->simulation.wall_s = steady_seconds();
    request(impl_->simulation);
  });
}

}  // namespace kenaf::world_server
