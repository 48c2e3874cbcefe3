// Any text is python-can's CSV, or refused in words; what was read are frames.
#include "can/canlog/python_can_csv.hpp"

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/recorded_lines.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz::read_lines(text, canlog::read_python_can_csv);
  return 0;
}
