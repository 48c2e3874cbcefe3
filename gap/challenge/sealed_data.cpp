#include "gap/challenge/sealed_data.hpp"

#include <fmt/format.h>

#include <exception>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "gap/challenge/make_case.hpp"
#include "gap/challenge/sha256.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap {
namespace {

namespace fs = std::filesystem;

bool is_dataset_of(const fs::path& data, const SealedCase& sealed) try {
  return sha256_of_dataset(data) == sealed.data_sha256;
} catch (const std::exception&) {
  return false;  // none, or not all of it
}

}  // namespace

bool has_sealed_data(const fs::path& folder, const SealedCase& sealed) {
  return is_dataset_of(case_folder(folder, sealed.plan.name), sealed);
}

void make_missing_data(const fs::path& folder, const ChallengeKey& key, unsigned jobs, const std::atomic<bool>* stop,
                       const std::function<void(std::size_t made, std::size_t missing)>& progress) {
  std::vector<const SealedCase*> missing;
  for (const SealedCase& sealed : key.cases)
    if (!has_sealed_data(folder, sealed)) missing.push_back(&sealed);
  std::mutex mutex;
  std::size_t made = 0;
  for_each_job(missing.size(), jobs, [&](std::size_t i) {
    check_goes_on(stop);
    const fs::path data = case_folder(folder, missing[i]->plan.name), part = data.string() + ".part";
    fs::remove_all(part);
    make_again(missing[i]->plan, part, 1, stop);
    const bool same = is_dataset_of(part, *missing[i]);
    fs::remove_all(same ? data : part);
    if (!same)
      throw std::runtime_error(
          fmt::format("{}: what this program makes from the key is not what was sealed; the same version of it on the "
                      "same kind of machine would",
                      data.string()));
    fs::rename(part, data);
    const std::lock_guard lock(mutex);
    progress(++made, missing.size());
  });
}

}  // namespace kenaf::gap
