#include "physics/dynamics/bullet_memory.hpp"

#include <LinearMath/btAlignedAllocator.h>

#include <cstdlib>
#include <new>

namespace kenaf::physics {
namespace {

void* allocate_or_throw(std::size_t bytes) {
  void* memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void have_bullet_throw() {
  // Its own functions are malloc and free too, so memory of before is freed rightly.
  [[maybe_unused]] static const bool set = [] {
    btAlignedAllocSetCustom(allocate_or_throw, std::free);
    return true;
  }();
}

}  // namespace kenaf::physics
