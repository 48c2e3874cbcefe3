// A temporary folder that removes itself.
#pragma once

#include <filesystem>

namespace kenaf::gap::challenge {

struct TemporaryFolder {
  TemporaryFolder();  // throws std::runtime_error if it cannot be created
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;
};

}  // namespace kenaf::gap::challenge
