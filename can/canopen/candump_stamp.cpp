#include "can/canopen/candump_stamp.hpp"

#include <fmt/format.h>

#include "can/canopen/text_fields.hpp"

namespace kenaf::canopen {
namespace {

constexpr std::size_t kShortDigits = 3, kLongestShort = 9;

// The numbers of "2015-07-10", whose parts have these widths.
template <std::size_t N>
std::optional<std::array<unsigned, N>> parts_of(std::string_view text, const std::array<std::size_t, N>& widths,
                                                char separator) {
  std::array<unsigned, N> parts{};
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) {
      if (text.empty() || text.front() != separator) return std::nullopt;
      text.remove_prefix(1);
    }
    const auto part = text.size() < widths[i] ? std::nullopt : text::decimal(text.substr(0, widths[i]));
    if (!part) return std::nullopt;
    parts[i] = *part;
    text.remove_prefix(widths[i]);
  }
  if (!text.empty()) return std::nullopt;
  return parts;
}

// "2015-07-10 06:17:32.249713"
std::optional<Time> calendar_time(std::string_view date_and_time) {
  const std::size_t blank = date_and_time.find(' '), point = date_and_time.find('.');
  if (blank == std::string_view::npos || point == std::string_view::npos || point < blank) return std::nullopt;
  const auto date = parts_of<3>(date_and_time.substr(0, blank), {4, 2, 2}, '-');
  const auto clock = parts_of<3>(date_and_time.substr(blank + 1, point - blank - 1), {2, 2, 2}, ':');
  const auto fraction = text::time_of(fmt::format("0{}", date_and_time.substr(point)));
  if (!date || !clock || !fraction) return std::nullopt;

  // A leap second is 60. Years beyond 2261 do not fit in 64-bit nanoseconds.
  const std::chrono::year_month_day day{std::chrono::year(static_cast<int>((*date)[0])), std::chrono::month((*date)[1]),
                                        std::chrono::day((*date)[2])};
  if (!day.ok() || (*date)[0] < 1970 || (*date)[0] > 2261) return std::nullopt;
  if ((*clock)[0] > 23 || (*clock)[1] > 59 || (*clock)[2] > 60) return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch() + std::chrono::hours((*clock)[0]) +
         std::chrono::minutes((*clock)[1]) + std::chrono::seconds((*clock)[2]) + *fraction;
}

// As printf's %03u writes the seconds: a zero in front only where there would be fewer than three digits.
bool is_short(std::string_view number) {
  const std::size_t digits = number.find('.');
  return digits == kShortDigits || (digits > kShortDigits && digits <= kLongestShort && number.front() != '0');
}

}  // namespace

CandumpStamp take_candump_stamp(std::string_view& line) {
  line = text::trimmed(line);
  if (line.empty() || line.front() != '(') return {};
  const std::size_t end = line.find(')');
  const std::string_view inside = line.substr(1, end == std::string_view::npos ? end : end - 1);
  const auto time = text::time_of(inside), calendar = calendar_time(inside);
  if (end == std::string_view::npos || (!time && !calendar)) {
    throw BadLogLine(fmt::format("{} is not a time such as (1436509052.249713)",
                                 text::quoted(end == std::string_view::npos ? line : line.substr(0, end + 1))));
  }
  line = text::trimmed(line.substr(end + 1));
  if (calendar) return {*calendar, Stamp::time};
  return {*time, is_short(inside) ? Stamp::short_seconds : Stamp::time};
}

}  // namespace kenaf::canopen
