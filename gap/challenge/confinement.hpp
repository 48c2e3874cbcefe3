// A process that may touch only some files, by Linux' Landlock (Linux 5.13 and later, where it is switched on).
#pragma once

#include <filesystem>
#include <vector>

namespace kenaf::gap::challenge {

// Made by the process that starts another one, which then puts itself under it.
class Confinement {
 public:
  // Files below `read` may be read and executed, below `write` also made, written and removed; no others. Those that do
  // not exist are left out. Where the kernel cannot confine, confines() is false.
  Confinement(const std::vector<std::filesystem::path>& read, const std::vector<std::filesystem::path>& write);
  ~Confinement();
  Confinement(const Confinement&) = delete;
  Confinement& operator=(const Confinement&) = delete;

  bool confines() const { return ruleset_ >= 0; }
  // Confines the calling thread and all that it starts, for good; after fork() it may be called at once. False: it
  // could not be done.
  bool enter() const;

 private:
  int ruleset_ = -1;
};

// Whether this kernel can confine.
bool can_confine();

}  // namespace kenaf::gap::challenge
