#include "server/image_server/feed.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "camera/jpeg.hpp"
#include "server/image_server/drawing.hpp"
#include "server/image_server/exposure.hpp"
#include "server/image_server/view_board.hpp"

namespace kenaf::image_server {

namespace asio = boost::asio;

namespace {

using Clock = std::chrono::steady_clock;

// Robots come and go and readers lose interest even while time is stopped: period of the check in that case.
constexpr std::chrono::milliseconds kLookAnyway{100};
constexpr double kFar_hz = 5;  // a reader waits for a picture from a slower camera

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

// State that the world's thread needs to answer, even if the feed is gone by then.
struct Exchange {
  camera::SnapshotTaker taker;  // for the world's thread only
  // queued: a request waits for the world's thread; there is never a second one. at_once: do not wait for the next
  // exposure to fall due.
  std::atomic<bool> queued = false, at_once = false;
  std::mutex mutex;
  std::function<void(std::shared_ptr<Exposure>)> take;  // hands over to the feed's thread; empty: the feed has ended

  void answer(const world_server::Simulation& simulation, const std::shared_ptr<Exposure>& out) {
    expose(simulation, taker, *out);
    const std::lock_guard lock(mutex);
    if (take) take(out);
  }
};

}  // namespace

struct Feed::Implementation {
  explicit Implementation(world_server::WorldServer& world_server) : world(world_server) {}

  void wake();
  void ask(bool at_once);
  void take(std::shared_ptr<Exposure> exposure);
  void settle(const WantedSizes& wanted, const std::vector<camera::RobotSnapshot>& robots);
  struct Due {
    CameraId id;
    BySize<bool> sizes;
  };
  std::vector<Due> due_at(const Exposure& exposure);
  void draw(const Exposure& exposure, const std::vector<Due>& due);
  FramePtr draw_one(const Exposure& exposure, std::size_t robot, std::size_t camera, PictureSize size);
  void stand_still(CameraId id, const std::string& why);
  void ask_later(const Exposure& exposure);
  void publish_due();
  void fall_asleep();
  void tell();

  world_server::WorldServer& world;

  // For any thread.
  ViewBoard board;
  std::mutex listeners_mutex;
  std::map<std::uint64_t, std::function<void()>> listeners;
  std::uint64_t last_listener = 0;

  // For the feed's thread only.
  struct Drawn {
    BySize<Drawing> drawings;  // those of sizes that nobody looks at are empty
    std::optional<Tick> last;
    std::uint64_t last_step = 0;  // of the last exposure
    Clock::time_point last_wall;
    std::uint64_t number = 0;
    double rate_hz = 0;
    BySize<bool> wanted{};
    bool faulty = false;
    bool left_out = false;  // the last exposure, because it was late

    BySize<bool> missing() const {
      BySize<bool> out{};
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = wanted[i] && !drawings[i].has_image();
      return out;
    }
  };
  struct Waiting {
    Clock::time_point until;
    FramePtr frame;
  };
  std::map<CameraId, Drawn> drawn;
  std::vector<Waiting> waiting;          // for their latency to pass
  std::unique_ptr<camera::Scene> scene;  // built when it is first needed
  camera::JpegEncoder encoder;
  bool awake = false;
  std::uint64_t asked = 0;                  // the newest request
  std::optional<std::uint64_t> taken_step;  // of the exposure taken last
  std::shared_ptr<Exposure> spare;
  std::shared_ptr<Exchange> exchange = std::make_shared<Exchange>();

  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  asio::steady_timer ask_timer{io}, look_timer{io}, publish_timer{io};
  std::thread thread;
};

// A view requested for the first time: asks the world at once what it shows.
void Feed::Implementation::wake() {
  awake = true;
  ask(true);
}

// One answer is awaited at a time: a newer request replaces one that still waits for its step.
void Feed::Implementation::ask(bool at_once) {
  // Time-out for the answer: if none comes, asks again, for the present state.
  look_timer.expires_after(kLookAnyway);
  look_timer.async_wait([this](boost::system::error_code cancelled) {
    if (!cancelled && awake) ask(true);
  });
  if (at_once) exchange->at_once = true;

  // The cameras being viewed; without any there is no next exposure to wait for.
  std::vector<DueCamera> cameras;
  for (const auto& [id, camera] : drawn) {
    if (any_of(camera.wanted) && !camera.faulty) cameras.push_back({camera.rate_hz, camera.last});
  }
  if (!at_once && cameras.empty()) return;

  // A request not yet read by the world's thread also covers this one.
  if (exchange->queued.exchange(true)) return;
  // Reuses the memory of an earlier answer if it is free.
  auto exposure = spare ? std::move(spare) : std::make_shared<Exposure>();
  spare = nullptr;
  exposure->asked = ++asked;

  // On the world's thread: requests a call at the step of the next exposure, or at once.
  world.ask([exchange = exchange, exposure, cameras = std::move(cameras)](world_server::Simulation& simulation) {
    exchange->queued = false;
    std::uint64_t step = simulation.world.step_count();
    if (!exchange->at_once.exchange(false))
      step = next_exposure(cameras, step, simulation.world.settings().time_step_s);
    simulation.call_at(exchange.get(), step, [exchange, exposure](world_server::Simulation& world_then) {
      exchange->answer(world_then, exposure);
    });
  });
}

void Feed::Implementation::take(std::shared_ptr<Exposure> exposure) {
  if (!awake) return;
  const bool newest = exposure->asked == asked;
  const ViewBoard::Settled views = board.settle(*exposure);
  settle(views.wanted, exposure->world.robots);
  if (views.changed) tell();
  const std::vector<Due> due = due_at(*exposure);
  const bool wanted = std::ranges::any_of(drawn, [](const auto& entry) { return any_of(entry.second.wanted); });
  if (!wanted && board.is_empty()) return fall_asleep();
  // If the clock sets the pace, request the next exposure before drawing this one: even if drawing is late, the request
  // is not.
  if (newest && exposure->speed > 0) ask(false);
  if (!due.empty()) draw(*exposure, due);
  if (newest && exposure->speed == 0) ask_later(*exposure);
  spare = std::move(exposure);
}

// The cameras that expose now, with the sizes in which to draw them.
std::vector<Feed::Implementation::Due> Feed::Implementation::due_at(const Exposure& exposure) {
  const Clock::duration waited = Clock::now() - exposure.wall;
  const bool time_stands = taken_step == exposure.step;
  taken_step = exposure.step;
  std::vector<Due> due;
  for (auto& [id, camera] : drawn) {
    if (!any_of(camera.wanted) || camera.faulty) continue;
    if (!exposes_at({camera.rate_hz, camera.last}, exposure.step, exposure.time_step_s)) {
      // Where the next exposure is far, a size that is new does not wait for it.
      const bool is_far = time_stands || (exposure.speed > 0 && camera.rate_hz * exposure.speed < kFar_hz);
      const BySize<bool> missing = camera.missing();
      if (!is_far || !any_of(missing)) continue;
      if (camera.last_step == exposure.step) {
        due.push_back({id, missing});
        continue;
      }
    }
    // Half a period late already: the next one is fresher. Never twice in a row, or a busy machine would show nothing.
    const bool late = camera.last && exposure.speed > 0 && waited > seconds(0.5 / (camera.rate_hz * exposure.speed));
    camera.left_out = late && !camera.left_out;
    if (!camera.left_out) due.push_back({id, camera.wanted});
    const Tick tick = tick_at(exposure.step, exposure.time_step_s, camera.rate_hz);
    // after a reset time restarts, while numbers continue
    camera.number += camera.last && tick > *camera.last ? tick - *camera.last : 1;
    camera.last = tick;
    camera.last_step = exposure.step;
    camera.last_wall = exposure.wall;
  }
  return due;
}

// Starts and ends the drawing of cameras by who looks at them.
void Feed::Implementation::settle(const WantedSizes& wanted, const std::vector<camera::RobotSnapshot>& robots) {
  const auto wanted_of = [&](const CameraId& id) {
    const auto found = wanted.find(id);
    return found == wanted.end() ? BySize<bool>{} : found->second;
  };
  std::erase_if(waiting,
                [&](const Waiting& entry) { return !wanted_of(entry.frame->id)[index_of(entry.frame->size)]; });
  const auto robot_of = [&](CameraId id) { return std::ranges::find(robots, id.robot, &camera::RobotSnapshot::id); };
  std::erase_if(drawn, [&](const auto& entry) { return robot_of(entry.first) == robots.end(); });
  for (const auto& [id, sizes] : wanted) {
    drawn[id].rate_hz = robot_of(id)->description->cameras[id.camera].rate_hz;
  }
  for (auto& [id, camera] : drawn) {
    camera.wanted = wanted_of(id);
    for (std::size_t i = 0; i < camera.wanted.size(); ++i)
      if (!camera.wanted[i]) camera.drawings[i] = {};
    if (any_of(camera.wanted)) continue;
    // its number is kept, so that no reader sees it twice
    camera.last.reset();
    camera.faulty = false;
  }
}

void Feed::Implementation::draw(const Exposure& exposure, const std::vector<Due>& due) {
  try {
    if (!scene) scene = std::make_unique<camera::Scene>(world.world_description());
    scene->update(exposure.world);
  } catch (const std::exception& error) {
    scene.reset();  // it may be partly updated
    for (const auto& [id, sizes] : due) stand_still(id, error.what());
    return;
  }
  for (const auto& [id, sizes] : due) {
    const auto& robots = exposure.world.robots;
    const auto robot = std::ranges::find(robots, id.robot, &camera::RobotSnapshot::id) - robots.begin();
    const double latency_s = robots[static_cast<std::size_t>(robot)].description->cameras[id.camera].latency_s;
    const Clock::duration latency = exposure.speed > 0 ? seconds(latency_s / exposure.speed) : Clock::duration::zero();
    try {
      for (const PictureSize size : kPictureSizes) {
        if (!sizes[index_of(size)]) continue;
        const FramePtr frame = draw_one(exposure, static_cast<std::size_t>(robot), id.camera, size);
        waiting.push_back({exposure.wall + latency, frame});
      }
    } catch (const std::exception& error) {
      stand_still(id, error.what());
    }
  }
  publish_due();
}

FramePtr Feed::Implementation::draw_one(const Exposure& exposure, std::size_t robot_index, std::size_t camera_index,
                                        PictureSize size) {
  const camera::RobotSnapshot& robot = exposure.world.robots[robot_index];
  Drawn& state = drawn.at({robot.id, camera_index});
  const auto frame = std::make_shared<Frame>();
  frame->id = {robot.id, camera_index};
  frame->robot = robot.name;
  frame->camera = robot.description->cameras[camera_index].name;
  frame->size = size;
  frame->number = state.number;
  frame->robot_time_s = exposure.world.time_s;
  frame->exposed = state.last_wall;
  frame->image = state.drawings[index_of(size)].draw(*scene, exposure, robot_index, camera_index, size, encoder);
  return frame;
}

void Feed::Implementation::stand_still(CameraId id, const std::string& why) {
  spdlog::error("camera {} of robot {} stopped: {}", id.camera, static_cast<std::uint32_t>(id.robot), why);
  drawn.at(id).faulty = true;
  board.stop(id, why);
  tell();
}

// If the clock sets no pace, the rate does, by the wall clock.
void Feed::Implementation::ask_later(const Exposure& exposure) {
  double rate_hz = 1 / std::chrono::duration<double>(kLookAnyway).count();
  for (const auto& [id, camera] : drawn) {
    if (any_of(camera.wanted)) rate_hz = std::max(rate_hz, camera.rate_hz);
  }
  ask_timer.expires_at(exposure.wall + seconds(1 / rate_hz));
  ask_timer.async_wait([this](boost::system::error_code cancelled) {
    if (!cancelled && awake) ask(false);
  });
}

void Feed::Implementation::publish_due() {
  // Publishes frames whose latency has passed, unless a newer one is shown; the earliest of the others sets the timer.
  bool published = false;
  const Clock::time_point now = Clock::now();
  Clock::time_point next = Clock::time_point::max();
  for (const Waiting& entry : waiting) {
    if (entry.until > now)
      next = std::min(next, entry.until);
    else if (board.show(entry.frame))
      published = true;
  }

  std::erase_if(waiting, [&](const Waiting& entry) { return entry.until <= now; });
  if (published) tell();
  if (waiting.empty()) return;
  publish_timer.expires_at(next);
  publish_timer.async_wait([this](boost::system::error_code cancelled) {
    if (!cancelled) publish_due();
  });
}

// The first request from now on wakes it again.
void Feed::Implementation::fall_asleep() {
  awake = false;
  waiting.clear();
  spare.reset();
  ask_timer.cancel();
  look_timer.cancel();
  publish_timer.cancel();
}

void Feed::Implementation::tell() {
  const std::lock_guard lock(listeners_mutex);
  for (const auto& [number, notify] : listeners) notify();
}

Feed::Feed(world_server::WorldServer& world) : impl_(std::make_unique<Implementation>(world)) {
  impl_->exchange->take = [feed = impl_.get()](std::shared_ptr<Exposure> exposure) {
    asio::post(feed->io, [feed, exposure = std::move(exposure)]() mutable { feed->take(std::move(exposure)); });
  };
  impl_->thread = std::thread([feed = impl_.get()] {
    pthread_setname_np(pthread_self(), "kenaf-cameras");
    for (;;) {
      try {
        feed->io.run();
        return;
      } catch (const std::exception& error) {
        spdlog::error("cameras: {}", error.what());  // concerns one picture; the next is tried
      }
    }
  });
}

Feed::~Feed() {
  {
    const std::lock_guard lock(impl_->exchange->mutex);
    impl_->exchange->take = nullptr;
  }
  impl_->io.stop();
  impl_->thread.join();
}

Feed::Look Feed::look(std::string_view view, PictureSize size) {
  ViewBoard::Look out = impl_->board.look(view, size);
  // wake() belongs to the feed's thread.
  if (out.is_new) asio::post(impl_->io, [feed = impl_.get()] { feed->wake(); });
  return std::move(out.seen);
}

std::vector<std::shared_ptr<const Frame>> Feed::newest() const {
  return impl_->board.newest();
}

std::shared_ptr<void> Feed::listen(std::function<void()> notify) {
  const std::lock_guard lock(impl_->listeners_mutex);
  const std::uint64_t number = ++impl_->last_listener;
  impl_->listeners.emplace(number, std::move(notify));
  return {nullptr, [feed = impl_.get(), number](void*) {
            const std::lock_guard handle_lock(feed->listeners_mutex);
            feed->listeners.erase(number);
          }};
}

}  // namespace kenaf::image_server
