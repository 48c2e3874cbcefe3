// What is hidden in the cases of a challenge, and how it is sealed: the key is in no file until all cases are
// diagnosed, but its hash is, so that it cannot become another one. Enciphered with the seed it is there, so that a
// challenge that was interrupted need not make its cases again.
//
// The key holds a salt of 256 bits, without which its hash could be found by trying what may be hidden. The salt is
// made from the challenge's seed, so that a challenge that was interrupted has the same key when it goes on.
//
// Thread safety: values; functions that touch files only those that they are given.
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

// Whether this folder holds that dataset, all of it and as it was sealed.
bool is_sealed_dataset(const std::filesystem::path& dataset, const SealedCase& sealed);

struct ChallengeKey {
  std::uint64_t seed = 0;
  std::vector<SealedCase> cases;
  ChallengeKind kind = ChallengeKind::exact;
};

// key.json, of the format kenaf-gap-key/1. The same key gives the same bytes.
std::string key_text(const ChallengeKey& key);
// Throws std::runtime_error in words where it is none.
ChallengeKey read_key(const std::string& text);

// commitment.txt, which `sha256sum --check` reads.
std::string commitment_text(const std::string& key_text);

// key.enciphered: what only who has the seed can read; with another one it is noise. Each is the other's inverse.
// By SHA-256 in counter mode. std::runtime_error where a text was never enciphered.
std::string enciphered(const std::string& key_text, std::uint64_t seed);
std::string deciphered(const std::string& text, std::uint64_t seed);

// A case beside its data in CASES while the others are made, enciphered with the seed, so that a challenge that is
// interrupted then need not make it again: CASES/NAME.enciphered. `cases`: how many the challenge has, for the same
// seed plans others for another number, and for another kind of challenge.
void keep_made_case(const std::filesystem::path& folder, const SealedCase& sealed, std::uint64_t seed,
                    std::size_t cases, ChallengeKind kind = ChallengeKind::exact);
// Nothing where there is none, where seed, number or kind are others, or where its data are no longer what was made.
std::optional<SealedCase> made_case(const std::filesystem::path& folder, const std::string& name, std::uint64_t seed,
                                    std::size_t cases, ChallengeKind kind = ChallengeKind::exact);

// The key of a challenge that was interrupted after its cases were made; nothing where it was not, where the seed is
// another one, or where key or commitment is no longer what was sealed.
std::optional<ChallengeKey> sealed_key(const std::filesystem::path& folder, std::uint64_t seed);
// Whether a challenge was sealed there with another seed, so that this one could not go on with it.
bool is_sealed_by_another(const std::filesystem::path& folder, std::uint64_t seed);

// Reads DIR/key.json. Throws std::runtime_error in words where it is not there yet, is not the one that
// DIR/commitment.txt was made from, or the data of a case that is there is no longer that which was diagnosed.
ChallengeKey open_key(const std::filesystem::path& folder);

std::filesystem::path case_folder(const std::filesystem::path& folder, const std::string& name);    // DIR/cases/NAME
std::filesystem::path report_folder(const std::filesystem::path& folder, const std::string& name);  // DIR/reports/NAME

}  // namespace kenaf::gap::challenge
