// Refuses a process in which the functions of hrt.h are those of the other library.
//
// Both libraries have the same functions. In a process with both of them the loader binds every call to the one that
// comes first, even the calls of a program that opened the second one by dlopen(): the robot would drive in place of
// its simulation. No linker reports that, so each library asks, when it is loaded, whose function a program would call.
// Two libraries that are loaded apart (dlopen() with RTLD_LOCAL, modules of Python) do not see each other, and may be.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>

#include "hrt/transport.hpp"

namespace kenaf::hrt {
namespace {

constexpr int kRefused = 127;  // as of a program that the loader cannot start

const char* file_of(const void* address) {
  Dl_info found{};
  return dladdr(address, &found) != 0 && found.dli_fname ? found.dli_fname : "a library";
}

[[gnu::constructor]] void refuse_other_library() {
  // Null in a program that has the code of the library without being linked with it, as its tests.
  void* const called = dlsym(RTLD_DEFAULT, "hrt_library");
  if (!called) return;
  const char* const other = reinterpret_cast<const char* (*)()>(called)();
  if (std::strcmp(other, kLibraryName) == 0) return;
  std::fprintf(stderr,
               "kenaf: this program has loaded libkenaf_%s (%s) and libkenaf_%s (%s). They have the same functions, so "
               "all calls would go to the first: link the program with one of them, libkenaf_sim for the simulation or "
               "libkenaf_real for the robot.\n",
               other, file_of(called), kLibraryName, file_of(&kRefused));
  // Not exit(): the program's own code, which may not have begun, must not run.
  _exit(kRefused);
}

}  // namespace
}  // namespace kenaf::hrt
