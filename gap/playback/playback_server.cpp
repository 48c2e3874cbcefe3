#include "gap/playback/playback_server.hpp"

#include <optional>
#include <utility>

#include "gap/playback/playback_path.hpp"
#include "gap/playback/shelf.hpp"
#include "server/live/scene_bytes.hpp"
#include "server/live/web_server.hpp"

namespace kenaf::gap::playback {
namespace {

namespace http = boost::beast::http;
using Bytes = std::shared_ptr<const std::string>;

constexpr std::size_t kMostKept_bytes = std::size_t{256} << 20;  // a run of 20 000 times is some 15 MB
constexpr std::string_view kJson = "application/json";

Bytes bytes_of(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

struct PlaybackServer::Implementation {
  Implementation(Playback what, const live::ViewOptions& options)
      : playback(std::move(what)),
        list(bytes_of(playback_json(playback))),
        shelf(kMostKept_bytes,
              [this](std::size_t run) { return played_run_json(playback, run, prepare_run(playback, run)); }),
        site{.limits = {},
             .token = live::token_for(options),
             .own_name = live::machine_name(),
             .assets = live::load_assets("playback.html")},
        server(site, options) {
    for (const physics::WorldDescription& world : playback.worlds) scenes.push_back(bytes_of(live::scene_bytes(world)));
    site.routes = {{"/playback", [this](const live::Visit& visit) { return answer(visit.rest); }}};
    shelf.look(playback.first);
  }

  live::Reply answer(std::string_view path) {
    const std::optional<PlaybackPath> asked = parse_playback_path(path);
    if (asked && !asked->run) return {http::status::ok, kJson, list};
    if (!asked || *asked->run >= playback.runs.size())
      return live::reply_in_words(http::status::not_found, "There is no such run.\n");
    const std::size_t run = *asked->run;
    if (asked->scene) return {http::status::ok, "application/octet-stream", scenes[playback.runs[run].world]};
    const Shelf::Look look = shelf.look(run);
    if (!look.failure.empty()) return live::reply_in_words(http::status::internal_server_error, look.failure + "\n");
    // The page asks again.
    if (!look.text) return live::reply_in_words(http::status::accepted, "The simulation is still running.\n");
    return {http::status::ok, kJson, look.text};
  }

  const Playback playback;
  const Bytes list;
  std::vector<Bytes> scenes;  // of Playback::worlds
  Shelf shelf;
  live::Site site;
  live::WebServer server;  // last: its thread ends before what it uses
};

PlaybackServer::PlaybackServer(Playback playback, const live::ViewOptions& options)
    : impl_(std::make_unique<Implementation>(std::move(playback), options)) {
  impl_->server.start();
}

PlaybackServer::~PlaybackServer() = default;

std::uint16_t PlaybackServer::port() const {
  return impl_->server.port();
}

std::string PlaybackServer::url() const {
  return impl_->server.url();
}

}  // namespace kenaf::gap::playback
