#include "formats/description/flipper_pairs.hpp"

#include <fmt/format.h>

namespace kenaf::description {

FlipperPairs read_flipper_pairs(TomlReader& flipper) {
  if (!flipper.has("pairs")) return {};
  const std::string pairs = flipper.text("pairs");
  if (pairs != "front" && pairs != "rear" && pairs != "both")
    flipper.fail("pairs", fmt::format("is \"{}\", but must be \"front\", \"rear\" or \"both\"", pairs));
  return {.front = pairs != "rear", .rear = pairs != "front"};
}

}  // namespace kenaf::description
