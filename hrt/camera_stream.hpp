// The newest picture of each open camera, and the threads that fetch pictures while they are requested.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "hrt/camera.hpp"
#include "hrt/error.hpp"
#include "kenaf/hrt.h"

namespace kenaf::hrt {

// One camera, from its opening to its first failure. Thread safety: every function may be called from any thread.
class CameraStream {
 public:
  using Clock = std::chrono::steady_clock;
  // Pictures are fetched until this long after the last wait().
  static constexpr std::chrono::seconds kIdleAfter{2};

  explicit CameraStream(std::unique_ptr<Camera> camera);
  ~CameraStream();  // closes
  CameraStream(const CameraStream&) = delete;
  CameraStream& operator=(const CameraStream&) = delete;

  // Returns the newest picture whose number is not `had` (0: any), waiting until `until`; null if there was none.
  // Throws the Error that ended the stream, also if it occurred between two calls.
  std::shared_ptr<const CameraPicture> wait(std::uint64_t had, Clock::time_point until);

  // Every wait() throws Error(HRT_E_CLOSED) from now on.
  void close();

 private:
  void run();
  void fetch();
  bool wait_until_wanted();  // false: closed

  std::unique_ptr<Camera> camera_;
  std::mutex mutex_;  // guards all members below
  std::condition_variable changed_, wanted_;
  std::shared_ptr<const CameraPicture> newest_;
  std::optional<Failure> failure_;  // set once
  bool closing_ = false;
  Clock::time_point wanted_until_;
  std::mutex close_mutex_;  // one close at a time
  std::thread thread_;
};

// All cameras of an open robot, by name. Thread safety: every function may be called from any thread.
class Cameras {
 public:
  explicit Cameras(const hrt_config& config) : config_(config) {}

  // Returns the stream of a camera and opens it if necessary. Throws Error if there is no such camera, or if closed.
  std::shared_ptr<CameraStream> stream(const std::string& name);
  // The stream has failed: the next stream() of this camera opens it anew.
  void drop(const std::shared_ptr<CameraStream>& stream);
  void close();

 private:
  const hrt_config config_;
  std::mutex mutex_;
  bool closed_ = false;
  std::map<std::string, std::shared_ptr<CameraStream>> streams_;  // by resolved name
  std::map<std::string, std::string> resolved_;  // resolved names of those in streams_, by requested name
};

}  // namespace kenaf::hrt
