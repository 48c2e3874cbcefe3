// Runs a program as a user does, in a folder.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/formats/runs/temporary_folder.hpp"

namespace kenaf::test {

struct Outcome {
  int status;  // of its exit; -1: it was killed
  std::string out, error;
};

// `command` is the program with its arguments, as a shell takes them.
inline Outcome outcome_in(const TemporaryFolder& folder, const std::string& command) {
  const std::string in_folder =
      "cd '" + folder.path().string() + "' && " + command + " >out.txt 2>error.txt </dev/null";
  const int status = std::system(in_folder.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / "out.txt"), read_file(folder / "error.txt")};
}

}  // namespace kenaf::test
