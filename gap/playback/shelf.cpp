#include "gap/playback/shelf.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace kenaf::gap::playback {

Shelf::Shelf(std::size_t most_bytes, std::function<std::string(std::size_t)> make)
    : most_bytes_(most_bytes), make_(std::move(make)), thread_([this] { work(); }) {}

Shelf::~Shelf() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Shelf::Look Shelf::look(std::size_t number) {
  const std::lock_guard lock(mutex_);
  if (const auto found = texts_.find(number); found != texts_.end()) {
    kept_.remove(number);
    kept_.push_front(number);
    return {found->second, {}};
  }
  if (auto failed = failures_.extract(number)) return {nullptr, std::move(failed.mapped())};
  wanted_.remove(number);
  wanted_.push_front(number);
  changed_.notify_all();
  return {};
}

void Shelf::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    // The newest request. look() queues only what has no text, and a number leaves the queue as it gets one.
    changed_.wait(lock, [this] { return ending_ || !wanted_.empty(); });
    if (ending_) return;
    const std::size_t number = wanted_.front();

    // Makes the text without the lock, so that look() never waits.
    lock.unlock();
    std::shared_ptr<const std::string> text;
    std::string failure;
    try {
      text = std::make_shared<const std::string>(make_(number));
    } catch (const std::exception& error) {
      failure = error.what();
    }

    lock.lock();
    wanted_.remove(number);
    if (!text) {
      failures_[number] = failure;
      continue;
    }

    // Keeps it, and drops the least recently requested ones beyond the limit, but never this one.
    bytes_ += text->size();
    texts_[number] = std::move(text);
    kept_.push_front(number);
    while (bytes_ > most_bytes_ && kept_.size() > 1) {
      bytes_ -= texts_.at(kept_.back())->size();
      texts_.erase(kept_.back());
      kept_.pop_back();
    }
  }
}

}  // namespace kenaf::gap::playback
