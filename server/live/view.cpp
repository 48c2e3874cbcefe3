#include "server/live/view.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/live/hub.hpp"
#include "server/live/messages.hpp"
#include "server/live/picture_stream.hpp"
#include "server/live/scene_bytes.hpp"
#include "server/live/speed_meter.hpp"
#include "server/live/viewer.hpp"
#include "server/live/web_server.hpp"
#include "server/live/world_list.hpp"
#include "server/world_server/manual_drive.hpp"

namespace kenaf::live {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

namespace http = boost::beast::http;

Route scene_route(const Hub& hub) {
  return [&hub](const Visit& visit) -> std::variant<Reply, TakeOver> {
    if (!visit.rest.empty()) return reply_in_words(http::status::not_found, "There is no such file.\n");
    return Reply{http::status::ok, "application/octet-stream", hub.scene};
  };
}

Route worlds_route(std::shared_ptr<const std::string> worlds) {
  return [worlds = std::move(worlds)](const Visit& visit) -> std::variant<Reply, TakeOver> {
    if (!visit.rest.empty()) return reply_in_words(http::status::not_found, "There is no such file.\n");
    return Reply{http::status::ok, "application/json", worlds};
  };
}

Route viewer_route(Hub& hub) {
  return [&hub](const Visit& visit) -> std::variant<Reply, TakeOver> {
    if (!visit.rest.empty()) return reply_in_words(http::status::not_found, "There is no such file.\n");
    if (!boost::beast::websocket::is_upgrade(visit.request)) {
      return reply_in_words(http::status::upgrade_required, "This address serves WebSockets only.\n");
    }
    if (hub.viewers.size() >= hub.limits.viewers) {
      return reply_in_words(http::status::service_unavailable, "Too many viewers are already connected.\n");
    }
    return TakeOver([&hub](boost::beast::tcp_stream stream, PageRequest upgrade) {
      start_viewer(hub, std::move(stream), std::move(upgrade));
    });
  };
}

Route picture_route(Hub& hub) {
  return [&hub](const Visit& visit) -> std::variant<Reply, TakeOver> {
    auto picture = parse_picture_path(visit.rest, visit.query);
    if (!picture) {
      return reply_in_words(http::status::not_found,
                            "There is no such picture; ask for /camera/ROBOT/CAMERA.jpg or .mjpg, with ?size=full or "
                            "?size=half.\n");
    }
    if (hub.cameras == nullptr) return reply_in_words(http::status::not_found, "The cameras are off.\n");
    if (hub.picture_readers.size() >= hub.limits.pictures) {
      return reply_in_words(http::status::service_unavailable, "Too many camera viewers are already connected.\n");
    }
    return TakeOver([&hub, picture = std::move(*picture)](boost::beast::tcp_stream stream, const PageRequest&) {
      start_pictures(hub, *hub.cameras, std::move(stream), picture);
    });
  };
}

}  // namespace

struct View::Implementation {
  Implementation(world_server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits,
                 image_server::Feed* cameras)
      : hub{.world = world,
            .limits = limits,
            .scene = std::make_shared<const std::string>(scene_bytes(world.world_description())),
            .cameras = cameras,
            .site = {.limits = limits,
                     .token = token_for(options),
                     .own_name = machine_name(),
                     .assets = load_assets("index.html")}},
        server(hub.site, options) {
    auto worlds =
        std::make_shared<const std::string>(worlds_message(start_command(options, server.port()), installed_worlds()));
    hub.site.routes = {{"/scene", scene_route(hub)},
                       {"/worlds", worlds_route(std::move(worlds))},
                       {"/ws", viewer_route(hub)},
                       {"/camera", picture_route(hub)}};
    hub.viewer_came = [this] {
      if (!looking) look();
    };
    if (cameras == nullptr) return;
    frame_listener = cameras->listen([this] {
      asio::post(hub.site.io, [this] {
        for (std::size_t i = hub.picture_readers.size(); i-- > 0;) hub.picture_readers[i]->look();
      });
    });
  }

  world_server::StateExtras asked_for() const;
  void look();
  void show();
  void wait_and_look();

  Hub hub;
  asio::steady_timer next_look{hub.site.io};
  // Passed to the world's thread and back: owned by one of the two at a time.
  world_server::WorldState state;
  std::optional<physics::RobotDimensions> placeable;  // without tracks: there is none
  world_server::WorldState shown;                     // the state whose inventory the viewers have
  bool looking = false;                               // a request for the state is under way or planned
  std::uint64_t states = 0;
  SpeedMeter speed;
  std::shared_ptr<void> frame_listener;
  WebServer server;  // last: its thread ends before the members it uses
};

// By any viewer. The world's thread casts the rays, so that only so many robots are looked at, of those that came
// first.
world_server::StateExtras View::Implementation::asked_for() const {
  constexpr std::size_t kMostSensors = 8;
  world_server::StateExtras extras;
  for (const Viewer* viewer : hub.viewers) {
    const auto& [contacts, sensors] = viewer->shown();
    extras.contacts |= contacts;
    const bool known = std::ranges::find(extras.sensors, sensors) != extras.sensors.end();
    if (sensors != 0 && !known && extras.sensors.size() < kMostSensors) extras.sensors.push_back(sensors);
  }
  return extras;
}

void View::Implementation::look() {
  looking = true;
  hub.ask(
      [this, extras = asked_for()](world_server::Simulation& simulation) {
        world_server::read_state(simulation, state, extras);
        if (!placeable) {
          placeable.emplace();  // asked for once, even if it throws
          if (const auto* robot = world_server::robot_to_place(simulation)) placeable = physics::dimensions_of(*robot);
        }
        return true;
      },
      [this](bool) {
        show();
        wait_and_look();
      });
}

void View::Implementation::show() {
  if (!hub.inventory || !same_inventory(state, shown)) {
    shown = state;
    hub.inventory = std::make_shared<const std::string>(
        inventory_message(state, placeable && !placeable->tracks.empty() ? placeable : std::nullopt));
    for (std::size_t i = hub.viewers.size(); i-- > 0;) hub.viewers[i]->tell(hub.inventory);
  }
  const double reached = speed.read(state.wall_s, state.time_s);
  const auto now = std::chrono::steady_clock::now();
  std::vector<FrameAge> frames;
  if (hub.cameras != nullptr) {
    for (const auto& frame : hub.cameras->newest()) {
      frames.push_back({frame->id, frame->number, frame->robot_time_s, image_server::age_s(*frame, now)});
    }
  }
  // One message for all pages that show the same; as a rule that is one message.
  ++states;
  const double sent_s = std::chrono::duration<double>(now.time_since_epoch()).count();
  std::vector<std::pair<ShowRequest, Message>> messages;
  for (std::size_t i = hub.viewers.size(); i-- > 0;) {
    const ShowRequest shown_there = hub.viewers[i]->shown();
    auto made = std::ranges::find(messages, shown_there, &std::pair<ShowRequest, Message>::first);
    if (made == messages.end()) {
      messages.emplace_back(shown_there, std::make_shared<const std::string>(state_message(
                                             state, states, sent_s, reached, hub.viewers.size(), frames, shown_there)));
      made = std::prev(messages.end());
    }
    hub.viewers[i]->show(made->second);
  }
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

View::View(world_server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits,
           image_server::Feed* cameras)
    : impl_(std::make_unique<Implementation>(world, options, limits, cameras)) {
  impl_->server.start();
}

View::~View() = default;

std::uint16_t View::port() const {
  return impl_->server.port();
}

std::string View::url() const {
  return impl_->server.url();
}

std::unique_ptr<View> open_view(world_server::WorldServer& world, const ViewOptions& options,
                                image_server::Feed* cameras) {
  if (!options.on) return nullptr;
  try {
    auto view = std::make_unique<View>(world, options, ViewLimits{}, cameras);
    const std::string url = view->url();
    spdlog::info("live view: {}", url);
    // A generated token is announced only here, so it must not depend on the log level.
    const bool made_token = options.token.empty() && url.find("#token=") != std::string::npos;
    if (made_token && !spdlog::should_log(spdlog::level::info)) fmt::print(stderr, "live view: {}\n", url);
    return view;
  } catch (const std::runtime_error& error) {
    if (options.asked_for) throw std::runtime_error(fmt::format("no live view: {}", error.what()));
    spdlog::warn("no live view: {}", error.what());
    return nullptr;
  }
}

}  // namespace kenaf::live
