// Messages in the order of their log times out of blocks (chunks of a file) that overlap in time.
//
// Thread safety: one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gap/recordings/recording.hpp"

namespace kenaf::gap::recordings {

// The most bytes of blocks that are open together, chosen. One block may be larger (kLargestBlock).
inline constexpr std::uint64_t kMostOpen = std::uint64_t{1} << 27;

struct BlockTimes {
  std::int64_t first_ns, last_ns;  // log times of its messages, as the file says
  std::uint64_t size;              // in memory
};

struct MessagePlace {
  std::int64_t log_ns;
  std::size_t topic;
  std::size_t offset, size;  // in OpenBlock::bytes
};

struct OpenBlock {
  std::string bytes;
  std::vector<MessagePlace> messages;
};

// Opens the block of an index. One that cannot be read it returns empty.
using OpenBlockAt = std::function<OpenBlock(std::size_t)>;

struct VisitOptions {
  std::uint64_t most_open = kMostOpen;
};

// Visits the messages of all blocks. As many blocks are open as overlap at a time, but never more than `most_open`
// bytes beside the first: where a file would need more, messages come out of order. Returns how many did.
std::uint64_t visit_in_time_order(std::span<const BlockTimes> blocks, const OpenBlockAt& open, const TakeMessage& take,
                                  const TellProgress& tell, const VisitOptions& options = {});

}  // namespace kenaf::gap::recordings
