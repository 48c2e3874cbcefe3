#include "gap/challenge/diagnose_cases.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "formats/description/data_files.hpp"
#include "gap/challenge/confinement.hpp"

namespace kenaf::gap::challenge {
namespace {

namespace fs = std::filesystem;

constexpr int kCannotStart = 126;  // as shells use it

std::runtime_error failed(const std::string& what) {
  return std::runtime_error(fmt::format("{}: {}", what, std::generic_category().message(errno)));
}

// A file descriptor that closes itself.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

std::vector<fs::path> readable(const fs::path& data) {
  std::vector<fs::path> paths{data, "/proc/self/exe", "/usr", "/lib", "/lib64", "/dev/null", "/etc/ld.so.cache"};
  for (const fs::path& root : description::data_roots())
    for (const char* folder : {"robots", "worlds", "manoeuvres"}) paths.push_back(root / folder);
  return paths;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

pid_t start(const CaseToDiagnose& one, int program) {
  fs::create_directories(one.report);
  const fs::path log = one.report / "diagnose.log";
  const Descriptor out{::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  const Descriptor in{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
  if (out.value < 0 || in.value < 0) throw failed(log.string());

  // All that the child needs is allocated before fork().
  std::vector<std::string> arguments{"kenaf-gap",         "diagnose",  one.data.string(), "--out",
                                     one.report.string(), "--no-next", "--jobs",          "1"};
  if (!one.without.empty()) {
    arguments.emplace_back("--without");
    arguments.push_back(fmt::format("{}", fmt::join(one.without, ",")));
  }
  if (!one.against.empty()) {
    arguments.emplace_back("--against");
    arguments.push_back(one.against.string());
  }
  std::vector<std::string> environment;
  for (const char* name : {"KENAF_DATA_DIR", "PATH", "HOME"})
    if (const char* value = std::getenv(name)) environment.push_back(fmt::format("{}={}", name, value));
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  const Confinement confinement(readable(one.data), {one.report});
  if (can_confine() && !confinement.confines()) throw failed("the diagnosis cannot be confined to its case");

  const pid_t process = ::fork();
  if (process < 0) throw failed("cannot start a process");
  if (process > 0) return process;
  ::setpgid(0, 0);  // a terminal's interrupt reaches only this program, which ends the others
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(in.value, STDIN_FILENO);
  ::dup2(out.value, STDOUT_FILENO);
  ::dup2(out.value, STDERR_FILENO);
  if (!confinement.confines() || confinement.enter()) ::fexecve(program, argv.data(), envp.data());
  ::dprintf(STDERR_FILENO, "cannot start the diagnosis: %s\n", std::strerror(errno));
  ::_exit(kCannotStart);
}

}  // namespace

void diagnose_cases(const std::vector<CaseToDiagnose>& cases, unsigned at_once, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t, bool)>& ended) {
  // Held open, so that the same program diagnoses all cases even if another one is installed meanwhile.
  const Descriptor program{::open("/proc/self/exe", O_PATH | O_CLOEXEC)};
  if (program.value < 0) throw failed("/proc/self/exe");
  std::signal(SIGCHLD, SIG_DFL);  // if it was inherited as ignored, no child could be waited for
  if (at_once == 0) at_once = std::max(1U, std::thread::hardware_concurrency());
  std::map<pid_t, std::size_t> running;
  const auto end_all = [&] {
    for (const auto& [process, index] : running) ::kill(process, SIGKILL);
    for (const auto& [process, index] : running) ::waitpid(process, nullptr, 0);
    running.clear();
  };
  try {
    for (std::size_t next = 0; !stop && (next < cases.size() || !running.empty());) {
      if (next < cases.size() && running.size() < at_once) {
        running.emplace(start(cases[next], program.value), next);
        ++next;
        continue;
      }
      int status = 0;
      const pid_t process = ::waitpid(-1, &status, WNOHANG);
      if (const auto found = running.find(process); found != running.end()) {
        const std::size_t index = found->second;
        running.erase(found);
        ended(index, WIFEXITED(status) && WEXITSTATUS(status) == 0);
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    }
  } catch (...) {
    end_all();
    throw;
  }
  end_all();
}

}  // namespace kenaf::gap::challenge
