// A thread that takes none of the process's signals: they belong to the user's program. Signals raised by a fault of
// the thread itself stay enabled.
#pragma once

#include <csignal>
#include <thread>
#include <utility>

namespace kenaf::hrt {

template <typename Body>
std::thread start_quiet_thread(Body&& body) {
  // A thread inherits its creator's mask, so there is no moment at which a signal could interrupt it.
  sigset_t all, before;
  sigfillset(&all);
  for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT}) sigdelset(&all, fault);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread thread(std::forward<Body>(body));
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
}

}  // namespace kenaf::hrt
