#include "gap/recordings/survey.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "gap/logs/median.hpp"
#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::uint64_t kMessagesOfTopic = 200;  // chosen

// A topic as it is seen while the recording is visited.
class TopicSurvey {
 public:
  TopicSurvey(const Topic& topic, const DefinitionTexts& definitions, double duration_s) {
    result_.topic = topic;
    if (duration_s > 0) result_.rate_hz = static_cast<double>(topic.count) / duration_s;
    try {
      reader_.emplace(topic, definitions);
    } catch (const RecordingError& error) {
      result_.not_understood = error.what();
    }
  }

  bool wants_more() const { return reader_ && seen_ < kMessagesOfTopic && seen_ < result_.topic.count; }

  void take(const Message& message) {
    if (!reader_ || seen_ >= kMessagesOfTopic) return;
    ++seen_;
    std::optional<std::int64_t> stamp_ns;
    try {
      reader_->list(message.bytes, [&](const std::string& path, const FieldValue& field) {
        take_value(path, field.value);
        if (field.stamp_ns.value_or(0) != 0) stamp_ns = field.stamp_ns;
      });
    } catch (const RecordingError& error) {
      if (result_.not_understood.empty()) result_.not_understood = error.what();
    }
    if (stamp_ns) lags_s_.push_back(1e-9 * (static_cast<double>(message.log_ns) - static_cast<double>(*stamp_ns)));
  }

  SurveyedTopic finish() {
    if (!lags_s_.empty()) result_.log_after_stamp_s = logs::upper_median(lags_s_);
    if (!result_.signals.empty()) result_.not_understood.clear();
    return std::move(result_);
  }

 private:
  void take_value(const std::string& path, double value) {
    auto place = places_.find(path);
    if (place == places_.end()) {
      place = places_.emplace(path, result_.signals.size()).first;
      result_.signals.push_back({result_.topic.name + "/" + path, path, INFINITY, -INFINITY});
    }
    Signal& signal = result_.signals[place->second];
    signal.least = std::fmin(signal.least, value);
    signal.most = std::fmax(signal.most, value);
  }

  SurveyedTopic result_;
  std::optional<MessageReader> reader_;
  std::uint64_t seen_ = 0;
  std::map<std::string, std::size_t> places_;  // of signals, by path
  std::vector<double> lags_s_;
};

}  // namespace

Survey survey(const Recording& recording, const DefinitionTexts& definitions, const TellProgress& tell) {
  Survey survey{recording.form, 0, {}, "", "", {}, recording.remarks};
  survey.duration_s = 1e-9 * (static_cast<double>(recording.last_ns) - static_cast<double>(recording.first_ns));
  std::vector<TopicSurvey> topics;
  for (const Topic& topic : recording.topics) topics.emplace_back(topic, definitions, survey.duration_s);
  std::uint64_t visited = 0;
  const auto remarks = recording.visit(
      [&](const Message& message) {
        topics[message.topic].take(message);
        // whether all is seen need not be asked at each message
        return ++visited % 256 != 0 || std::ranges::any_of(topics, &TopicSurvey::wants_more);
      },
      tell);
  survey.remarks.insert(survey.remarks.end(), remarks.begin(), remarks.end());
  for (TopicSurvey& topic : topics) survey.topics.push_back(topic.finish());
  return survey;
}

Survey survey(const Table& table) {
  Survey survey{table.form, 0, {}, table.time_column, table.time_unit, table.poses, table.remarks};
  const std::span<const double> times = table.column(table.time_column);
  const double unit_s = seconds_of_time_unit(table.time_unit).value_or(1);
  if (!times.empty()) survey.duration_s = unit_s * (times.back() - times.front());
  SurveyedTopic all;
  all.topic.count = table.row_count();
  if (survey.duration_s > 0) all.rate_hz = static_cast<double>(table.row_count()) / survey.duration_s;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i] == table.time_column) continue;
    Signal signal{table.columns[i], table.columns[i], INFINITY, -INFINITY};
    for (const double value : table.values[i]) {
      signal.least = std::fmin(signal.least, value);
      signal.most = std::fmax(signal.most, value);
    }
    all.signals.push_back(std::move(signal));
  }
  survey.topics.push_back(std::move(all));
  return survey;
}

}  // namespace kenaf::gap::recordings
