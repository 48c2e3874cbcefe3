#include "gap/recordings/samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "gap/logs/median.hpp"
#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kJitter_s = 1, kStepsOfJitter = 3;  // the larger one is the longest step back of jitter; chosen

// A source whose samples are being gathered.
struct Gathering {
  Source source;
  Samples samples;
  std::uint64_t failed = 0;
  std::string first_reason;

  void fail(const std::string& reason) {
    if (failed++ == 0) first_reason = reason;
  }
};

// A topic that has sources.
struct UsedTopic {
  MessageReader reader;
  std::vector<FieldPath> paths{};
  std::vector<std::size_t> gatherings{};  // of the paths
};

[[noreturn]] void fail_from(const std::string& from, const std::string& why) {
  throw RecordingError(fmt::format("the mapping's source '{}': {}", from, why));
}

// "/a, /b and 3 more"
std::string some_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
  return text;
}

// Whether `from` is a path of this topic: "/cmd_vel/linear.x" of "/cmd_vel".
bool is_of_topic(const std::string& from, const std::string& topic) {
  return from.size() > topic.size() + 1 && from.starts_with(topic) && from[topic.size()] == '/';
}

// Where times go back, in the order in which they were recorded.
struct StepsBack {
  std::size_t count = 0;
  std::size_t largest = 0;  // the place of the one after the largest
  double from_s = 0, to_s = 0;
  double longest_jitter_s = 0;  // a longer one is no jitter

  bool are_jitter() const { return from_s - to_s <= longest_jitter_s; }
};

StepsBack steps_back(std::span<const double> t_s) {
  StepsBack back;
  std::vector<double> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double step_s = t_s[i] - t_s[i - 1];
    steps.push_back(std::abs(step_s));
    if (step_s >= 0) continue;
    ++back.count;
    if (t_s[i - 1] - t_s[i] > back.from_s - back.to_s) back.largest = i, back.from_s = t_s[i - 1], back.to_s = t_s[i];
  }
  if (back.count > 0) back.longest_jitter_s = std::max(kJitter_s, kStepsOfJitter * logs::upper_median(steps));
  return back;
}

// Refuses times that go back far: two drives sorted into each other are neither.
void check_goes_on(const StepsBack& back, const std::string& whose, const std::string& where, const char* what_to_do) {
  if (back.count == 0 || back.are_jitter()) return;
  throw RecordingError(
      fmt::format("{} goes back from {:.3f} to {:.3f} s{}: several drives, or a clock that was set "
                  "back? {}",
                  whose, back.from_s, back.to_s, where, what_to_do));
}

// Sorts by time, and keeps of values of one time the last.
void put_in_order(Samples& samples) {
  std::vector<std::size_t> order(samples.t_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::ranges::is_sorted(samples.t_s)) {
    std::ranges::stable_sort(order, {}, [&samples](std::size_t i) { return samples.t_s[i]; });
  }
  Samples sorted;
  for (const std::size_t i : order) {
    if (!sorted.t_s.empty() && samples.t_s[i] <= sorted.t_s.back()) {
      sorted.value.back() = samples.value[i];
      continue;
    }
    sorted.t_s.push_back(samples.t_s[i]);
    sorted.value.push_back(samples.value[i]);
  }
  samples = std::move(sorted);
}

// Gathers samples and refuses more than memory is to hold.
class Gatherer {
 public:
  void add(Gathering& gathering, double t_s, double value) {
    if (!std::isfinite(value) || !std::isfinite(t_s)) return gathering.fail("no finite number");
    if (++count_ > kMostSamples) return;  // check() tells
    gathering.samples.t_s.push_back(t_s);
    gathering.samples.value.push_back(value);
  }
  void check() const {
    if (count_ > kMostSamples)
      throw RecordingError(
          fmt::format("more than {} values; take a part of the recording with --from and --to", kMostSamples));
  }
  static void finish(std::vector<Gathering>& gatherings, Collected& collected) {
    for (Gathering& gathering : gatherings) {
      const StepsBack back = steps_back(gathering.samples.t_s);
      check_goes_on(back, fmt::format("{}: its time", gathering.source.from), "",
                    "Cut the recording, take one drive with --from and --to, or give the entry time = \"log\"");
      const std::size_t before = gathering.samples.t_s.size();
      put_in_order(gathering.samples);
      const std::size_t same = before - gathering.samples.t_s.size();
      std::string remark;
      if (same > 0) remark = fmt::format("{} values have the time of another and are left out", same);
      if (back.count > 0)
        remark += fmt::format("{}{} values come before the one before them, by up to {:.3g} s, and are sorted",
                              remark.empty() ? "" : "; ", back.count, back.from_s - back.to_s);
      if (!remark.empty()) collected.remarks.push_back(gathering.source.from + ": " + remark);
      if (gathering.failed > 0)
        collected.not_understood.push_back({gathering.source.from, gathering.failed, gathering.first_reason});
      collected.samples[gathering.source] = std::move(gathering.samples);
    }
  }

 private:
  std::size_t count_ = 0;
};

class RecordingCollector {
 public:
  RecordingCollector(const Recording& recording, std::span<const Source> sources, const CollectOptions& options)
      : recording_(recording), options_(options), seen_(recording.topics.size(), 0) {
    for (const Source& source : sources) add(source);
  }

  Collected run(const TellProgress& tell) {
    Collected collected;
    collected.remarks = recording_.remarks;
    const auto visited = recording_.visit([this](const Message& message) { return take(message); }, tell);
    collected.remarks.insert(collected.remarks.end(), visited.begin(), visited.end());
    Gatherer::finish(gatherings_, collected);
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const Topic& topic = recording_.topics[i];
      (used_.contains(i) ? collected.used : collected.unused).push_back({topic.name, topic.type, seen_[i]});
    }
    return collected;
  }

 private:
  // Finds the topic of a source: of several whose name fits, the one with the longest, and a type that has the path.
  void add(const Source& source) {
    std::string why;
    std::size_t longest = 0;
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < recording_.topics.size(); ++i) {
      const Topic& topic = recording_.topics[i];
      if (!is_of_topic(source.from, topic.name) || topic.name.size() < longest) continue;
      if (best && topic.name.size() == longest) continue;
      longest = topic.name.size();
      const std::string wrong = wrong_with(i, source.from.substr(longest + 1));
      best = wrong.empty() ? std::optional(i) : std::nullopt;
      if (!wrong.empty()) why = wrong;
    }
    if (!best) fail_from(source.from, why.empty() ? "no such topic; the recording has " + topics() : why);
    used_.at(*best).paths.push_back(parse_field_path(source.from.substr(longest + 1)));
    used_.at(*best).gatherings.push_back(gatherings_.size());
    gatherings_.push_back({source, {}, 0, {}});
  }

  // Why the topic has no number at `path`. Makes the topic's reader.
  std::string wrong_with(std::size_t topic, const std::string& path) {
    try {
      if (!used_.contains(topic))
        used_.emplace(topic, UsedTopic{MessageReader(recording_.topics[topic], options_.definitions)});
      return used_.at(topic).reader.wrong_with(parse_field_path(path));
    } catch (const RecordingError& error) {
      return error.what();
    }
  }

  std::string topics() const {
    std::vector<std::string> names;
    for (const Topic& topic : recording_.topics) names.push_back(topic.name);
    return some_names(names);
  }

  bool take(const Message& message) {
    const double log_s = since_begin(message.log_ns);
    if (log_s < options_.from_s || log_s > options_.to_s) return log_s <= options_.to_s;
    ++seen_[message.topic];
    const auto used = used_.find(message.topic);
    if (used == used_.end()) return true;
    take_values(used->second, message, log_s);
    gatherer_.check();
    return true;
  }

  void take_values(const UsedTopic& topic, const Message& message, double log_s) {
    std::size_t taken = 0;
    try {
      topic.reader.find(message.bytes, topic.paths, [&](std::size_t i, const std::optional<FieldValue>& field) {
        take_value(gatherings_[topic.gatherings[i]], field, log_s);
        taken = i + 1;
      });
    } catch (const RecordingError& error) {
      for (; taken < topic.gatherings.size(); ++taken) gatherings_[topic.gatherings[taken]].fail(error.what());
    }
  }

  void take_value(Gathering& gathering, const std::optional<FieldValue>& field, double log_s) {
    if (!field) return gathering.fail("the message has no such element");
    const bool stamped = gathering.source.time == TimeFrom::header && field->stamp_ns.value_or(0) != 0;
    gatherer_.add(gathering, stamped ? since_begin(*field->stamp_ns) : log_s, field->value);
  }

  double since_begin(std::int64_t time_ns) const {
    // Both are counts since 1970 or since zero: their difference fits.
    const auto difference = static_cast<double>(time_ns) - static_cast<double>(recording_.first_ns);
    const bool is_near = std::abs(difference) < 1e18;
    return is_near ? 1e-9 * static_cast<double>(time_ns - recording_.first_ns) : 1e-9 * difference;
  }

  const Recording& recording_;
  const CollectOptions& options_;
  std::map<std::size_t, UsedTopic> used_;  // by topic
  std::vector<Gathering> gatherings_;
  std::vector<std::uint64_t> seen_;  // messages by topic
  Gatherer gatherer_;
};

std::span<const double> needed_column(const Table& table, const std::string& name) {
  if (std::ranges::find(table.columns, name) == table.columns.end())
    fail_from(name, "no such column; the table has " + some_names(table.columns));
  return table.column(name);
}

}  // namespace

Collected collect(const Recording& recording, std::span<const Source> sources, const CollectOptions& options,
                  const TellProgress& tell) {
  return RecordingCollector(recording, sources, options).run(tell);
}

Collected collect(const Table& table, std::span<const Source> sources, const std::string& time_column,
                  double time_unit_s, const CollectOptions& options) {
  // Times count from the first row that has one.
  const std::span<const double> times = needed_column(table, time_column);
  const auto first = std::ranges::find_if(times, [](double t) { return std::isfinite(t); });
  const double begin = first == times.end() ? 0 : *first;
  Collected collected;
  collected.remarks = table.remarks;

  // The clock of the rows that count, in the order of the file.
  std::vector<double> rows_s;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < times.size(); ++row) {
    const double t_s = time_unit_s * (times[row] - begin);
    if (!std::isfinite(t_s) || t_s < options.from_s || t_s > options.to_s) continue;
    rows_s.push_back(t_s);
    rows.push_back(row + 1);
  }
  const StepsBack back = steps_back(rows_s);
  check_goes_on(back, time_column, back.count > 0 ? fmt::format(" in row {} of the table", rows[back.largest]) : "",
                "Cut the file into one for each drive, or take one with --from and --to");

  // The cells of each source that hold a number within the wanted time.
  Gatherer gatherer;
  std::vector<Gathering> gatherings;
  for (const Source& source : sources) {
    const std::span<const double> values = needed_column(table, source.from);
    Gathering gathering{source, {}, 0, {}};
    for (std::size_t row = 0; row < values.size(); ++row) {
      const double t_s = time_unit_s * (times[row] - begin);
      if (t_s < options.from_s || t_s > options.to_s || std::isnan(values[row])) continue;
      gatherer.add(gathering, t_s, values[row]);
    }
    gatherer.check();
    gatherings.push_back(std::move(gathering));
  }
  Gatherer::finish(gatherings, collected);

  // Every column is listed as used or not, with the count of its numbers.
  for (const std::string& name : table.columns) {
    const auto is_it = [&name](const Source& source) { return source.from == name; };
    const auto count = static_cast<std::uint64_t>(
        std::ranges::count_if(table.column(name), [](double value) { return !std::isnan(value); }));
    const bool used = name == time_column || std::ranges::any_of(sources, is_it);
    (used ? collected.used : collected.unused).push_back({name, "", count});
  }
  return collected;
}

}  // namespace kenaf::gap::recordings
