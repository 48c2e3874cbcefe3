// Hand-over between the relay's threads: one thread puts, one takes at a time; neither waits for the other or takes a
// lock, and nothing allocates.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <system_error>
#include <utility>

#include "relayd/sockets.hpp"

namespace kenaf::relayd {

// Wakes the one thread that polls fd(). wake() may be called by any thread and by a signal handler.
class Waker {
 public:
  Waker() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd_.get() < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  int fd() const { return fd_.get(); }  // readable once woken

  void wake() {
    if (woken_.exchange(true)) return;  // whoever set it has written, and the thread has not looked since
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(fd_.get(), &one, sizeof one);
  }
  // Called by the woken thread before it checks its mail: anything put afterwards wakes it again.
  void clear() {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(fd_.get(), &count, sizeof count);
    woken_.exchange(false);
  }

 private:
  Descriptor fd_;
  std::atomic<bool> woken_{false};
};

// A bounded queue; `ring` is called after each item, on the thread that put it.
template <class T, std::size_t kCapacity>
class Mailbox {
 public:
  explicit Mailbox(std::function<void()> ring) : ring_(std::move(ring)) {}
  // Destroys items that were put but never taken: Boost 1.74's queue of fixed capacity does not.
  ~Mailbox() {
    queue_.consume_all([](T&) {});
  }
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  // Returns false, without taking `item`, if the queue is full.
  bool put(const T& item) {
    const bool taken = queue_.push(item);
    ring_();
    return taken;
  }
  // Calls f(T&) for each item present now, oldest first.
  template <class F>
  void take_all(F&& f) {
    for (std::size_t left = queue_.read_available(); left > 0; --left) queue_.consume_one(f);
  }

 private:
  std::function<void()> ring_;
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<kCapacity>> queue_;
};

}  // namespace kenaf::relayd
