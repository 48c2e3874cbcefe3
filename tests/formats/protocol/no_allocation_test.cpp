// Nothing allocates on the steady path: this program counts every operator new.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "tests/formats/protocol/encoded.hpp"
#include "tests/support/robot_command.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}

// None is inlined: g++ would see free() called on what operator new gave, and warn of a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// A sanitizer brings its own of each form that is not replaced here; ours would then free what it allocated.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace {

template <class Work>
std::size_t allocations_in(Work work) {
  for (int i = 0; i < 10; ++i) work();  // buffers reach their size
  const std::size_t before = allocations;
  for (int i = 0; i < 1000; ++i) work();
  return allocations - before;
}

}  // namespace

TEST_CASE("The counter counts") {
  CHECK(allocations_in([] { std::vector<int> v(static_cast<std::size_t>(std::rand() % 7 + 1000)); }) == 1000);
}

TEST_CASE("Encoding and decoding a datagram allocates nothing") {
  using namespace kenaf::protocol::relay;
  std::array<std::byte, kMaxDatagramBytes> bytes;
  Datagram out = Bye{1};
  CHECK(allocations_in([&] {
          for (const Datagram& d : {Datagram{kenaf::protocol::relay::empty_state()},
                                    Datagram{Command{1, 1, 1, kenaf::support::command_of({})}}}) {
            if (decode(std::span(bytes).first(encode(d, bytes)), out) != kenaf::protocol::DecodeError::none)
              std::abort();
          }
        }) == 0);
}

TEST_CASE("Splitting, parsing and writing lines allocates nothing") {
  using namespace kenaf::protocol::usarsim;
  LineSplitter splitter;
  MessageView view;
  std::string out;
  std::array<double, 3> numbers{};
  CHECK(allocations_in([&] {
          splitter.push("SEN {Time 3104.5749} {Type GroundTruth} {Location 4.50,1.90,1.85}\r\nSEN {Ty");
          splitter.push("pe Encoder} {Name ECLeft Tick 0}\r\n");
          while (const auto line = splitter.next()) {
            if (parse_message(*line, view) != ParseError::none) std::abort();
            if (const auto place = view.find("Location"); place && !parse_numbers(*place, numbers)) std::abort();
          }
          out.clear();
          MessageWriter(out)
              .begin("DRIVE")
              .number("Left", 1.2345, {17, false})
              .numbers("Location", numbers, {4, true})
              .boolean("Normalized", false)
              .end();
        }) == 0);
}
