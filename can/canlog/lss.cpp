#include "can/canlog/lss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace kenaf::canlog {
namespace {

// What follows the command specifier.
enum class Carries : std::uint8_t { nothing, mode, node, bit_timing, milliseconds, number };

struct LssCommand {
  std::uint8_t specifier;
  std::string_view name;
  Carries request, answer;
};

constexpr LssCommand kCommands[] = {
    {0x04, "switch state global", Carries::mode, Carries::nothing},
    {0x11, "configure node id", Carries::node, Carries::node},
    {0x13, "configure bit timing", Carries::bit_timing, Carries::node},
    {0x15, "activate bit timing, after", Carries::milliseconds, Carries::nothing},
    {0x17, "store configuration", Carries::nothing, Carries::node},
    {0x40, "switch state selective, vendor", Carries::number, Carries::number},
    {0x41, "switch state selective, product", Carries::number, Carries::number},
    {0x42, "switch state selective, revision", Carries::number, Carries::number},
    {0x43, "switch state selective, serial number", Carries::number, Carries::number},
    {0x44, "switch state selective, selected", Carries::nothing, Carries::nothing},
    {0x46, "identify remote slave, vendor", Carries::number, Carries::number},
    {0x47, "identify remote slave, product", Carries::number, Carries::number},
    {0x48, "identify remote slave, lowest revision", Carries::number, Carries::number},
    {0x49, "identify remote slave, highest revision", Carries::number, Carries::number},
    {0x4a, "identify remote slave, lowest serial number", Carries::number, Carries::number},
    {0x4b, "identify remote slave, highest serial number", Carries::number, Carries::number},
    {0x4c, "identify non-configured remote slave", Carries::nothing, Carries::nothing},
    {0x4f, "identify slave", Carries::nothing, Carries::nothing},
    {0x50, "identify non-configured slave", Carries::nothing, Carries::nothing},
    {0x51, "fastscan", Carries::number, Carries::nothing},
    {0x5a, "inquire vendor", Carries::nothing, Carries::number},
    {0x5b, "inquire product", Carries::nothing, Carries::number},
    {0x5c, "inquire revision", Carries::nothing, Carries::number},
    {0x5d, "inquire serial number", Carries::nothing, Carries::number},
    {0x5e, "inquire node id", Carries::nothing, Carries::node},
};

std::string carried_words(const canopen::Frame& frame, Carries what) {
  switch (what) {
    case Carries::nothing:
      return "";
    case Carries::mode:
      return frame.data[1] == 0   ? ": waiting"
             : frame.data[1] == 1 ? ": configuration"
                                  : fmt::format(": {}", frame.data[1]);
    case Carries::node:
      return fmt::format(": {}", frame.data[1]);
    case Carries::bit_timing:
      return fmt::format(": table {}, entry {}", frame.data[1], frame.data[2]);
    case Carries::milliseconds:
      return fmt::format(": {} ms", canopen::get_unsigned(frame.data, 1, 2));
    case Carries::number:
      return fmt::format(": {:#010x}", canopen::get_unsigned(frame.data, 1, 4));
  }
  return "";
}

}  // namespace

std::string lss_words(const canopen::Frame& frame) {
  const bool answer = frame.id == kLssAnswerId;
  const std::string_view who = answer ? "LSS answer: " : "LSS ";
  if (frame.length != canopen::kMaxFrameBytes) {
    return fmt::format("{}malformed: {} bytes {:02X}", who, frame.length,
                       fmt::join(frame.data.begin(), frame.data.begin() + frame.length, " "));
  }
  const auto* found = std::ranges::find(kCommands, frame.data[0], &LssCommand::specifier);
  if (found == std::end(kCommands)) return fmt::format("{}{:#04x}, which CiA 305 does not define", who, frame.data[0]);
  return fmt::format("{}{}{}", who, found->name, carried_words(frame, answer ? found->answer : found->request));
}

}  // namespace kenaf::canlog
