// Diagnoses cases, each in a process of its own that knows neither key nor seed: this program again, by exec, with a
// clean environment, which where the kernel can do it may read nothing but its case, programs, libraries and what ships
// with the project, and write nothing but its report (gap/challenge/confinement.hpp).
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace kenaf::gap::challenge {

struct CaseToDiagnose {
  std::filesystem::path data, report;  // folders; the latter is made
  std::vector<std::string> without;    // effects
  std::filesystem::path against;       // a dataset within `data`; empty: none
};

// Up to `at_once` processes of one thread each. `ended` is called after each one, with its index and whether it could
// diagnose; what it says is in report/diagnose.log. Once `stop` is true the ones that run are ended, with no report,
// and no more are started. Not for a program that has other children or threads. Throws std::runtime_error where
// processes cannot be started.
void diagnose_cases(const std::vector<CaseToDiagnose>& cases, unsigned at_once, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t, bool)>& ended);

}  // namespace kenaf::gap::challenge
