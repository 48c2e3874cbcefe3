// Diagnoses cases, each in a process of its own that knows neither key nor seed: this program again, started by exec
// with a clean environment. If the kernel supports it, the process may read only its case, programs, libraries and the
// data that ship with the project, and write only its report (gap/challenge/confinement.hpp).
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace kenaf::gap::challenge {

struct CaseToDiagnose {
  std::filesystem::path data, report;  // folders; the latter is created
  std::vector<std::string> without;    // effects
  std::filesystem::path against;       // a dataset within `data`; empty: none
};

// Runs up to `at_once` processes of one thread each. Calls `ended` after each one, with its index and whether it
// succeeded; its output is in report/diagnose.log. Once `stop` is true, running processes are killed without a report
// and no more are started. Not for a program that has other children or threads. Throws std::runtime_error if processes
// cannot be started.
void diagnose_cases(const std::vector<CaseToDiagnose>& cases, unsigned at_once, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t, bool)>& ended);

}  // namespace kenaf::gap::challenge
