// Cost of live cameras, and age of their pictures at the reader: a robot that drives, both its cameras, a reader of the
// image server for each, on loopback.
// 1. At speed 1: thread CPU time of drawing and of sending, and each frame's age when its last byte is read.
// 2. At speed 0: robot time per CPU second of the world's thread without readers, with, without; the median of the
// turns. Other load on the machine does not change thread CPU time; ages need an idle machine.
// Usage: camera_feed [seconds at speed 1, default 20] [turns at speed 0, default 9] [world, default step-200]
// Status 1: more than half a core, a median age above 50 ms, or a world that is slower by more than 5 %.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"
#include "server/world_server/manual_drive.hpp"
#include "server/world_server/world_server.hpp"

using namespace kenaf;
using Clock = std::chrono::steady_clock;

namespace {

// CPU time of this process' threads of that name; resolution 1 ns.
double cpu_of_threads_s(const std::string& name) {
  double sum_s = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm"), comm);
    if (comm != name) continue;
    double run_ns = 0;
    std::ifstream(task.path() / "schedstat") >> run_ns;
    sum_s += 1e-9 * run_ns;
  }
  return sum_s;
}

double cpu_of_thread_s(std::thread& thread) {
  clockid_t clock{};
  pthread_getcpuclockid(thread.native_handle(), &clock);
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

// Exposures of the frames that were published, by camera and number.
class Exposures {
 public:
  explicit Exposures(image_server::Feed& feed)
      : listening_(feed.listen([this, &feed] {
          const std::lock_guard lock(mutex_);
          for (const auto& frame : feed.newest()) exposed_[{frame->camera, frame->number}] = frame->exposed;
        })) {}
  double age_ms(const std::string& camera, std::uint64_t number) {
    const Clock::time_point now = Clock::now();
    for (;;) {  // the frame may be read before the feed has called the listener
      {
        const std::lock_guard lock(mutex_);
        const auto found = exposed_.find({camera, number});
        if (found != exposed_.end()) return 1e3 * std::chrono::duration<double>(now - found->second).count();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<std::string, std::uint64_t>, Clock::time_point> exposed_;
  std::shared_ptr<void> listening_;
};

struct Reading {
  std::vector<double> age_ms;
  std::uint64_t first = 0, last = 0, bytes = 0;
};

// Requests frame after frame of a camera, as a client does.
class Reader {
 public:
  Reader(std::uint16_t port, std::string camera, Exposures& exposures)
      : camera_(std::move(camera)), exposures_(exposures), thread_([this, port] { read(port); }) {}
  ~Reader() {
    ending_ = true;
    thread_.join();
  }
  // Returns what was read since the last call.
  Reading take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(reading_, {});
  }

 private:
  void read(std::uint16_t port);

  const std::string camera_;
  Exposures& exposures_;
  std::mutex mutex_;
  Reading reading_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

void Reader::read(std::uint16_t port) {
  // Connect and choose the camera ("V", length, name).
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::string view = "V" + std::string(1, static_cast<char>(camera_.size())) + camera_;
  bool fine = ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
              ::send(descriptor, view.data(), view.size(), 0) > 0;
  // Reads exactly `count` bytes; false at the end of the connection.
  const auto receive = [descriptor](std::uint8_t* to, std::size_t count) {
    while (count > 0) {
      const ssize_t got = ::recv(descriptor, to, count, 0);
      if (got <= 0) return false;
      to += got;
      count -= static_cast<std::size_t>(got);
    }
    return true;
  };

  // Request after request: a header of type and big-endian size, then the picture.
  std::vector<std::uint8_t> bytes;
  while (fine && !ending_) {
    std::uint8_t header[5];
    fine = ::send(descriptor, "OK", 2, 0) == 2 && receive(header, sizeof header);
    if (!fine) break;
    bytes.resize(std::size_t{header[1]} << 24 | std::size_t{header[2]} << 16 | std::size_t{header[3]} << 8 | header[4]);
    fine = receive(bytes.data(), bytes.size());
    if (!fine || header[0] == 255 || bytes.size() < 200) continue;

    // The JPEG's comment, 6 bytes in, names the frame; a frame that is sent again is not counted.
    const std::string start(bytes.begin() + 6, bytes.begin() + 200);
    unsigned long long number = 0;
    if (std::sscanf(start.c_str(), "kenaf-frame/1 number=%llu", &number) != 1) continue;
    const double age_ms = exposures_.age_ms(camera_, number);
    const std::lock_guard lock(mutex_);
    if (number == reading_.last) continue;
    if (reading_.first == 0) reading_.first = number;
    reading_.last = number;
    reading_.bytes += bytes.size();
    reading_.age_ms.push_back(age_ms);
  }
  ::close(descriptor);
}

struct World {
  World(const std::string& name, double speed) : server(options(name, speed)), thread([this] { server.run(); }) {
    server.ask([](world_server::Simulation& simulation) {
      std::uint32_t id = 0;
      const world_server::OperatorId nobody{1};
      world_server::place_robot_by_hand(simulation, nobody, id);
      world_server::Session& session = *simulation.find_session(id);
      // Released, with a last command to turn on the spot: nobody has to repeat it.
      world_server::let_go(simulation, id, nobody);
      session.robot->command.track_speed_mps = {-0.1, 0.1};
      simulation.apply_command(session);
    });
  }
  ~World() {
    server.stop();
    thread.join();
  }
  double time_s() {
    std::promise<double> promise;
    server.ask([&](world_server::Simulation& simulation) { promise.set_value(simulation.world.time_s()); });
    return promise.get_future().get();
  }
  static world_server::ServerOptions options(const std::string& name, double speed) {
    world_server::ServerOptions options;
    options.world = name;
    options.port = 0;
    options.speed = speed;
    return options;
  }
  world_server::WorldServer server;
  std::thread thread;
};

struct Readers {
  explicit Readers(World& world)
      : feed(world.server),
        images(feed, "127.0.0.1", 0, image_server::ImageType::good),
        exposures(feed),
        front(images.port(), "Camera", exposures),
        top(images.port(), "BirdsEye", exposures) {}
  image_server::Feed feed;
  image_server::ImageServer images;
  Exposures exposures;
  Reader front, top;
};

bool measure_pictures(const std::string& world_name, int seconds) {
  World world(world_name, 1);
  Readers readers(world);
  std::this_thread::sleep_for(std::chrono::seconds(2));  // the scene is built, and the first pictures allocate
  readers.front.take();
  readers.top.take();
  const double draw_s = cpu_of_threads_s("kenaf-cameras"), send_s = cpu_of_threads_s("kenaf-images");
  const double time_s = world.time_s();
  std::this_thread::sleep_for(std::chrono::seconds(seconds));
  const Reading front = readers.front.take(), top = readers.top.take();
  const double passed_s = world.time_s() - time_s;
  const double draw = (cpu_of_threads_s("kenaf-cameras") - draw_s) / passed_s;
  const double send = (cpu_of_threads_s("kenaf-images") - send_s) / passed_s;
  fmt::print("{}, speed 1, {} s of robot time {:.2f} s: drawing {:.3f} of a core, sending {:.3f}\n", world_name,
             seconds, passed_s, draw, send);
  bool fine = draw + send <= 0.5;
  fmt::print("{:<10} {:>8} {:>8} {:>8} {:>8} {:>10} {:>10} {:>10}\n", "camera", "frames", "missed", "kB", "median ms",
             "95 % ms", "99 % ms", "worst ms");
  for (const auto& [name, reading] : {std::pair<const char*, const Reading&>{"Camera", front}, {"BirdsEye", top}}) {
    const std::size_t frames = reading.age_ms.size();
    const double median_ms = quantile(reading.age_ms, 0.5);
    fmt::print("{:<10} {:>8} {:>8} {:>8.1f} {:>8.1f} {:>10.1f} {:>10.1f} {:>10.1f}\n", name, frames,
               reading.last - reading.first + 1 - frames,
               1e-3 * static_cast<double>(reading.bytes) / static_cast<double>(std::max<std::size_t>(frames, 1)),
               median_ms, quantile(reading.age_ms, 0.95), quantile(reading.age_ms, 0.99), quantile(reading.age_ms, 1));
    fine = fine && frames > 0 && median_ms <= 50;
  }
  return fine;
}

// Robot time per CPU second of the world's thread.
double real_time_factor(World& world) {
  const double cpu_s = cpu_of_thread_s(world.thread), time_s = world.time_s();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  return (world.time_s() - time_s) / (cpu_of_thread_s(world.thread) - cpu_s);
}

bool measure_physics(const std::string& world_name, int turns) {
  // One measurement to warm up.
  World world(world_name, 0);
  real_time_factor(world);
  std::vector<double> without, with, losses;
  std::uint64_t frames = 0;

  // The loss of a turn compares with the mean of before and after, so that a drift of the machine's speed cancels.
  for (int turn = 0; turn < turns; ++turn) {
    without.push_back(real_time_factor(world));
    {
      Readers readers(world);
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      readers.front.take();
      with.push_back(real_time_factor(world));
      frames += readers.front.take().age_ms.size();
    }
    const double after = real_time_factor(world);
    losses.push_back(1 - with.back() / (0.5 * (without.back() + after)));
  }

  // The median of the turns decides.
  const double loss = quantile(losses, 0.5);
  fmt::print(
      "{}, speed 0, {} turns: {:.1f} s of robot time per CPU second without readers, {:.1f} with: {:.1f} % less "
      "({:.1f} to {:.1f} % in the middle half of the turns), {:.0f} pictures a second of each camera\n",
      world_name, turns, quantile(without, 0.5), quantile(with, 0.5), 100 * loss, 100 * quantile(losses, 0.25),
      100 * quantile(losses, 0.75), static_cast<double>(frames) / (2.0 * turns));
  return loss <= 0.05;
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::warn);
  int seconds = 20, turns = 9;
  std::string world = "step-200";
  CLI::App app{"What pictures of cameras cost a world server", "camera_feed"};
  app.add_option("seconds", seconds, "at speed 1")->check(kenaf::command_line::whole_number(1, 86400));
  app.add_option("turns", turns, "at speed 0")->check(kenaf::command_line::whole_number(1, 10000));
  app.add_option("world", world, "a shipped name or an SDF file")->capture_default_str();
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  const bool pictures = measure_pictures(world, seconds), physics = measure_physics(world, turns);
  return pictures && physics ? 0 : 1;
}
