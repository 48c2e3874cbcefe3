// The first bytes of a connection, cut anywhere: the answer is the same as in one piece, and is given once.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "formats/protocol/foreign_opening.hpp"

namespace {

using kenaf::protocol::Opening;

void require(bool fine) {
  if (!fine) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0] % 16;
  std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);

  Opening whole;
  const std::string_view expected = whole.take(bytes);
  require(whole.take("GET / HTTP/1.1\r\n").empty() || expected.empty());

  Opening cut;
  std::string_view shown;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
    const std::string_view now = cut.take(bytes.substr(0, piece));
    require(now.empty() || shown.empty());
    if (!now.empty()) shown = now;
  }
  require(shown == expected);
  return 0;
}
