// Any MCAP file is read as far as it goes, or refused with words; a mapping that is guessed of it can be used.
#include "gap/recordings/mcap_reader.hpp"
#include "tests/fuzz/recording_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  fuzz::use_or_refuse([&] {
    return gap::recordings::open_mcap(
        gap::recordings::bytes_in_memory(std::string(reinterpret_cast<const char*>(data), size)));
  });
  return 0;
}
