#include "tests/support/heap_calls.hpp"

#include <cerrno>
#include <cstddef>

namespace {

thread_local long calls = 0;
thread_local long failing = 0;  // the number in `calls` of the call that fails

// Counts a call; true: it is to fail.
bool fails() {
  return ++calls == failing;
}

}  // namespace

// The C library's own; __libc_ names are glibc's for whoever puts a function before them.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

[[gnu::visibility("default")]] void* malloc(std::size_t size) {
  if (fails()) return nullptr;
  return __libc_malloc(size);
}
[[gnu::visibility("default")]] void* calloc(std::size_t count, std::size_t size) {
  if (fails()) return nullptr;
  return __libc_calloc(count, size);
}
[[gnu::visibility("default")]] void* realloc(void* memory, std::size_t size) {
  if (fails()) return nullptr;
  return __libc_realloc(memory, size);
}
[[gnu::visibility("default")]] void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (fails()) return nullptr;
  return __libc_memalign(alignment, size);
}
[[gnu::visibility("default")]] int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  if (fails()) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}

namespace kenaf::test {

long heap_calls() {
  return calls;
}

void fail_heap_call(long n) {
  failing = n > 0 ? calls + n : 0;
}

bool heap_call_failed() {
  return failing != 0 && calls >= failing;
}

}  // namespace kenaf::test
