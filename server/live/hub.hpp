// What all pages of the live view share, beside its site. On the view's thread alone, but for the members of `world`
// that are for any thread.
#pragma once

#include <boost/asio/post.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "server/image_server/feed.hpp"
#include "server/live/site.hpp"
#include "server/live/view.hpp"
#include "server/world_server/world_state.hpp"

namespace kenaf::live {

class Viewer;
class PictureReader;

struct Hub {
  world_server::WorldServer& world;
  const ViewLimits limits;
  const std::shared_ptr<const std::string> scene;
  image_server::Feed* const cameras = nullptr;  // null: they are off

  // By it a page that was open before sees that this is another server, with another world.
  const std::uint32_t server_number = std::random_device{}();
  std::uint32_t last_operator = 0;
  std::vector<Viewer*> viewers{};
  std::vector<PictureReader*> picture_readers{};
  std::shared_ptr<const std::string> inventory{};  // as of the newest state
  std::function<void()> viewer_came{};

  // Near the end, so that it ends before the others: what its handlers hold knows them.
  Site site;

  // Whom the world owes an answer. They are kept here, by number, and not in the world's queue: that one drops what it
  // no longer carries out on its own thread, or after all of this has ended. They end before the site: they are its
  // connections.
  std::map<std::uint64_t, std::function<void()>> waiting{};
  std::uint64_t last_question = 0;
  std::shared_ptr<const bool> here = std::make_shared<const bool>(true);

  // Has the world's thread carry `request` out, and then this one `done` with what it returned; neither, where the
  // world begins to run only after this has ended.
  template <typename Request, typename Done>
  void ask(Request request, Done done) {
    auto answer = std::make_shared<std::invoke_result_t<Request&, world_server::Simulation&>>();
    const std::uint64_t number = ++last_question;
    waiting.emplace(number, [answer, done = std::move(done)] { done(*answer); });
    world.ask([this, still = std::weak_ptr(here), request = std::move(request), answer = std::move(answer),
               number](world_server::Simulation& simulation) {
      if (still.expired()) return;
      *answer = request(simulation);
      boost::asio::post(site.io, [this, number] { waiting.extract(number).mapped()(); });
    });
  }
};

}  // namespace kenaf::live
