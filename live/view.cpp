#include "live/view.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <stdexcept>
#include <thread>

#include "live/access.hpp"
#include "live/http_connection.hpp"
#include "live/messages.hpp"
#include "live/scene_bytes.hpp"
#include "live/speed_meter.hpp"
#include "live/viewer.hpp"

namespace kenaf::live {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

std::string machine_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// On loopback every program is this machine's, and browsers are kept to their own pages by Host and Origin.
std::string token_for(const ViewOptions& options) {
  if (!options.token.empty() || asio::ip::make_address(options.address).is_loopback()) return options.token;
  return make_token();
}

tcp::acceptor listen_for_browsers(asio::io_context& io, const ViewOptions& options) {
  try {
    return tcp::acceptor(io, tcp::endpoint(asio::ip::make_address(options.address), options.port));
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(fmt::format("cannot listen on {}:{}: {}; choose another by --view ADDRESS:PORT",
                                         options.address, options.port, failure.code().message()));
  }
}

}  // namespace

struct View::Implementation {
  Implementation(server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits)
      : hub{world, limits, token_for(options), machine_name(), load_assets(), scene_bytes(world.world_description())},
        acceptor(listen_for_browsers(hub.io, options)),
        address(options.address) {
    hub.viewer_came = [this] {
      if (!looking) look();
    };
  }

  void accept();
  void serve();
  void look();
  void show();
  void wait_and_look();

  Hub hub;
  tcp::acceptor acceptor;
  const std::string address;
  asio::steady_timer accept_again{hub.io}, next_look{hub.io};
  // Handed to the world's thread and back: it belongs to one of the two at a time.
  server::WorldState state;
  server::WorldState told;  // whose inventory the viewers have
  bool looking = false;     // a look is under way or will be
  std::uint64_t states = 0;
  SpeedMeter speed;
  std::thread thread;
};

void View::Implementation::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      if (hub.connections < hub.limits.connections) serve_http(hub, std::move(socket));
      return accept();
    }
    accept_again.expires_after(std::chrono::milliseconds(100));  // most often too many open files
    accept_again.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void View::Implementation::serve() {
  for (;;) {
    try {
      hub.io.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("live view: {}", error.what());  // of one connection; the others are served on
    }
  }
}

void View::Implementation::look() {
  looking = true;
  hub.ask(
      [this](server::Simulation& simulation) {
        server::read_state(simulation, state);
        return true;
      },
      [this](bool) {
        show();
        wait_and_look();
      });
}

void View::Implementation::show() {
  if (!hub.inventory || !same_inventory(state, told)) {
    told = state;
    hub.inventory = std::make_shared<const std::string>(inventory_message(state));
    for (std::size_t i = hub.viewers.size(); i-- > 0;) hub.viewers[i]->tell(hub.inventory);
  }
  const double reached = speed.read(state.wall_s, state.time_s);
  const auto message = std::make_shared<const std::string>(state_message(state, ++states, reached, hub.viewers.size()));
  for (std::size_t i = hub.viewers.size(); i-- > 0;) hub.viewers[i]->show(message);
}

void View::Implementation::wait_and_look() {
  next_look.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(hub.limits.period_s)));
  next_look.async_wait([this](error_code cancelled) {
    if (cancelled) return;
    looking = !hub.viewers.empty();
    if (looking) look();
  });
}

View::View(server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits)
    : impl_(std::make_unique<Implementation>(world, options, limits)) {
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->serve(); });
}

View::~View() {
  impl_->hub.io.stop();
  impl_->thread.join();
}

std::uint16_t View::port() const {
  return impl_->acceptor.local_endpoint().port();
}

std::string View::url() const {
  const bool v6 = impl_->address.find(':') != std::string::npos;
  const auto ip = asio::ip::make_address(impl_->address);
  const std::string host =
      ip.is_unspecified() ? impl_->hub.own_name : (v6 ? "[" + impl_->address + "]" : impl_->address);
  const std::string& token = impl_->hub.token;
  return fmt::format("http://{}:{}/{}{}", host, port(), token.empty() ? "" : "#token=", token);
}

std::unique_ptr<View> open_view(server::WorldServer& world, const ViewOptions& options) {
  if (!options.on) return nullptr;
  try {
    auto view = std::make_unique<View>(world, options);
    spdlog::info("live view: {}", view->url());
    return view;
  } catch (const std::runtime_error& error) {
    spdlog::warn("no live view: {}", error.what());
    return nullptr;
  }
}

}  // namespace kenaf::live
