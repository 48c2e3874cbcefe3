// Whether a diagnosis can repeat the run: it asks the replay itself.
#include <string_view>

#include "gap/logs/run_checks.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::logs {

void RunChecks::check_replay() {
  if (any_refused(findings_)) return;  // one reason is enough
  try {
    rollout::replay_of(run_, file_);
  } catch (const runs::RunFileError& error) {
    // The finding names the file, too.
    std::string_view words = error.what();
    if (const std::string file = file_ + ": "; words.starts_with(file)) words.remove_prefix(file.size());
    add(Severity::refuse, "", std::string(words));
  }
}

}  // namespace kenaf::gap::logs
