#include "gap/recordings/time_order.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>

namespace kenaf::gap::recordings {
namespace {

// A block whose messages are being visited.
struct Reading {
  OpenBlock block;
  std::uint64_t size;
  std::size_t next = 0;
};

// The next message of an open block; the earliest is on top, of equal ones that of the earlier block.
struct Next {
  std::int64_t log_ns;
  std::size_t rank;  // of the block by its first time
  std::size_t reading;
  bool operator<(const Next& other) const { return log_ns != other.log_ns ? log_ns > other.log_ns : rank > other.rank; }
};

std::vector<std::size_t> by_first_time(std::span<const BlockTimes> blocks) {
  std::vector<std::size_t> order(blocks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [blocks](std::size_t block) { return blocks[block].first_ns; });
  return order;
}

class Visit {
 public:
  Visit(std::span<const BlockTimes> blocks, const OpenBlockAt& open, const VisitOptions& options)
      : blocks_(blocks), open_(open), options_(options), order_(by_first_time(blocks)) {}

  std::uint64_t run(const TakeMessage& take, const TellProgress& tell) {
    std::uint64_t out_of_order = 0;
    std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
    for (open_what_overlaps(tell); !next_.empty(); open_what_overlaps(tell)) {
      const Next earliest = next_.top();
      next_.pop();
      Reading& reading = readings_[earliest.reading];
      const MessagePlace& place = reading.block.messages[reading.next++];
      if (place.log_ns < last_ns) ++out_of_order;
      last_ns = std::max(last_ns, place.log_ns);
      const std::string_view bytes = reading.block.bytes;
      if (!take({place.topic, place.log_ns, bytes.substr(place.offset, place.size)})) break;
      continue_with(earliest);
    }
    return out_of_order;
  }

 private:
  // Opens the blocks that begin before the earliest open message, as memory allows.
  void open_what_overlaps(const TellProgress& tell) {
    while (opened_ < order_.size()) {
      const std::size_t index = order_[opened_];
      const BlockTimes& block = blocks_[index];
      const bool overlaps = next_.empty() || block.first_ns <= next_.top().log_ns;
      if (!overlaps || (!next_.empty() && open_bytes_ + block.size > options_.most_open)) return;
      add(index, opened_++);
      if (tell) tell(static_cast<double>(opened_) / static_cast<double>(order_.size()));
    }
  }

  void add(std::size_t index, std::size_t rank) {
    Reading reading{open_(index), blocks_[index].size};
    if (reading.block.messages.empty()) return;
    std::ranges::stable_sort(reading.block.messages, {}, &MessagePlace::log_ns);
    const auto unused = std::ranges::find_if(readings_, [](const Reading& old) { return old.block.messages.empty(); });
    const auto place = static_cast<std::size_t>(unused - readings_.begin());
    if (unused == readings_.end()) readings_.emplace_back();
    open_bytes_ += reading.size;
    next_.push({reading.block.messages.front().log_ns, rank, place});
    readings_[place] = std::move(reading);
  }

  void continue_with(const Next& visited) {
    Reading& reading = readings_[visited.reading];
    if (reading.next < reading.block.messages.size()) {
      next_.push({reading.block.messages[reading.next].log_ns, visited.rank, visited.reading});
      return;
    }
    open_bytes_ -= reading.size;
    reading = {};
  }

  std::span<const BlockTimes> blocks_;
  const OpenBlockAt& open_;
  VisitOptions options_;
  std::vector<std::size_t> order_;
  std::size_t opened_ = 0;  // the first so many of order_
  std::uint64_t open_bytes_ = 0;
  std::vector<Reading> readings_;  // closed ones are empty, and used again
  std::priority_queue<Next> next_;
};

}  // namespace

std::uint64_t visit_in_time_order(std::span<const BlockTimes> blocks, const OpenBlockAt& open, const TakeMessage& take,
                                  const TellProgress& tell, const VisitOptions& options) {
  return Visit(blocks, open, options).run(take, tell);
}

}  // namespace kenaf::gap::recordings
