// Any text is an ASCII log of Vector's, or refused in words; what was read are frames.
#include "can/canlog/vector_ascii.hpp"

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/recorded_lines.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  canlog::VectorAscii ascii;
  fuzz::read_lines(text, [&](std::string_view line) { return ascii.read(line); });
  return 0;
}
