// Runs the program kenaf-gap as a user does.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/formats/runs/temporary_folder.hpp"

namespace kenaf::test {

struct Outcome {
  int status;
  std::string out, error;
};

// In `folder`, with `arguments` as a shell takes them.
inline Outcome kenaf_gap(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string command =
      "cd '" + folder.path().string() + "' && '" KENAF_GAP "' " + arguments + " >out.txt 2>error.txt </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / "out.txt"), read_file(folder / "error.txt")};
}

}  // namespace kenaf::test
