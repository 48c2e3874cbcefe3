#include "formats/protocol/usarsim_message.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kenaf::protocol::usarsim {

namespace {

// NUL is among the blanks because C clients send their strings' terminators.
constexpr std::string_view kBlanks{" \t\v\f\r\n\0", 7};
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // .NET writes it before its first line

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Without the quotes around it, however many.
std::string_view unquote(std::string_view text) {
  text = trim(text);
  while (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front()) {
    text = trim(text.substr(1, text.size() - 2));
  }
  return text;
}

// A number with a decimal point and nothing around it but the suffix of a literal in C# or Java: 1.0f, 1.0d.
std::optional<double> read_number(std::string_view text) {
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  const std::string_view suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const bool literal = suffix.size() == 1 && std::string_view("fFdD").find(suffix[0]) != std::string_view::npos;
  if (!suffix.empty() && !literal) return std::nullopt;
  return value;
}

// The same with a comma as decimal sign.
std::optional<double> read_decimal_comma(std::string_view text) {
  std::array<char, 64> copy;
  if (text.size() > copy.size() || text.find('.') != std::string_view::npos) return std::nullopt;
  std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
  return read_number({copy.data(), text.size()});  // a second comma has become a second point: no number
}

// Takes the text of the next number of a list separated by blanks, one comma, or both. Returns nullopt for two commas
// without a number between them, or a comma at an end of the list.
std::optional<std::string_view> next_list_item(std::string_view& rest) {
  const std::size_t end = std::min(rest.size(), rest.find_first_of(" \t\v\f\r\n,"));
  const std::string_view item = rest.substr(0, end);
  rest = trim(rest.substr(end));
  if (item.empty()) return std::nullopt;
  if (rest.starts_with(',')) {
    rest = trim(rest.substr(1));
    if (rest.empty()) return std::nullopt;
  }
  return item;
}

// "4,5 1,9 1,8": blanks separate, so a comma can only be the decimal sign.
bool read_blank_separated(std::string_view text, std::span<double> out) {
  for (double& value : out) {
    const std::optional<double> number = parse_number(next_word(text));
    if (!number) return false;
    value = *number;
  }
  return trim(text).empty();
}

// "4,5,1,9,1,8" for three numbers with decimal commas: twice as many whole numbers as expected.
bool read_comma_pairs(std::string_view text, std::span<double> out) {
  if (text.find('.') != std::string_view::npos) return false;
  text = trim(text);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t sign = text.find(',');
    if (sign == std::string_view::npos) return false;
    const std::size_t end = std::min(text.size(), text.find(',', sign + 1));
    const std::string_view fraction = trim(text.substr(sign + 1, end - sign - 1));
    if (fraction.empty() || !std::all_of(fraction.begin(), fraction.end(), is_digit)) return false;
    const std::optional<double> number = parse_number(text.substr(0, end));
    if (!number) return false;
    out[i] = *number;
    const bool last = i + 1 == out.size();
    if (last != (end == text.size())) return false;
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return true;
}

void append_integer(std::string& out, std::int64_t value) {
  std::array<char, 24> digits;
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// Text from elsewhere must not end its group or its line.
void append_text(std::string& out, std::string_view text) {
  for (const char c : text) out += c == '{' || c == '}' || c == '\r' || c == '\n' ? '_' : c;
}

void append_numbers(std::string& out, std::span<const double> values, NumberFormat format) {
  bool first = true;
  for (const double value : values) {
    if (!first) out += ',';
    first = false;
    append_number(out, value, format);
  }
}

}  // namespace

std::span<const Group> MessageView::all() const {
  return many_.empty() ? std::span(few_).first(few_count_) : std::span(many_);
}

void MessageView::clear() {
  type = {};
  few_count_ = 0;
  many_.clear();
}

void MessageView::add(const Group& group) {
  if (many_.empty() && few_count_ < few_.size()) {
    few_[few_count_++] = group;
    return;
  }
  if (many_.empty()) many_.assign(few_.begin(), few_.end());
  many_.push_back(group);
}

std::optional<std::string_view> MessageView::find(std::string_view key) const {
  for (const Group& group : all()) {
    if (equal_ignoring_case(group.key, key)) return group.value;
  }
  return std::nullopt;
}

bool MessageView::is(std::string_view expected_type) const {
  return equal_ignoring_case(type, expected_type);
}

std::string_view describe(ParseError error) {
  switch (error) {
    case ParseError::none:
      return "a whole message";
    case ParseError::empty:
      return "an empty line";
    case ParseError::no_type:
      return "no message type before the first brace";
    case ParseError::unclosed_group:
      return "a group without its closing brace";
    case ParseError::text_between:
      return "text outside of the braces after the first group";
  }
  return "unknown error of a message";
}

ParseError parse_message(std::string_view line, MessageView& out) {
  out.clear();
  line = trim(line);
  while (line.starts_with(kByteOrderMark)) line = trim(line.substr(kByteOrderMark.size()));
  if (line.empty()) return ParseError::empty;
  if (line.starts_with('{')) return ParseError::no_type;

  // The type up to the first brace, then groups; only white space should stand between them.
  ParseError first = ParseError::none;
  const auto note = [&first](ParseError error) { first = first == ParseError::none ? error : first; };
  const std::size_t type_end = std::min(line.size(), line.find('{'));
  out.type = trim(line.substr(0, type_end));
  line.remove_prefix(type_end);
  while (!line.empty()) {
    const std::size_t end = std::min(line.size(), line.find_first_of("{}", 1));
    const bool closed = end < line.size() && line[end] == '}';
    if (!closed) note(ParseError::unclosed_group);
    std::string_view value = line.substr(1, end - 1);
    const std::string_view key = next_word(value);
    if (closed || !key.empty()) out.add({key, unquote(value)});

    // What stands before the next group is skipped.
    line.remove_prefix(closed ? end + 1 : end);
    const std::size_t next = std::min(line.size(), line.find('{'));
    if (!trim(line.substr(0, next)).empty()) note(ParseError::text_between);
    line.remove_prefix(next);
  }
  return first;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  return text.find(',') == std::string_view::npos ? read_number(text) : read_decimal_comma(text);
}

std::optional<bool> parse_bool(std::string_view text) {
  text = trim(text);
  for (const std::string_view yes : {"true", "t", "1", "yes", "y", "on"}) {
    if (equal_ignoring_case(text, yes)) return true;
  }
  for (const std::string_view no : {"false", "f", "0", "no", "n", "off"}) {
    if (equal_ignoring_case(text, no)) return false;
  }
  return std::nullopt;
}

bool parse_numbers(std::string_view text, std::span<double> out) {
  return parse_number_list(text, out) == out.size() || read_blank_separated(text, out) || read_comma_pairs(text, out);
}

std::optional<std::size_t> parse_number_list(std::string_view text, std::span<double> out) {
  std::size_t count = 0;
  for (std::string_view rest = trim(text); !rest.empty(); ++count) {
    const std::optional<std::string_view> item = next_list_item(rest);
    const std::optional<double> number = item ? read_number(*item) : std::nullopt;
    if (!number) return std::nullopt;
    if (count < out.size()) out[count] = *number;
  }
  return count;
}

std::string_view next_word(std::string_view& rest) {
  const std::size_t first = std::min(rest.size(), rest.find_first_not_of(kBlanks));
  rest.remove_prefix(first);
  const std::size_t end = std::min(rest.size(), rest.find_first_of(kBlanks));
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

bool LineSplitter::push(std::string_view bytes) {
  // Lines that were taken are dropped.
  buffer_.erase(0, read_);
  line_start_ -= read_;
  read_ = 0;

  // Each piece up to a CR or LF is appended; empty lines, as between CR and LF, are skipped, and too long ones dropped.
  bool whole = true;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find_first_of("\r\n");
    const std::string_view piece = bytes.substr(0, end);
    if (!dropping_ && buffer_.size() - line_start_ + piece.size() > kMaxLineBytes) {
      buffer_.resize(line_start_);
      dropping_ = true;
      ++dropped_lines_;
      whole = false;
    }
    if (!dropping_) buffer_.append(piece);
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end + 1);
    if (buffer_.size() > line_start_) buffer_ += '\n';
    line_start_ = buffer_.size();
    dropping_ = false;
  }
  return whole;
}

std::optional<std::string_view> LineSplitter::next() {
  if (read_ == line_start_) return std::nullopt;
  const std::size_t start = read_;
  const std::size_t end = buffer_.find('\n', start);
  read_ = end + 1;
  return std::string_view(buffer_).substr(start, end - start);
}

MessageWriter& MessageWriter::begin(std::string_view type) {
  append_text(out_, type);
  return *this;
}

MessageWriter& MessageWriter::text(std::string_view key, std::string_view value) {
  if (value.empty()) return *this;
  return open_group(key, value).close_group();
}

MessageWriter& MessageWriter::number(std::string_view key, double value, NumberFormat format) {
  return numbers(key, {&value, 1}, format);
}

MessageWriter& MessageWriter::integer(std::string_view key, std::int64_t value) {
  out_ += " {";
  append_text(out_, key);
  out_ += ' ';
  append_integer(out_, value);
  return close_group();
}

MessageWriter& MessageWriter::boolean(std::string_view key, bool value) {
  return text(key, value ? "True" : "False");
}

MessageWriter& MessageWriter::numbers(std::string_view key, std::span<const double> values, NumberFormat format) {
  out_ += " {";
  append_text(out_, key);
  out_ += ' ';
  append_numbers(out_, values, format);
  return close_group();
}

MessageWriter& MessageWriter::open_group(std::string_view key, std::string_view value) {
  out_ += " {";
  append_text(out_, key);
  if (!value.empty()) out_ += ' ';
  append_text(out_, value);
  return *this;
}

MessageWriter& MessageWriter::add_text(std::string_view key, std::string_view value) {
  out_ += ' ';
  append_text(out_, key);
  out_ += ' ';
  append_text(out_, value);
  return *this;
}

MessageWriter& MessageWriter::add_number(std::string_view key, double value, NumberFormat format) {
  return add_numbers(key, {&value, 1}, format);
}

MessageWriter& MessageWriter::add_integer(std::string_view key, std::int64_t value) {
  out_ += ' ';
  append_text(out_, key);
  out_ += ' ';
  append_integer(out_, value);
  return *this;
}

MessageWriter& MessageWriter::add_numbers(std::string_view key, std::span<const double> values, NumberFormat format) {
  out_ += ' ';
  append_text(out_, key);
  out_ += ' ';
  append_numbers(out_, values, format);
  return *this;
}

MessageWriter& MessageWriter::close_group() {
  out_ += '}';
  return *this;
}

void MessageWriter::end() {
  out_ += "\r\n";
}

void append_number(std::string& out, double value, NumberFormat format) {
  if (!std::isfinite(value)) value = 0;
  const int decimals = std::clamp(format.decimals, 0, 17);
  std::array<char, 400> digits;  // the longest double without exponent has 309 digits before the point
  char* const first = digits.data();
  char* last = nullptr;
  if (format.truncate) {
    // Cut the shortest decimal that reads back as `value`: cutting the exact one would make 0.28 of 0.29.
    last = std::to_chars(first, first + digits.size(), value, std::chars_format::fixed).ptr;
    char* point = std::find(first, last, '.');
    last = std::min(last, decimals > 0 ? point + 1 + decimals : point);
  } else {
    last = std::to_chars(first, first + digits.size(), value, std::chars_format::fixed, decimals).ptr;
  }

  // No negative zero; a truncated number is filled up with zeros.
  const std::string_view text(first, static_cast<std::size_t>(last - first));
  const bool negative_zero = text.starts_with('-') && text.find_first_not_of("-0.") == std::string_view::npos;
  out += negative_zero ? text.substr(1) : text;
  if (!format.truncate || decimals == 0) return;
  const std::size_t point = text.find('.');
  const std::size_t written = point == std::string_view::npos ? 0 : text.size() - point - 1;
  if (point == std::string_view::npos) out += '.';
  out.append(static_cast<std::size_t>(decimals) - written, '0');
}

}  // namespace kenaf::protocol::usarsim
