#include "python/hrt_interrupt.hpp"

#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace kenaf::python {
namespace {

constexpr double kPart_s = 0.1;       // of a sleep, robot time
constexpr double kLongest_s = 86400;  // of hrt_sleep
constexpr double kSameTime_s = 1e-9;  // cycles are multiples of no binary fraction

// A signal handler reaches nothing but globals, and may not stop the robot itself: a thread does it. That thread lives
// as long as the process, which a child after fork() is not.
struct sigaction python_handler {};
sem_t interrupts;
std::atomic<bool> blocks = false;   // the main thread is in a blocking call
std::atomic<bool> stopped = false;  // by an interrupt, in this call
std::atomic<pid_t> watched_by = 0;

void on_interrupt(int signal, siginfo_t* info, void* context) {
  sem_post(&interrupts);
  if ((python_handler.sa_flags & SA_SIGINFO) != 0)
    python_handler.sa_sigaction(signal, info, context);
  else
    python_handler.sa_handler(signal);
}

void stop_at_interrupts() {
  for (;;) {
    if (sem_wait(&interrupts) != 0 || !blocks) continue;
    (void)(stopped ? hrt_close() : hrt_stop());
    stopped = true;
  }
}

void watch() {
  if (watched_by == ::getpid()) return;
  sem_init(&interrupts, 0, 0);
  std::thread(stop_at_interrupts).detach();
  watched_by = ::getpid();
}

bool has_handler(const struct sigaction& action) {
  return (action.sa_flags & SA_SIGINFO) != 0 || (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN);
}

bool is_main_thread() {
  return ::gettid() == ::getpid();
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
  if (!is_main_thread() || sigaction(SIGINT, nullptr, &python_handler) != 0 || !has_handler(python_handler)) return;
  watch();
  active_ = true;
  stopped = false;
  blocks = true;
  struct sigaction ours {};
  ours.sa_sigaction = on_interrupt;
  ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGINT, &ours, nullptr);
}

StopOnInterrupt::~StopOnInterrupt() {
  if (!active_) return;
  sigaction(SIGINT, &python_handler, nullptr);
  blocks = false;
}

void handle_signals() {
  if (PyErr_CheckSignals() == 0) return;
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) != 0) hrt_stop();
  throw pybind11::error_already_set();
}

void sleep_interruptibly(double seconds) {
  if (!(seconds > kPart_s && seconds <= kLongest_s)) {
    call_blocking(hrt_sleep, seconds);
    return;
  }
  const double end_s = hrt_time() + seconds;
  double left_s = seconds;
  while (left_s > kSameTime_s) {
    call_blocking(hrt_sleep, std::min(left_s, kPart_s));
    left_s = end_s - hrt_time();
  }
}

}  // namespace kenaf::python
