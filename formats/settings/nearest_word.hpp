// The word that was probably meant, for errors about options, keys, variables and names that do not exist.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kenaf::settings {

// Returns the candidate nearest to `word`; empty if none is near, or if `word` is a candidate itself. Capitals, and '_'
// for '-', make no difference. Near are: the only candidate that begins with `word` (two characters at least), else one
// that differs by at most a third of the word's characters, and by one if the word is shorter than six; words of one or
// two characters must agree. A difference is a character too many, missing, wrong, or exchanged with its neighbour
// (optimal string alignment distance: Boytsov, "Indexing methods for approximate dictionary searching", ACM JEA 16,
// 2011, section 2.1). Of several that are equally near, the first one.
std::string_view nearest_word(std::string_view word, std::span<const std::string> candidates);

// The end of an error: "; did you mean relay?", or empty if no candidate is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

// "a", "a or b", "a, b or c".
std::string either_of(std::span<const std::string> words);

// A value as an error shows it: as it is, or in quotes if it is empty or has characters that a shell would not take for
// a word; control characters as \xNN; of a long one its first 60 bytes and "...".
std::string shown(std::string_view value);

}  // namespace kenaf::settings
