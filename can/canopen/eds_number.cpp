#include "can/canopen/eds_number.hpp"

#include <charconv>
#include <limits>

#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen {
namespace {

constexpr std::string_view kNodeId = "$NODEID";

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool is_node_id(std::string_view text) {
  return text.size() == kNodeId.size() &&
         std::ranges::equal(text, kNodeId, [](char a, char b) { return upper(a) == b; });
}

std::optional<std::int64_t> plain_number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
  } else if (text.size() > 1 && text.starts_with('0')) {
    base = 8;
  }
  std::uint64_t magnitude = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), magnitude, base);
  // The magnitude of the least number is one more than that of the greatest.
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (error != std::errc() || end != text.data() + text.size() || magnitude > kMost) return std::nullopt;
  const auto value = static_cast<std::int64_t>(magnitude);
  return negative ? -value : value;
}

}  // namespace

std::optional<EdsNumber> eds_number(std::string_view text) {
  text = text::trimmed(text);
  if (is_node_id(text)) return EdsNumber{0, true};
  // "$NODEID+number" or "number+$NODEID"; a plus at the start is a sign.
  const std::size_t plus = text.size() > 1 ? text.find('+', 1) : std::string_view::npos;
  if (plus == std::string_view::npos) {
    const std::optional<std::int64_t> value = plain_number(text);
    return value ? std::optional(EdsNumber{*value, false}) : std::nullopt;
  }
  std::string_view number = text::trimmed(text.substr(0, plus)), node = text::trimmed(text.substr(plus + 1));
  if (is_node_id(number)) std::swap(number, node);
  const std::optional<std::int64_t> value = plain_number(number);
  if (!is_node_id(node) || !value || *value > std::numeric_limits<std::int64_t>::max() - kMaxNode) return std::nullopt;
  return EdsNumber{*value, true};
}

}  // namespace kenaf::canopen
