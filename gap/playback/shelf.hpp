// Makes texts that take long, one at a time on a thread of its own when somebody asks, and caches them.
//
// Thread safety: all functions.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace kenaf::gap::playback {

class Shelf {
 public:
  // Calls `make` on the shelf's thread; look() returns what it throws. Beyond `most_bytes`, drops the text that was not
  // requested for the longest time.
  Shelf(std::size_t most_bytes, std::function<std::string(std::size_t)> make);
  // Waits for the text in work.
  ~Shelf();
  Shelf(const Shelf&) = delete;
  Shelf& operator=(const Shelf&) = delete;

  struct Look {
    std::shared_ptr<const std::string> text;  // null: in work, queued, or failed
    std::string failure;                      // why it failed; returned once, then it is tried again
  };
  // Returns at once. The text requested last is made next.
  Look look(std::size_t number);

 private:
  void work();

  const std::size_t most_bytes_;
  const std::function<std::string(std::size_t)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;
  std::list<std::size_t> wanted_;  // next first
  std::list<std::size_t> kept_;    // last requested first
  std::map<std::size_t, std::shared_ptr<const std::string>> texts_;
  std::map<std::size_t, std::string> failures_;
  std::size_t bytes_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace kenaf::gap::playback
