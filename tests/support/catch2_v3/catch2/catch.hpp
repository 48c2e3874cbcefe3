// Catch2 3 by the header and the names of Catch2 2, of which Debian 12 has the last. Only this folder knows of both.
#pragma once

#include <catch2/catch_all.hpp>
#include <string>

using Catch::Approx;

namespace Catch {

using Matchers::EndsWith;
using Matchers::Matches;
using Matchers::StartsWith;

// A part of a text. Catch2 3 has that name for an element of a list.
inline auto Contains(const std::string& part) {
  return Matchers::ContainsSubstring(part);
}

}  // namespace Catch
