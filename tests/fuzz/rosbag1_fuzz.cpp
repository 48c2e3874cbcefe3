// Any bag of ROS 1 is read as far as it goes, or refused with words; a mapping that is guessed of it can be used.
#include "gap/recordings/rosbag1_reader.hpp"
#include "tests/fuzz/recording_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  fuzz::use_or_refuse([&] {
    return gap::recordings::open_rosbag1(
        gap::recordings::bytes_in_memory(std::string(reinterpret_cast<const char*>(data), size)));
  });
  return 0;
}
