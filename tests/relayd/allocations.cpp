#include "tests/relayd/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace kenaf::test {

namespace {
std::atomic<std::uint64_t> count{0};
thread_local bool this_thread_counts = true;
}  // namespace

void leave_this_thread_out() {
  this_thread_counts = false;
}
std::uint64_t allocations() {
  return count;
}

void* counted(std::size_t size) noexcept {
  if (this_thread_counts) ++count;
  return std::malloc(size == 0 ? 1 : size);
}

void* counted_or_throw(std::size_t size) {
  void* memory = counted(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace kenaf::test

void* operator new(std::size_t size) {
  return kenaf::test::counted_or_throw(size);
}
void* operator new[](std::size_t size) {
  return kenaf::test::counted_or_throw(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return kenaf::test::counted(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
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
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
