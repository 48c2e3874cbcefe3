// The C interface: checks arguments, converts units to SI and exceptions to return codes. Behaviour is in robot.cpp.
#include "kenaf/hrt.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <new>

#include "hrt/camera_stream.hpp"
#include "hrt/config.hpp"
#include "hrt/error.hpp"
#include "hrt/get_picture.hpp"
#include "hrt/presentation.hpp"
#include "hrt/robot.hpp"
#include "hrt/transport.hpp"

using kenaf::hrt::Cameras;
using kenaf::hrt::Error;
using kenaf::hrt::kDegrees;
using kenaf::hrt::kMillimetres;
using kenaf::hrt::Robot;
using kenaf::hrt::Snapshot;

namespace {

// The first published sizes: programs compiled then pass structs that end here.
constexpr std::size_t kFirstStateSize = sizeof(hrt_state);
constexpr std::size_t kFirstPictureSize = sizeof(hrt_picture);

thread_local char last_error[600];

// The one robot of the process. Never destroyed: user threads may outlive main().
struct Holder {
  std::mutex mutex;
  std::shared_ptr<Robot> robot;
  std::shared_ptr<Cameras> cameras;  // while a robot is open
  const char* under_way = nullptr;   // what a thread is doing with it: "opened", "closed"
  std::atomic<pid_t> owner = 0;      // the process that opened the robot
};
Holder& holder() {
  static Holder* const the_holder = new Holder;
  return *the_holder;
}

void remember(const char* text) {
  const std::size_t length = std::min(std::strlen(text), sizeof last_error - 1);
  std::memcpy(last_error, text, length);
  last_error[length] = '\0';
  std::replace(last_error, last_error + length, '\n', ' ');
}

// Every function of hrt.h runs in this: the one place where exceptions become return codes.
template <typename Body>
int guarded(Body&& body) noexcept {
  try {
    body();
    return HRT_OK;
  } catch (const Error& error) {
    remember(error.what());
    return error.code();
  } catch (const std::bad_alloc&) {
    remember("out of memory");
  } catch (const std::exception& error) {
    remember(error.what());
  } catch (...) {
    remember("unknown failure inside the library");
  }
  return HRT_E_INTERNAL;
}

// For a call that has something to finish before it fails: what `body` threw, or null.
template <typename Body>
std::exception_ptr failure_of(Body&& body) noexcept {
  try {
    body();
    return nullptr;
  } catch (...) {
    return std::current_exception();
  }
}
void throw_if(const std::exception_ptr& failure) {
  if (failure) std::rethrow_exception(failure);
}
void throw_if_lost(const Snapshot& snapshot) {
  if (snapshot.lost) throw snapshot.lost->error();
}

struct Opened {
  std::shared_ptr<Robot> robot;
  std::shared_ptr<Cameras> cameras;
};
Opened open_all() {
  Holder& h = holder();
  const std::lock_guard lock(h.mutex);
  if (!h.robot)
    throw Error(HRT_E_NOT_INITIALISED, "no robot is open: call hrt_kenaf_init() first and check its return value");
  return {h.robot, h.cameras};
}
std::shared_ptr<Robot> open_robot() {
  return open_all().robot;
}

void require(bool fine, const std::string& what) {
  if (!fine) throw Error(HRT_E_ARGUMENT, what);
}

// Throws if `value` is not a number from `minimum` to `maximum`.
void require_range(double value, double minimum, double maximum, const char* what) {
  require(value >= minimum && value <= maximum,
          fmt::format("{} must be from {} to {}, not {}", what, minimum, maximum, value));
}

void require_state(const hrt_state* state) {
  require(state != nullptr, "state is a null pointer");
  require(state->size >= kFirstStateSize && state->size <= sizeof(hrt_state),
          "state.size is wrong: begin with `hrt_state state = hrt_state_init();`");
}

// Copies as many bytes as the program's version of the struct has.
void copy_state(const Snapshot& snapshot, hrt_state& out) {
  hrt_state full = kenaf::hrt::state_from(snapshot);
  full.size = out.size;
  std::memcpy(&out, &full, out.size);
}

// Closes explicitly and not by the destructor: a call that has not returned yet may keep the robot alive, and with it
// the bus that the new robot needs.
void close_lost(Robot& robot) {
  try {
    robot.close();
  } catch (const std::exception&) {
    // its recording is incomplete: a caller interested in it would have ended it, and now wants a new robot
  }
}

void open_with(const hrt_config& config) {
  Holder& h = holder();
  std::shared_ptr<Robot> lost;
  std::shared_ptr<Cameras> lost_cameras;
  {
    const std::lock_guard lock(h.mutex);
    if (h.under_way != nullptr) {
      throw Error(HRT_E_BUSY, fmt::format("the robot is being {} by another thread", h.under_way));
    }
    if (h.robot && !h.robot->is_lost()) throw Error(HRT_E_BUSY, "the robot is already open");
    lost = std::move(h.robot);
    lost_cameras = std::move(h.cameras);
    h.under_way = "opened";
  }
  std::shared_ptr<Robot> robot;
  std::shared_ptr<Cameras> cameras;
  try {
    if (lost_cameras) lost_cameras->close();
    if (lost) close_lost(*lost);
    robot = std::make_shared<Robot>(kenaf::hrt::make_transport(), config);
    cameras = std::make_shared<Cameras>(config);
  } catch (...) {
    const std::lock_guard lock(h.mutex);
    h.under_way = nullptr;
    throw;
  }
  h.owner = getpid();
  static std::once_flag registered;
  std::call_once(registered, [] {
    // a child of fork() also ends by exit(): the robot belongs to its parent and continues
    std::atexit([] {
      if (holder().owner == getpid()) (void)hrt_close();
    });
  });
  const std::lock_guard lock(h.mutex);
  h.robot = std::move(robot);
  h.cameras = std::move(cameras);
  h.under_way = nullptr;
}

constexpr double kMaxDistance_mm = 1e6, kMaxAngle_deg = 36000, kMaxTrack_mmps = 2000, kMaxFlipper_deg = 360;
constexpr double kMaxWait_s = 3600, kMaxSleep_s = 86400;
constexpr double kMaxPictureWait_s = 60;
constexpr std::size_t kMaxCameraName = sizeof(hrt_picture::camera) - 1;
constexpr double kMinTolerance_deg = 0.1, kMaxTolerance_deg = 90;

}  // namespace

extern "C" {

int hrt_config_fill(hrt_config* config) {
  return guarded([&] {
    require(config != nullptr, "config is a null pointer");
    require(config->size >= kenaf::hrt::kFirstConfigSize && config->size <= sizeof(hrt_config),
            "config.size is wrong: begin with `hrt_config config = hrt_config_default();`");
    hrt_config full = kenaf::hrt::default_config();
    full.size = config->size;
    std::memcpy(config, &full, config->size);
  });
}

int hrt_config_load(hrt_config* config) {
  return guarded([&] {
    require(config != nullptr, "config is a null pointer");
    hrt_config whole = kenaf::hrt::whole_config(*config);
    kenaf::hrt::check_config(whole);
    kenaf::hrt::load_config(kenaf::settings::own_environment(), whole);
    whole.size = config->size;
    std::memcpy(config, &whole, config->size);
  });
}

int hrt_kenaf_init(void) {
  return guarded([] {
    hrt_config config = kenaf::hrt::default_config();
    kenaf::hrt::load_config(kenaf::settings::own_environment(), config);
    open_with(config);
  });
}

int hrt_kenaf_init_with(const hrt_config* config) {
  return guarded([&] {
    require(config != nullptr, "config is a null pointer");
    const hrt_config whole = kenaf::hrt::whole_config(*config);
    kenaf::hrt::check_config(whole);
    kenaf::hrt::check_together(whole, HRT_E_ARGUMENT);
    open_with(whole);
  });
}

int hrt_close(void) {
  return guarded([] {
    Holder& h = holder();
    std::shared_ptr<Robot> robot;
    std::shared_ptr<Cameras> cameras;
    {
      const std::lock_guard lock(h.mutex);
      if (!h.robot) return;
      robot = std::move(h.robot);
      cameras = std::move(h.cameras);
      h.under_way = "closed";
    }
    // first the robot, so that it stops
    const std::exception_ptr robot_failure = failure_of([&] { robot->close(); });
    const std::exception_ptr cameras_failure = failure_of([&] { cameras->close(); });
    {
      const std::lock_guard lock(h.mutex);
      h.under_way = nullptr;
    }
    throw_if(robot_failure);
    throw_if(cameras_failure);
  });
}

int hrt_go_forward(double mm) {
  return guarded([&] {
    require_range(mm, -kMaxDistance_mm, kMaxDistance_mm, "hrt_go_forward: mm");
    open_robot()->go_forward(mm / kMillimetres);
  });
}

int hrt_turning(double deg) {
  return guarded([&] {
    require_range(deg, -kMaxAngle_deg, kMaxAngle_deg, "hrt_turning: deg");
    open_robot()->turn(deg / kDegrees);
  });
}

int hrt_set_tracks(double left_mmps, double right_mmps) {
  return guarded([&] {
    require_range(left_mmps, -kMaxTrack_mmps, kMaxTrack_mmps, "hrt_set_tracks: left_mmps");
    require_range(right_mmps, -kMaxTrack_mmps, kMaxTrack_mmps, "hrt_set_tracks: right_mmps");
    open_robot()->set_tracks(left_mmps / kMillimetres, right_mmps / kMillimetres);
  });
}

int hrt_set_flipper(int flipper, double deg) {
  return guarded([&] {
    require(flipper >= HRT_FRONT_LEFT && flipper <= HRT_ALL_FLIPPERS,
            fmt::format("hrt_set_flipper: there is no flipper {}", flipper));
    require_range(deg, -kMaxFlipper_deg, kMaxFlipper_deg, "hrt_set_flipper: deg");
    const unsigned mask = flipper == HRT_ALL_FLIPPERS ? 0xfu : 1u << flipper;
    const double rad = deg / kDegrees;
    open_robot()->set_flippers(static_cast<std::uint8_t>(mask), {rad, rad, rad, rad});
  });
}

int hrt_set_flippers(double front_left_deg, double front_right_deg, double rear_left_deg, double rear_right_deg) {
  return guarded([&] {
    std::array<double, kenaf::robot::kFlipperCount> angles = {front_left_deg, front_right_deg, rear_left_deg,
                                                              rear_right_deg};
    for (double& angle : angles) {
      require_range(angle, -kMaxFlipper_deg, kMaxFlipper_deg, "hrt_set_flippers: an angle");
      angle /= kDegrees;
    }
    open_robot()->set_flippers(0xf, angles);
  });
}

int hrt_stop(void) {
  return guarded([] { open_robot()->stop(); });
}

int hrt_wait_flippers(double tolerance_deg, double timeout_s) {
  return guarded([&] {
    require_range(tolerance_deg, kMinTolerance_deg, kMaxTolerance_deg, "hrt_wait_flippers: tolerance_deg");
    require_range(timeout_s, 0, kMaxWait_s, "hrt_wait_flippers: timeout_s");
    open_robot()->wait_flippers(tolerance_deg / kDegrees, timeout_s);
  });
}

int hrt_sleep(double seconds) {
  return guarded([&] {
    require_range(seconds, 0, kMaxSleep_s, "hrt_sleep: seconds");
    const std::shared_ptr<Robot> robot = open_robot();
    if (seconds > 0) {
      robot->sleep(seconds);
    } else {
      robot->note_call();
    }
  });
}

double hrt_time(void) {
  double time_s = -1;
  // of a lost robot the time of the last state that arrived
  (void)guarded([&] { time_s = open_robot()->snapshot().measured.robot_time_s; });
  return time_s;
}

int hrt_get_state(hrt_state* state) {
  return guarded([&] {
    require_state(state);
    const Snapshot snapshot = open_robot()->snapshot();
    copy_state(snapshot, *state);
    throw_if_lost(snapshot);
  });
}

int hrt_wait_cycle(hrt_state* state) {
  return guarded([&] {
    if (state != nullptr) require_state(state);
    const std::shared_ptr<Robot> robot = open_robot();
    robot->wait_cycle();
    if (state == nullptr) return;
    const Snapshot snapshot = robot->snapshot();
    throw_if_lost(snapshot);
    copy_state(snapshot, *state);
  });
}

int hrt_get_warning(char* text, size_t size) {
  return guarded([&] {
    require(text != nullptr && size > 0, "hrt_get_warning: text is null or size is 0");
    text[0] = '\0';
    const Snapshot snapshot = open_robot()->snapshot();
    text[snapshot.warning.copy(text, size - 1)] = '\0';
    throw_if_lost(snapshot);
  });
}

int hrt_get_setup(char* text, size_t size) {
  return guarded([&] {
    require(text != nullptr && size > 0, "hrt_get_setup: text is null or size is 0");
    text[0] = '\0';
    const std::shared_ptr<Robot> robot = open_robot();
    text[robot->setup().copy(text, size - 1)] = '\0';
    throw_if_lost(robot->snapshot());
  });
}

int hrt_show_status(void) {
  return guarded([] {
    const Snapshot snapshot = open_robot()->snapshot();
    std::string text = kenaf::hrt::status_text(kenaf::hrt::state_from(snapshot), kenaf::hrt::kLibraryName);
    if (!snapshot.warning.empty()) text += "  warning   " + snapshot.warning + "\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    throw_if_lost(snapshot);
  });
}

int hrt_get_picture(const char* camera, int format, void* data, size_t capacity, double timeout_s,
                    hrt_picture* picture) {
  return guarded([&] {
    require(picture != nullptr, "hrt_get_picture: picture is a null pointer");
    require(picture->size >= kFirstPictureSize && picture->size <= sizeof(hrt_picture),
            "picture.size is wrong: begin with `hrt_picture picture = hrt_picture_init();`");
    const std::string name(camera == nullptr ? "" : camera);
    require(name.size() <= kMaxCameraName,
            fmt::format("hrt_get_picture: the camera's name is longer than {} bytes", kMaxCameraName));
    require(format == HRT_PICTURE_RGB || format == HRT_PICTURE_JPEG,
            fmt::format("hrt_get_picture: there is no format {}", format));
    require(data != nullptr || capacity == 0, "hrt_get_picture: data is a null pointer");
    require_range(timeout_s, 0, kMaxPictureWait_s, "hrt_get_picture: timeout_s");
    const Opened opened = open_all();
    // a program compiled with an older header has a shorter struct
    hrt_picture full = hrt_picture_init();
    std::memcpy(&full, picture, picture->size);
    const std::exception_ptr failure = failure_of([&] {
      kenaf::hrt::get_picture(*opened.robot, *opened.cameras, name, format,
                              {static_cast<std::uint8_t*>(data), capacity}, timeout_s, full);
    });
    full.size = picture->size;
    std::memcpy(picture, &full, picture->size);
    throw_if(failure);
  });
}

int hrt_record_start(const char* path) {
  return guarded([&] {
    require(path != nullptr && *path != '\0', "hrt_record_start: path is null or empty");
    open_robot()->record_start(path);
  });
}

int hrt_record_stop(void) {
  return guarded([] { open_robot()->record_stop(); });
}

const char* hrt_last_error(void) {
  return last_error;
}

const char* hrt_error_name(int error) {
  switch (error) {
    case HRT_OK:
      return "HRT_OK";
    case HRT_E_NOT_INITIALISED:
      return "HRT_E_NOT_INITIALISED";
    case HRT_E_BUSY:
      return "HRT_E_BUSY";
    case HRT_E_ARGUMENT:
      return "HRT_E_ARGUMENT";
    case HRT_E_CONFIG:
      return "HRT_E_CONFIG";
    case HRT_E_LINK:
      return "HRT_E_LINK";
    case HRT_E_REFUSED:
      return "HRT_E_REFUSED";
    case HRT_E_TIMEOUT:
      return "HRT_E_TIMEOUT";
    case HRT_E_STUCK:
      return "HRT_E_STUCK";
    case HRT_E_STOPPED:
      return "HRT_E_STOPPED";
    case HRT_E_CLOSED:
      return "HRT_E_CLOSED";
    case HRT_E_DEVICE:
      return "HRT_E_DEVICE";
    case HRT_E_RECORD:
      return "HRT_E_RECORD";
    case HRT_E_INTERNAL:
      return "HRT_E_INTERNAL";
    default:
      return "unknown error";
  }
}

const char* hrt_version(void) {
  return KENAF_VERSION;
}

const char* hrt_library(void) {
  return kenaf::hrt::kLibraryName;
}

}  // extern "C"
