// The order of messages out of blocks, and how many blocks are open for it.
#include "gap/recordings/time_order.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::gap::recordings;

namespace {

// A block of one byte for each message, which is its time.
OpenBlock block_of(const std::vector<std::int64_t>& times) {
  OpenBlock block;
  for (const std::int64_t t : times) {
    block.messages.push_back({t, 0, block.bytes.size(), 1});
    block.bytes += static_cast<char>(t);
  }
  return block;
}

struct Outcome {
  std::vector<std::int64_t> times;
  std::uint64_t out_of_order;
  std::size_t opened;
};

Outcome visit(const std::vector<std::vector<std::int64_t>>& blocks, std::uint64_t most_open, std::size_t most = 1000) {
  std::vector<BlockTimes> times;
  for (const auto& block : blocks) times.push_back({block.front(), block.back(), block.size()});
  Outcome outcome{{}, 0, 0};
  outcome.out_of_order = visit_in_time_order(
      times,
      [&](std::size_t i) {
        ++outcome.opened;
        return block_of(blocks[i]);
      },
      [&](const Message& message) {
        CHECK(message.bytes[0] == static_cast<char>(message.log_ns));
        outcome.times.push_back(message.log_ns);
        return outcome.times.size() < most;
      },
      {}, {most_open});
  return outcome;
}

}  // namespace

TEST_CASE("Blocks in any order in the file give messages in the order of time") {
  const Outcome outcome = visit({{7, 9}, {1, 8}, {2, 3}}, 100);
  CHECK(outcome.times == std::vector<std::int64_t>{1, 2, 3, 7, 8, 9});
  CHECK(outcome.out_of_order == 0);
}

TEST_CASE("Where too much overlaps, all messages come, some out of order, and they are counted") {
  // The blocks [1 10], [2], [3] overlap, and only one byte may be open beside the first block of two.
  const Outcome outcome = visit({{1, 10}, {2}, {3}}, 2);
  CHECK(outcome.times == std::vector<std::int64_t>{1, 10, 2, 3});
  CHECK(outcome.out_of_order == 2);
}

TEST_CASE("A visit ends when the callback says so, and opens no further block") {
  const Outcome outcome = visit({{1, 2}, {3, 4}, {5, 6}}, 100, 3);
  CHECK(outcome.times == std::vector<std::int64_t>{1, 2, 3});
  CHECK(outcome.opened == 2);
}
