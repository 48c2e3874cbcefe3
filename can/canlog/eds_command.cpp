#include "can/canlog/eds_command.hpp"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "can/canlog/eds_check.hpp"

namespace kenaf::canlog {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;  // as of robots' descriptions

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  std::string text(kMostBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw std::runtime_error(path + ": cannot be read");
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMostBytes) throw std::runtime_error(path + ": is larger than 16 MiB");
  return text;
}

// Returns whether nothing contradicts the file.
bool print_check(const EdsOptions& options, const canopen::EdsFile& file) {
  const canbus::RobotBus bus = canbus::load_robot_bus(options.robot);
  bool fits = true, has_drive = false;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const canbus::DriveOnBus& drive = bus.drives[i];
    if (options.node != 0 && options.node != drive.node) continue;
    has_drive = true;
    const std::vector<EdsFinding> found = check_eds(file, bus, i, options.period_s);
    for (const EdsFinding& one : found) {
      const std::string place = one.line > 0 ? fmt::format("{}:{}", options.file, one.line) : options.file;
      fmt::print("{}: {} {}\n", place, to_string(one.object), one.words);
    }
    fmt::print("{} (node {}): {} of its objects do not fit\n", drive.name, drive.node, found.size());
    fits = fits && found.empty();
  }
  if (!has_drive) {
    throw std::runtime_error(fmt::format("{}: has no drive with node {} in [can]; leave out --node for all drives",
                                         options.robot, options.node));
  }
  return fits;
}

}  // namespace

bool print_eds(const EdsOptions& options) {
  const std::string text = read_file(options.file);
  canopen::EdsFile file;
  try {
    file = canopen::read_eds(text);
  } catch (const std::runtime_error& refused) {
    throw std::runtime_error(options.file + ": " + refused.what());
  }
  const int node = options.node != 0 ? options.node : file.node.value_or(0);
  fmt::print("{} {}: {} objects, {} RPDOs, {} TPDOs\n", file.vendor, file.product, file.objects.size(),
             file.receive_pdos, file.transmit_pdos);
  fmt::print("{}", to_text(file, static_cast<canopen::NodeId>(node)));
  for (const canopen::EdsFault& fault : file.faults) fmt::print("{}:{}: {}\n", options.file, fault.line, fault.words);
  const bool fits = options.robot.empty() || print_check(options, file);
  return file.faults.empty() && fits;
}

}  // namespace kenaf::canlog
