// State shared by all pages of the live view, and its site. For the view's thread only, except the members of
// `world` that are for any thread.
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

  // Lets a page that was open before detect that this is another server, with another world.
  const std::uint32_t server_number = std::random_device{}();
  std::uint32_t last_operator = 0;
  std::vector<Viewer*> viewers{};
  std::vector<PictureReader*> picture_readers{};
  std::shared_ptr<const std::string> inventory{};  // for the newest state
  std::function<void()> viewer_came{};

  // Near the end, so that it is destroyed before the others: its handlers refer to them.
  Site site;

  // Callbacks awaiting an answer of the world. They are kept here, by number, and not in the world's queue: the queue
  // would destroy those it no longer carries out on its own thread, or after this has ended. They are destroyed before
  // the site, whose connections they are.
  std::map<std::uint64_t, std::function<void()>> waiting{};
  std::uint64_t last_question = 0;
  std::shared_ptr<const bool> here = std::make_shared<const bool>(true);

  // Has the world's thread carry out `request`, and then this thread call `done` with its result, or with an empty one
  // if it threw; neither, if the world starts to run only after this has ended.
  template <typename Request, typename Done>
  void ask(Request request, Done done) {
    auto answer = std::make_shared<std::invoke_result_t<Request&, world_server::Simulation&>>();
    const std::uint64_t number = ++last_question;
    waiting.emplace(number, [answer, done = std::move(done)] { done(*answer); });
    world.ask([this, still = std::weak_ptr(here), request = std::move(request), answer = std::move(answer),
               number](world_server::Simulation& simulation) {
      if (still.expired()) return;
      const auto answer_page = [this, number] {
        boost::asio::post(site.io, [this, number] { waiting.extract(number).mapped()(); });
      };
      try {
        *answer = request(simulation);
      } catch (...) {  // the world's thread logs it; the page must not wait for ever
        answer_page();
        throw;
      }
      answer_page();
    });
  }
};

}  // namespace kenaf::live
