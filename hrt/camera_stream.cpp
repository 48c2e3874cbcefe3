#include "hrt/camera_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hrt/error.hpp"
#include "hrt/quiet_thread.hpp"

namespace kenaf::hrt {

CameraStream::CameraStream(std::unique_ptr<Camera> camera)
    : camera_(std::move(camera)), wanted_until_(Clock::now() + kIdleAfter) {
  thread_ = start_quiet_thread([this] { run(); });
}

CameraStream::~CameraStream() {
  close();
}

std::shared_ptr<const CameraPicture> CameraStream::wait(std::uint64_t had, Clock::time_point until) {
  std::unique_lock lock(mutex_);
  const auto is_there = [&] { return newest_ && (had == 0 || newest_->number != had); };
  const Clock::time_point now = Clock::now();
  // a picture from before the pause is no longer the newest
  if (now > wanted_until_) newest_.reset();
  wanted_until_ = std::max(now, until) + kIdleAfter;
  wanted_.notify_one();
  changed_.wait_until(lock, until, [&] { return failure_ || is_there(); });
  if (failure_) throw failure_->error();
  wanted_until_ = std::max(wanted_until_, Clock::now() + kIdleAfter);
  return is_there() ? newest_ : nullptr;
}

void CameraStream::close() {
  const std::lock_guard one(close_mutex_);
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    if (!failure_) failure_ = Failure{HRT_E_CLOSED, "hrt_close() was called"};
  }
  changed_.notify_all();
  wanted_.notify_one();
  if (!thread_.joinable()) return;
  camera_->interrupt();
  thread_.join();
}

void CameraStream::run() {
  std::optional<Failure> failure;
  try {
    fetch();
  } catch (const Error& error) {
    failure = Failure{error.code(), error.what()};
  } catch (const std::exception& error) {
    failure = Failure{HRT_E_INTERNAL, fmt::format("the library's camera thread failed: {}", error.what())};
  }
  const std::lock_guard lock(mutex_);
  if (failure && !failure_) failure_ = std::move(failure);
  changed_.notify_all();
}

void CameraStream::fetch() {
  camera_->open();
  while (wait_until_wanted()) {
    std::optional<CameraPicture> picture = camera_->next();
    if (!picture) return;
    auto shared = std::make_shared<const CameraPicture>(*std::move(picture));
    const std::lock_guard lock(mutex_);
    newest_ = std::move(shared);
    changed_.notify_all();
  }
}

bool CameraStream::wait_until_wanted() {
  std::unique_lock lock(mutex_);
  const auto is_wanted = [&] { return closing_ || Clock::now() <= wanted_until_; };
  if (!is_wanted()) {
    newest_.reset();
    lock.unlock();
    camera_->pause();
    lock.lock();
    wanted_.wait(lock, is_wanted);
  }
  return !closing_;
}

std::shared_ptr<CameraStream> Cameras::stream(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (closed_) throw Error(HRT_E_CLOSED, "hrt_close() was called");
  const auto resolved = resolved_.find(name);
  const std::string camera = resolved != resolved_.end() ? resolved->second : resolve_camera(config_, name);
  auto entry = streams_.find(camera);
  if (entry == streams_.end()) {
    entry = streams_.emplace(camera, std::make_shared<CameraStream>(make_camera(config_, camera))).first;
  }
  resolved_.emplace(name, camera);
  return entry->second;
}

void Cameras::drop(const std::shared_ptr<CameraStream>& stream) {
  std::shared_ptr<CameraStream> last;  // if this is the last owner, its thread ends after the lock is released
  const std::lock_guard lock(mutex_);
  for (auto entry = streams_.begin(); entry != streams_.end(); ++entry) {
    if (entry->second != stream) continue;
    std::erase_if(resolved_, [&](const auto& name) { return name.second == entry->first; });
    last = std::move(entry->second);
    streams_.erase(entry);
    return;
  }
}

void Cameras::close() {
  std::map<std::string, std::shared_ptr<CameraStream>> streams;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    streams = std::move(streams_);
    streams_.clear();
  }
  for (const auto& [name, stream] : streams) stream->close();
}

}  // namespace kenaf::hrt
