#include "hrt/thread_watch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace kenaf::hrt {

std::optional<ThreadLook> read_thread_stat(std::string_view stat) {
  // "TID (name) S ...": the name may contain anything, even blanks and brackets, so the last bracket ends it.
  const std::size_t name_end = stat.rfind(") ");
  if (name_end == std::string_view::npos) return std::nullopt;
  stat.remove_prefix(name_end + 2);
  constexpr int kState = 3, kUserTicks = 14, kSystemTicks = 15;  // fields, counted from 1
  char state = 0;
  double ticks = 0;
  for (int field = kState; field <= kSystemTicks; ++field) {
    const std::string_view text = stat.substr(0, stat.find(' '));
    if (text.empty()) return std::nullopt;
    if (field == kState) state = text.front();
    if (field >= kUserTicks) {
      unsigned long count = 0;
      if (std::from_chars(text.data(), text.data() + text.size(), count).ec != std::errc{}) return std::nullopt;
      ticks += static_cast<double>(count);
    }
    stat.remove_prefix(std::min(text.size() + 1, stat.size()));
  }
  const bool waits_for_machine = state == 'R' || state == 'D';
  return ThreadLook{!waits_for_machine, ticks / static_cast<double>(sysconf(_SC_CLK_TCK))};
}

std::optional<ThreadLook> look_at_thread(pid_t thread) {
  std::array<char, 64> path{};  // in a cycle, so without allocating
  fmt::format_to_n(path.data(), path.size() - 1, "/proc/self/task/{}/stat", thread);
  const int file = open(path.data(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  std::array<char, 1024> text;
  const ssize_t size = read(file, text.data(), text.size());
  close(file);
  if (size <= 0) return std::nullopt;
  return read_thread_stat({text.data(), static_cast<std::size_t>(size)});
}

void ThreadWatch::look(const std::optional<ThreadLook>& look, double wall_s) {
  const double cpu_s = look ? look->cpu_s : cpu_s_;
  if (wall_s_) {
    const bool asleep = !look || look->asleep;
    spent_s_ += std::max(cpu_s - cpu_s_, asleep ? std::min(wall_s - *wall_s_, kLongestLook_s) : 0);
  }
  wall_s_ = wall_s;
  cpu_s_ = cpu_s;
}

}  // namespace kenaf::hrt
