#include "formats/runs/port_file.hpp"

#include <string>

#include "formats/runs/run_file.hpp"
#include "formats/runs/whole_file.hpp"

namespace kenaf::runs {

void write_port_file(const std::filesystem::path& path, std::uint16_t port) {
  try {
    write_whole_file(path, std::to_string(port) + '\n');
  } catch (const RunFileError& error) {  // the user of a server knows of its port file, and of no part file
    throw RunFileError(std::string("cannot write the port file: ") + error.what());
  }
}

}  // namespace kenaf::runs
