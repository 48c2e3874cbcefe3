// Child processes for tests and benchmarks: started, watched, signalled, and never left behind.
//
// Thread safety: a Process belongs to one thread.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kenaf::support {

class Process {
 public:
  // Starts argv[0] (a path) with this process's environment and `environment` over it; output and errors go to `log`.
  // Throws std::system_error.
  Process(std::vector<std::string> argv, const std::filesystem::path& log,
          const std::map<std::string, std::string>& environment = {});
  ~Process();  // SIGKILL where it still runs
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  // Returns the exit status, or minus the signal that ended it; nullopt while it runs.
  std::optional<int> status();
  // The same of a process that is about to end; nullopt: it still runs after patience().
  std::optional<int> wait();

  double cpu_s() const;                  // user and system time so far
  std::uint64_t resident_bytes() const;  // now

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

// The port that a server writes into `file` once it listens. Throws std::runtime_error when the server ends first or
// patience() does.
std::uint16_t wait_for_port(const std::filesystem::path& file, Process& server);

// A fresh empty folder below the system's temporary folder, removed with its contents at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kenaf::support
