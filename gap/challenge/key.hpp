// The key of a challenge, which says what its cases hide, and how it is sealed. Until all cases are diagnosed only its
// hash is in a plain file, so that it cannot be exchanged; the key itself is enciphered with the seed, so that an
// interrupted challenge need not make its cases again.
//
// The key holds a salt of 256 bits, without which it could be found from its hash by trial. The salt is made from the
// challenge's seed, so that an interrupted challenge has the same key when it is resumed.
//
// Thread safety: values; functions touch only the files that they are given.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {

struct SealedCase {
  CasePlan plan;
  std::string data_sha256;  // of its dataset
};

// Whether this folder holds that dataset, complete and as it was sealed.
bool is_sealed_dataset(const std::filesystem::path& dataset, const SealedCase& sealed);

struct ChallengeKey {
  std::uint64_t seed = 0;
  std::vector<SealedCase> cases;
  ChallengeKind kind = ChallengeKind::exact;
};

// Returns key.json, in the format kenaf-gap-key/1; "challenge" is the kind_name(). The same key gives the same bytes.
std::string key_text(const ChallengeKey& key);
// Throws std::runtime_error with words for the user if the text is not a key.
ChallengeKey read_key(const std::string& text);

// Returns commitment.txt, which `sha256sum --check` reads.
std::string commitment_text(const std::string& key_text);

// key.enciphered, readable only with the seed; with another one deciphered() returns noise. The two are inverses of
// each other, by SHA-256 in counter mode. Throws std::runtime_error if a text was never enciphered.
std::string enciphered(const std::string& key_text, std::uint64_t seed);
std::string deciphered(const std::string& text, std::uint64_t seed);

// Writes the key of a case beside its data while the others are made, enciphered with the seed, so that an interrupted
// challenge need not make it again: FOLDER/NAME.enciphered. `cases` is the number of cases of the challenge: for
// another number, as for another kind, the same seed plans other cases.
void keep_made_case(const std::filesystem::path& folder, const SealedCase& sealed, std::uint64_t seed,
                    std::size_t cases, ChallengeKind kind = ChallengeKind::exact);
// Reads it back. Empty if there is none, seed, number or kind differ, or its data have changed.
std::optional<SealedCase> made_case(const std::filesystem::path& folder, const std::string& name, std::uint64_t seed,
                                    std::size_t cases, ChallengeKind kind = ChallengeKind::exact);

// Returns the key of a challenge that was interrupted after its cases were made. Empty if there is none, the seed
// differs, or key or commitment have changed.
std::optional<ChallengeKey> sealed_key(const std::filesystem::path& folder, std::uint64_t seed);
// Whether a challenge was sealed there with another seed, so that this one cannot resume it.
bool is_sealed_by_another(const std::filesystem::path& folder, std::uint64_t seed);

// Reads DIR/key.json. Throws std::runtime_error with words for the user if it does not exist yet, is not the one that
// DIR/commitment.txt was made from, or the data of a case differ from those that were diagnosed.
ChallengeKey open_key(const std::filesystem::path& folder);

std::filesystem::path case_folder(const std::filesystem::path& folder, const std::string& name);    // DIR/cases/NAME
std::filesystem::path report_folder(const std::filesystem::path& folder, const std::string& name);  // DIR/reports/NAME

}  // namespace kenaf::gap::challenge
