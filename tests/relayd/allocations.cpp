#include "tests/relayd/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace kenaf::test {

namespace {
std::atomic<std::uint64_t> count{0};
}

thread_local bool allocations_of_this_thread_count = true;
std::uint64_t allocations() {
  return count;
}

void* counted(std::size_t size) {
  if (allocations_of_this_thread_count) ++count;
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace kenaf::test

void* operator new(std::size_t size) {
  return kenaf::test::counted(size);
}
void* operator new[](std::size_t size) {
  return kenaf::test::counted(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
