// Any SQLite file is read as one of rosbag2, or refused with words; a mapping that is guessed of it can be used.
#include "gap/recordings/sqlite_bag.hpp"
#include "tests/fuzz/recording_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  fuzz::use_or_refuse([&] {
    return gap::recordings::open_sqlite_bag_in_memory({reinterpret_cast<const char*>(data), size});
  });
  return 0;
}
