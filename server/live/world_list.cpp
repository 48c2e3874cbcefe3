#include "server/live/world_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "formats/description/data_files.hpp"
#include "formats/protocol/host_port.hpp"
#include "server/live/json_writer.hpp"

namespace kenaf::live {

namespace {

constexpr std::size_t kLooked_bytes = 4096;  // of a file, for its first comment
constexpr std::size_t kMostWords_bytes = 300;

std::string beginning_of(const std::filesystem::path& path) {
  std::string bytes(kLooked_bytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

}  // namespace

std::string first_comment(std::string_view sdf) {
  constexpr std::string_view kBegin = "<!--", kEnd = "-->", kBlank = " \t\r\n";
  const std::size_t begin = sdf.find(kBegin);
  if (begin == sdf.npos) return {};
  sdf.remove_prefix(begin + kBegin.size());
  sdf = sdf.substr(0, sdf.find(kEnd));

  std::string words;
  while (!sdf.empty()) {
    const std::size_t from = sdf.find_first_not_of(kBlank);
    if (from == sdf.npos) break;
    const std::size_t to = std::min(sdf.find_first_of(kBlank, from), sdf.size());
    const std::string_view word = sdf.substr(from, to - from);
    if (words.size() + 1 + word.size() > kMostWords_bytes) break;
    if (!words.empty()) words += ' ';
    words += word;
    sdf.remove_prefix(to);
  }
  return words;
}

std::vector<InstalledWorld> installed_worlds() {
  std::vector<InstalledWorld> worlds;
  for (const std::filesystem::path& file : description::list_data_files("worlds", ".sdf"))
    worlds.push_back({file.stem().string(), first_comment(beginning_of(file))});
  return worlds;
}

std::string start_command(const ViewOptions& options, std::uint16_t port) {
  const ViewOptions usual;
  const bool elsewhere = options.address != usual.address || port != usual.port;
  return fmt::format("{} --world WORLD{}{}", options.program, elsewhere ? " --view " : "",
                     elsewhere ? protocol::to_text({options.address, port}) : std::string());
}

std::string worlds_message(const std::string& command, const std::vector<InstalledWorld>& worlds) {
  JsonWriter out;
  out.open('{').key("command").text(command).key("worlds").open('[');
  for (const InstalledWorld& world : worlds)
    out.comma().open('{').key("name").text(world.name).key("words").text(world.words).close('}');
  return out.close(']').close('}').take();
}

}  // namespace kenaf::live
