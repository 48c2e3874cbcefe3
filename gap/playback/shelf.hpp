// Texts that take long to make, made one at a time on a thread of their own when somebody asks, and kept for a while.
//
// Thread safety: all of it.
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
  // `make` is called on the shelf's thread; what it throws is told to who asked. Of what was made, the longest unasked
  // for is dropped beyond `most_bytes`.
  Shelf(std::size_t most_bytes, std::function<std::string(std::size_t)> make);
  // Waits for what is being made.
  ~Shelf();
  Shelf(const Shelf&) = delete;
  Shelf& operator=(const Shelf&) = delete;

  struct Look {
    std::shared_ptr<const std::string> text;  // null: it is being made, or next, or could not be
    std::string failure;                      // why it could not; told once, then it is tried again
  };
  // Returns at once. Whatever was asked for last is made next.
  Look look(std::size_t number);

 private:
  void work();

  const std::size_t most_bytes_;
  const std::function<std::string(std::size_t)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;
  std::list<std::size_t> wanted_;  // next first
  std::list<std::size_t> kept_;    // last asked for first
  std::map<std::size_t, std::shared_ptr<const std::string>> texts_;
  std::map<std::size_t, std::string> failures_;
  std::size_t bytes_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace kenaf::gap::playback
