// Any files that include one another are a world or are refused with a DescriptionError, within the limits.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "physics/world_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

namespace {

// The input's parts, split at lines of "%%": the world, then these files.
constexpr std::array<const char*, 5> kFiles{"a.sdf", "b/model.config", "b/model.sdf", "b/c.sdf", "mesh.obj"};
constexpr std::string_view kSplit = "\n%%\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Long texts would only be slow.
  if (size > 8192) return 0;
  static const kenaf::test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "b");

  std::string_view left(reinterpret_cast<const char*>(data), size);
  const auto take = [&left] {
    const std::size_t end = left.find(kSplit);
    const std::string_view part = left.substr(0, end);
    left = end == std::string_view::npos ? "" : left.substr(end + kSplit.size());
    return std::string(part);
  };
  const std::string world_text = take();
  for (const char* file : kFiles) kenaf::test::write_file(folder / file, take());

  std::vector<std::string> unsupported;
  try {
    const auto world = kenaf::physics::parse_world(world_text, "fuzz.sdf", folder.path(), unsupported);
    if (world.boxes.size() > 20'000 || unsupported.size() > 1001) __builtin_trap();
    if (!world.gravity_W_mps2.allFinite()) __builtin_trap();
    for (const auto& box : world.boxes)
      if (!(box.size_m.minCoeff() > 0) || !box.X_WBox.p.allFinite()) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
