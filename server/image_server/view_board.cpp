#include "server/image_server/view_board.hpp"

#include <algorithm>

#include "server/image_server/view_name.hpp"

namespace kenaf::image_server {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kWanted = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(Feed::kWanted_s));

}  // namespace

ViewBoard::Time ViewBoard::View::last_wanted() const {
  return std::ranges::max(wanted).value_or(since);
}

ViewBoard::Look ViewBoard::look(std::string_view view, PictureSize size) {
  // Finds or creates the view, and notes that it is wanted now.
  Look out;
  const std::lock_guard lock(mutex_);
  auto found = views_.find(view);
  if (found == views_.end()) {
    if (views_.size() >= Feed::kMostViews && !make_room())
      return {{nullptr, "too many cameras are requested at the same time"}};
    found = views_.emplace(view, View{}).first;
    found->second.since = Clock::now();
  }
  View& entry = found->second;
  std::optional<Time>& wanted = entry.wanted[index_of(size)];
  const Time now = Clock::now();
  out.is_new = wanted < now - kWanted;
  wanted = now;

  // Its camera's newest frame, and why there is none or no newer one.
  out.seen.none = entry.none;
  if (!entry.camera) return out;
  if (const auto shown = shown_.find(*entry.camera); shown != shown_.end()) {
    out.seen.frame = shown->second.newest[index_of(size)];
    out.seen.none = shown->second.fault;
  }
  return out;
}

// Forgets the oldest view that shows no camera. Returns false if all show one.
bool ViewBoard::make_room() {
  auto oldest = views_.end();
  for (auto entry = views_.begin(); entry != views_.end(); ++entry) {
    if (entry->second.camera) continue;
    if (oldest == views_.end() || entry->second.last_wanted() < oldest->second.last_wanted()) oldest = entry;
  }
  if (oldest == views_.end()) return false;
  views_.erase(oldest);
  return true;
}

std::vector<FramePtr> ViewBoard::newest() const {
  std::vector<FramePtr> out;
  const std::lock_guard lock(mutex_);
  for (const auto& [id, shown] : shown_) {
    const auto& [full, half] = shown.newest;
    const FramePtr& newest = !full || (half && half->number > full->number) ? half : full;
    if (newest) out.push_back(newest);
  }
  return out;
}

ViewBoard::Settled ViewBoard::settle(const Exposure& exposure) {
  const auto& robots = exposure.world.robots;
  Settled out;
  const std::lock_guard lock(mutex_);
  const Time forgotten = Clock::now() - kWanted;
  std::erase_if(views_, [&](const auto& entry) { return entry.second.last_wanted() < forgotten; });
  for (auto& [name, view] : views_) {
    const auto camera = find_view(robots, name);
    // An exposure from before the request may lack a robot that has come since; the next one is on its way.
    if (!camera && exposure.wall < view.since) continue;
    std::string none = camera ? std::string() : no_such_view(robots, name);
    out.changed = out.changed || camera != view.camera || none != view.none;
    view.camera = camera;
    view.none = std::move(none);
    if (!camera) continue;
    BySize<bool>& sizes = out.wanted[*camera];
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = sizes[i] || view.wanted[i] >= forgotten;
  }

  std::erase_if(shown_, [&](const auto& entry) { return !out.wanted.contains(entry.first); });
  for (const auto& [id, sizes] : out.wanted) {
    Shown& of_camera = shown_[id];
    for (std::size_t i = 0; i < sizes.size(); ++i)
      if (!sizes[i]) of_camera.newest[i].reset();
  }
  return out;
}

bool ViewBoard::is_empty() const {
  const std::lock_guard lock(mutex_);
  return views_.empty();
}

bool ViewBoard::show(const FramePtr& frame) {
  const std::lock_guard lock(mutex_);
  const auto found = shown_.find(frame->id);
  if (found == shown_.end()) return false;
  FramePtr& newest = found->second.newest[index_of(frame->size)];
  if (!newest || newest->number < frame->number) newest = frame;
  return true;
}

void ViewBoard::stop(CameraId id, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (const auto found = shown_.find(id); found != shown_.end()) found->second.fault = "no picture: " + why;
}

}  // namespace kenaf::image_server
