// Confines a process to some files, by Landlock (Linux 5.13 and later, if enabled).
#pragma once

#include <filesystem>
#include <vector>

namespace kenaf::gap::challenge {

// Created by a process that starts another one, which then enters it.
class Confinement {
 public:
  // Allows to read and execute files below `read`, to create, write and remove them below `write` too, and nothing
  // else. Ignores paths that do not exist. confines() is false if the kernel cannot confine.
  Confinement(const std::vector<std::filesystem::path>& read, const std::vector<std::filesystem::path>& write);
  ~Confinement();
  Confinement(const Confinement&) = delete;
  Confinement& operator=(const Confinement&) = delete;

  bool confines() const { return ruleset_ >= 0; }
  // Confines the calling thread and all that it starts, for good. May be called directly after fork(). Returns false if
  // it fails.
  bool enter() const;

 private:
  int ruleset_ = -1;
};

// Whether this kernel can confine.
bool can_confine();

}  // namespace kenaf::gap::challenge
