#include "gap/challenge/sealed_data.hpp"

#include <fmt/format.h>

#include <mutex>
#include <stdexcept>
#include <vector>

#include "gap/challenge/make_case.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::challenge {

namespace {
namespace fs = std::filesystem;
}

void make_missing_data(const fs::path& folder, const ChallengeKey& key, unsigned jobs, const std::atomic<bool>* stop,
                       const std::function<void(std::size_t made, std::size_t missing)>& progress) {
  std::vector<const SealedCase*> missing;
  for (const SealedCase& sealed : key.cases)
    if (!is_sealed_dataset(case_folder(folder, sealed.plan.name), sealed)) missing.push_back(&sealed);
  std::mutex mutex;
  std::size_t made = 0;
  // Each is made in a temporary folder, and moved to its place only if it matches its seal.
  for_each_job(missing.size(), jobs, [&](std::size_t i) {
    diagnose::check_goes_on(stop);
    const fs::path data = case_folder(folder, missing[i]->plan.name), part = data.string() + ".part";
    fs::remove_all(part);
    make_again(missing[i]->plan, part, 1, stop);
    const bool same = is_sealed_dataset(part, *missing[i]);
    fs::remove_all(same ? data : part);
    if (!same)
      throw std::runtime_error(
          fmt::format("{}: the data that this program makes from the key does not match the sealed data; use the same "
                      "version of the program on the same kind of machine",
                      data.string()));
    fs::rename(part, data);
    const std::lock_guard lock(mutex);
    progress(++made, missing.size());
  });
}

}  // namespace kenaf::gap::challenge
