// A stream cut into packets anywhere gives the same lines as in one piece, and whatever a line holds, reading it ends
// and what was read can be written and read again.
#include <cstdlib>
#include <string>
#include <vector>

#include "formats/protocol/usarsim_message.hpp"

namespace {

using namespace kenaf::protocol::usarsim;

void take_all(LineSplitter& splitter, std::vector<std::string>& lines) {
  while (const auto line = splitter.next()) lines.emplace_back(*line);
}

void read_values(std::string_view value) {
  std::array<double, 6> numbers{};
  parse_number(value);
  parse_bool(value);
  parse_number_list(value, numbers);
  parse_numbers(value, std::span(numbers).first(3));
  while (!next_word(value).empty()) {
  }
}

void check_line(std::string_view line) {
  MessageView message;
  const bool readable = is_readable(parse_message(line, message));
  if (readable == message.type.empty() || (!readable && !message.all().empty())) std::abort();
  if (!readable) return;
  std::string written;
  MessageWriter writer(written);
  writer.begin(message.type);
  for (const Group& group : message.all()) {
    read_values(group.value);
    writer.open_group(group.key, group.value).close_group();
  }
  MessageView again;
  if (parse_message(written, again) != ParseError::none) std::abort();
  if (again.all().size() != message.all().size()) std::abort();
  for (std::size_t i = 0; i < again.all().size(); ++i) {
    if (again.all()[i].key != message.all()[i].key || again.all()[i].value != message.all()[i].value) std::abort();
  }
}

}  // namespace

// The first byte says how long the packets are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t packet = data[0] % 32u + 1u;
  const std::string_view stream(reinterpret_cast<const char*>(data + 1), size - 1);

  LineSplitter at_once;
  at_once.push(stream);
  std::vector<std::string> lines;
  take_all(at_once, lines);

  LineSplitter in_packets;
  std::vector<std::string> same_lines;
  for (std::size_t at = 0; at < stream.size(); at += packet) {
    in_packets.push(stream.substr(at, packet));
    take_all(in_packets, same_lines);
  }
  if (lines != same_lines || at_once.dropped_lines() != in_packets.dropped_lines()) std::abort();
  for (const std::string& line : lines) check_line(line);
  return 0;
}
