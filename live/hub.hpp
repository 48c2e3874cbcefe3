// What all pages of the live view share, beside its site. On the view's thread alone, but for the members of `world` that are for any
// thread.
#pragma once

#include <boost/asio/post.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "camera/server/feed.hpp"
#include "live/site.hpp"
#include "live/view.hpp"
#include "physics/server/world_state.hpp"

namespace kenaf::live {

class Viewer;
class PictureReader;

struct Hub {
  server::WorldServer& world;
  const ViewLimits limits;
  const std::shared_ptr<const std::string> scene;
  camera::Feed* const cameras = nullptr;  // null: they are off

  std::uint32_t last_operator = 0;
  std::vector<Viewer*> viewers{};
  std::vector<PictureReader*> picture_readers{};
  std::shared_ptr<const std::string> inventory{};  // as of the newest state
  std::function<void()> viewer_came{};

  // Last, so that it ends first: what its handlers hold knows the others.
  Site site;

  // Has the world's thread carry `request` out, and then this one `done` with what it returned.
  template <typename Request, typename Done>
  void ask(Request request, Done done) {
    world.ask([this, request = std::move(request), done = std::move(done)](server::Simulation& simulation) mutable {
      boost::asio::post(site.io, [answer = request(simulation), done = std::move(done)]() mutable { done(answer); });
    });
  }
};

}  // namespace kenaf::live
