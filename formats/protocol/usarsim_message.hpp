// The USARSim text protocol's grammar, both ways, without allocation on the reading side.
//
//   line    := TYPE {group}* EOL          EOL read: CR, LF or any mix of them; EOL written: CR LF
//   group   := '{' key [value] '}'        value: the rest of the group, trimmed, without quotes around it; it may hold
//                                         further key value pairs, as UT2004 writes `{Name ECLeft Tick 0}`
//
// Reading is lenient, for existing clients: types and keys ignore case, white space is optional, numbers of a vector
// are separated by commas or blanks, a decimal comma is accepted where it cannot be a separator, and numbers may end
// like C's and Java's literals (1.0f). A line with an odd group keeps the others, as by UDK's parser.
// Sources: the UT2004 and UDK USARSim servers and the clients listed in docs/world-server-protocol.md.
//
// Thread safety: values and pure functions. A MessageView refers to the line it was read from, which must outlive it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::protocol::usarsim {

inline constexpr std::size_t kMaxLineBytes = 65536;

struct Group {
  std::string_view key;    // "" for an empty group
  std::string_view value;  // trimmed; may be empty
};

struct MessageView {
  std::string_view type;  // trimmed, case as it came

  // The groups, in the order of the line.
  std::span<const Group> all() const;

  // The value of the first group with this key, ignoring case.
  std::optional<std::string_view> find(std::string_view key) const;

  // Whether the type matches, ignoring case.
  bool is(std::string_view expected_type) const;

  void clear();
  void add(const Group& group);

 private:
  std::array<Group, 64> few_;  // USARSim's own messages have no more, so that these need no allocation
  std::size_t few_count_ = 0;
  std::vector<Group> many_;  // all groups, as soon as they are more
};

enum class ParseError : std::uint8_t {
  none = 0,
  empty,           // nothing but white space
  no_type,         // begins with a brace
  unclosed_group,  // '{' without '}': the group ends at the next '{' or at the end of the line
  text_between,    // text outside of braces after the first group is skipped
};
std::string_view describe(ParseError error);
// Whether the line has a message all the same.
constexpr bool is_readable(ParseError error) {
  return error != ParseError::empty && error != ParseError::no_type;
}

// Reads one line without its EOL, and returns the first thing that is wrong with it. If is_readable(), `out` holds the
// type and every group of the line; otherwise it is empty.
ParseError parse_message(std::string_view line, MessageView& out);

bool equal_ignoring_case(std::string_view a, std::string_view b);

// Reads the whole text as one finite number, with optional white space around it; "1,5" is 1.5.
std::optional<double> parse_number(std::string_view text);
// "true", "True", "t", "1", "yes", "y", "on" and their opposites.
std::optional<bool> parse_bool(std::string_view text);
// Reads exactly `out.size()` numbers, separated by commas or blanks. If that does not give the count, commas are taken
// as decimal signs: "4,5 1,9 1,8" and "4,5,1,9,1,8" are three numbers. If it returns false, `out` is unspecified.
bool parse_numbers(std::string_view text, std::span<double> out);
// Reads any count of numbers and returns it; those beyond `out.size()` are not stored. Returns nullopt if one of them
// is no number.
std::optional<std::size_t> parse_number_list(std::string_view text, std::span<double> out);

// Removes the next word, delimited by white space, from `rest` and returns it; "" at the end.
std::string_view next_word(std::string_view& rest);

// Splits the TCP byte stream of one connection into lines. Holds an unfinished line and the lines not yet taken: if all
// are taken after each push(), it never holds more than kMaxLineBytes plus the bytes of that push.
class LineSplitter {
 public:
  // Appends received bytes. Returns false if a line exceeds kMaxLineBytes: it is dropped up to its end, later ones are
  // kept.
  bool push(std::string_view bytes);
  // The next complete, non-empty line, or nullopt. Valid until the next call of push().
  std::optional<std::string_view> next();
  // Lines that push() had to drop so far.
  std::uint64_t dropped_lines() const { return dropped_lines_; }

 private:
  std::string buffer_;
  std::size_t read_ = 0;        // end of the lines that were taken
  std::size_t line_start_ = 0;  // start of the unfinished line
  bool dropping_ = false;
  std::uint64_t dropped_lines_ = 0;
};

// Format of numbers. The two historic dialects differ in it, and a connection may ask for more digits.
struct NumberFormat {
  int decimals = 4;
  bool truncate = false;  // cut off (UDK) instead of rounding (UT2004)
};
constexpr NumberFormat kExactNumber{12, false};  // for Kenaf's own programs

// Appends messages to a buffer that keeps its capacity, so that a steady stream does not allocate.
class MessageWriter {
 public:
  explicit MessageWriter(std::string& out) : out_(out) {}

  MessageWriter& begin(std::string_view type);
  // Writes nothing for an empty value: parsers of clients fail on a key alone.
  MessageWriter& text(std::string_view key, std::string_view value);
  MessageWriter& number(std::string_view key, double value, NumberFormat format);
  MessageWriter& integer(std::string_view key, std::int64_t value);
  MessageWriter& boolean(std::string_view key, bool value);                                           // True, False
  MessageWriter& numbers(std::string_view key, std::span<const double> values, NumberFormat format);  // a,b,c
  // For groups of several pairs: open_group("Name", "ECLeft"), then add...("Tick", 0), then close_group().
  MessageWriter& open_group(std::string_view key, std::string_view value);
  MessageWriter& add_text(std::string_view key, std::string_view value);
  MessageWriter& add_number(std::string_view key, double value, NumberFormat format);
  MessageWriter& add_integer(std::string_view key, std::int64_t value);
  MessageWriter& add_numbers(std::string_view key, std::span<const double> values, NumberFormat format);
  MessageWriter& close_group();
  void end();  // CR LF

 private:
  std::string& out_;
};

// Appends `value` in `format`, without exponent; "-0.00" becomes "0.00", NaN and infinity become 0.
void append_number(std::string& out, double value, NumberFormat format);

}  // namespace kenaf::protocol::usarsim
