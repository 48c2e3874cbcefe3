#include "gap/commands/interrupt.hpp"

#include <csignal>

namespace kenaf::gap::commands {
namespace {

std::atomic<bool> interrupted = false;  // global, as signal handlers need it

void interrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& interruption() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  if (std::signal(SIGHUP, interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // as nohup asked for
  return interrupted;
}

}  // namespace kenaf::gap::commands
