#include "gap/challenge/confinement.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

#ifndef LANDLOCK_ACCESS_FS_TRUNCATE  // Linux 6.2
#define LANDLOCK_ACCESS_FS_TRUNCATE (1ULL << 14)
#endif

namespace kenaf::gap::challenge {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_EXECUTE;
constexpr std::uint64_t kRead = kReadFile | LANDLOCK_ACCESS_FS_READ_DIR;

long version() {
  return ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
}

// All accesses that this version can forbid. docs.kernel.org/userspace-api/landlock.html
std::uint64_t all_access() {
  std::uint64_t access = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
  if (version() >= 2) access |= LANDLOCK_ACCESS_FS_REFER;
  if (version() >= 3) access |= LANDLOCK_ACCESS_FS_TRUNCATE;
  return access;
}

}  // namespace

bool can_confine() {
  return version() >= 1;
}

Confinement::Confinement(const std::vector<fs::path>& read, const std::vector<fs::path>& write) {
  if (!can_confine()) return;
  const std::uint64_t all = all_access();
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = all;
  ruleset_ = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0));
  if (ruleset_ < 0) return;
  // Everything is forbidden but these rules. A rule for a single file may not have the accesses of folders.
  const auto allow = [&](const fs::path& path, std::uint64_t access) {
    landlock_path_beneath_attr rule{};
    rule.parent_fd = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    if (rule.parent_fd < 0) return;
    std::error_code ignored;
    rule.allowed_access =
        fs::is_directory(path, ignored) ? access : access & (kReadFile | LANDLOCK_ACCESS_FS_WRITE_FILE);
    ::syscall(SYS_landlock_add_rule, ruleset_, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    ::close(rule.parent_fd);
  };
  for (const fs::path& path : read) allow(path, kRead);
  for (const fs::path& path : write) allow(path, all);
}

Confinement::~Confinement() {
  if (ruleset_ >= 0) ::close(ruleset_);
}

bool Confinement::enter() const {
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::syscall(SYS_landlock_restrict_self, ruleset_, 0) == 0;
}

}  // namespace kenaf::gap::challenge
