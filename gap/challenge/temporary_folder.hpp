// A folder that is gone when it is no longer needed.
#pragma once

#include <filesystem>

namespace kenaf::gap::challenge {

struct TemporaryFolder {
  TemporaryFolder();  // throws std::runtime_error where none can be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;
};

}  // namespace kenaf::gap::challenge
