#include "gap/recordings/iso_date.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string>

#include "formats/runs/csv_cells.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kSecondsPerDay = 86400;

template <class Number>
bool take_number(std::string_view& text, std::size_t digits, Number& number) {
  if (text.size() < digits) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, number);
  if (error != std::errc{} || end != text.data() + digits) return false;
  text.remove_prefix(digits);
  return true;
}

bool take_mark(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == any_of.npos) return false;
  text.remove_prefix(1);
  return true;
}

// "", "Z" or "+02:00", in seconds.
std::optional<double> offset_of_date(std::string_view text) {
  if (text.empty() || text == "Z") return 0;
  const double sign = text[0] == '-' ? -1 : 1;
  unsigned hours = 0, minutes = 0;
  if (!take_mark(text, "+-") || !take_number(text, 2, hours)) return std::nullopt;
  take_mark(text, ":");
  if (!take_number(text, 2, minutes) || !text.empty()) return std::nullopt;
  return sign * (3600.0 * hours + 60.0 * minutes);
}

}  // namespace

std::optional<double> seconds_of_date(std::string_view text) {
  int year = 0;
  unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (!take_number(text, 4, year) || !take_mark(text, "-") || !take_number(text, 2, month) || !take_mark(text, "-") ||
      !take_number(text, 2, day) || !take_mark(text, " T") || !take_number(text, 2, hour) || !take_mark(text, ":") ||
      !take_number(text, 2, minute) || !take_mark(text, ":") || !take_number(text, 2, second))
    return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  double fraction = 0;
  if (text.starts_with('.')) {
    const std::size_t end = std::min(text.size(), text.find_first_not_of("0123456789", 1));
    fraction = runs::DecimalNumbers().read("0" + std::string(text.substr(0, end))).value_or(0);
    text.remove_prefix(end);
  }
  const std::optional<double> offset_s = offset_of_date(text);
  if (!offset_s) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(days) * kSecondsPerDay + 3600.0 * hour + 60.0 * minute + second + fraction - *offset_s;
}

}  // namespace kenaf::gap::recordings
