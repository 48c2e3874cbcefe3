#include "gap/diagnose/run_gap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/report_words.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double kWorse = 0.1;  // of the nominal gap and of the noise: smaller increases are chance

double end_of(const runs::Run& run) {
  const std::span<const double> time = run.column("t_s");
  return time.empty() ? 0 : time.back() - time.front();
}

// So many digits that a tenth of the noise shows, of a value and of what it differs from alike.
std::string with_digits_of(double value, double noise) {
  const int digits = noise > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(noise))), 0, 6) : 3;
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.find_first_of("123456789") == std::string::npos && text.starts_with('-') ? text.substr(1) : text;
}

ComparedRun compare(const Diagnosis& d, std::size_t run, const runs::Run& nominal,
                    const std::optional<runs::Run>& corrected, const std::map<std::string, Floor>& floors) {
  const double end_s = end_of(d.observations.runs[run].run);
  ComparedRun compared{run, gap_of_run(d.features.maps[run], end_s, nominal, floors), {}};
  if (corrected) compared.corrected = gap_of_run(d.features.maps[run], end_s, *corrected, floors);
  return compared;
}

}  // namespace

std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise,
                                       const std::map<std::string, double>& reported) {
  std::map<std::string, Floor> floors;
  for (const Channel& channel : diagnosis_channels()) {
    const std::string column(channel.column);
    Floor floor{channel.resolution, FloorFrom::resolution};
    if (const auto noise = stated_noise.find(column); noise != stated_noise.end() && noise->second > floor.value)
      floor = {noise->second, FloorFrom::stated_noise};
    if (const auto known = reported.find(column); known != reported.end()) floor = {known->second, FloorFrom::report};
    floors[column] = floor;
  }
  return floors;
}

std::map<std::string, Floor> floors_of(const Diagnosis& d) {
  std::map<std::string, double> reported;
  for (const StageDiagnosis& stage : d.stages)
    for (const ChannelGap& gap : stage.where.channels)
      if (gap.floor > 0 && std::isfinite(gap.floor))
        reported.try_emplace(std::string(diagnosis_channels()[gap.channel].column), gap.floor);
  return floors_of(d.observations.dataset.noise, reported);
}

Eigen::VectorXd noise_of_bins(const FeatureMap& map, const std::map<std::string, Floor>& floors) {
  std::map<std::size_t, std::size_t> full;  // samples of the fullest bin, by channel
  for (const Bin& bin : map.bins()) full[bin.channel] = std::max(full[bin.channel], bin.samples);
  Eigen::VectorXd noise(static_cast<Eigen::Index>(map.bins().size()));
  for (std::size_t b = 0; b < map.bins().size(); ++b) {
    const Bin& bin = map.bins()[b];
    const double floor = floors.at(std::string(diagnosis_channels()[bin.channel].column)).value;
    noise[static_cast<Eigen::Index>(b)] =
        floor * std::sqrt(static_cast<double>(full[bin.channel]) / static_cast<double>(bin.samples));
  }
  return noise;
}

RunGap gap_of_run(const FeatureMap& map, double end_s, const runs::Run& simulated,
                  const std::map<std::string, Floor>& floors) {
  RunGap gap;
  gap.span_s = map.span_s();
  const Eigen::VectorXd of_simulated = map.of(simulated), noise = noise_of_bins(map, floors);
  std::size_t spans = 0;
  for (const Bin& bin : map.bins()) spans = std::max(spans, bin.span + 1);

  // the course of each channel that both have, bins of one channel being neighbours
  std::vector<std::vector<ChannelMoment>> of_span(spans);
  double squares_of_all = 0;
  std::size_t count_of_all = 0;
  for (std::size_t b = 0; b < map.bins().size();) {
    const std::size_t channel = map.bins()[b].channel;
    const bool both = runs::any_measured(simulated.column(diagnosis_channels()[channel].column));
    ChannelCourse course{channel, std::vector<double>(spans, kNotMeasured), std::vector<double>(spans, kNotMeasured),
                         0};
    double squares = 0;
    std::size_t count = 0;
    for (; b < map.bins().size() && map.bins()[b].channel == channel; ++b) {
      if (!both) continue;
      const auto i = static_cast<Eigen::Index>(b);
      const std::size_t span = map.bins()[b].span;
      const double difference = map.measured()[i] - of_simulated[i], times = difference / noise[i];
      course.difference[span] = difference;
      course.times_noise[span] = times;
      of_span[span].push_back({channel, map.measured()[i], of_simulated[i], std::abs(times)});
      squares += times * times;
      ++count;
    }
    if (count == 0) continue;
    course.rms = std::sqrt(squares / static_cast<double>(count));
    squares_of_all += squares;
    count_of_all += count;
    gap.channels.push_back(std::move(course));
  }
  if (count_of_all > 0) gap.rms = std::sqrt(squares_of_all / static_cast<double>(count_of_all));

  // all channels together in each span
  for (std::size_t s = 0; s < spans; ++s) {
    if (of_span[s].empty()) continue;
    double squares = 0;
    for (const ChannelMoment& one : of_span[s]) squares += one.times_noise * one.times_noise;
    std::ranges::stable_sort(of_span[s], std::ranges::greater{}, &ChannelMoment::times_noise);
    gap.moments.push_back({std::min((static_cast<double>(s) + 0.5) * gap.span_s, end_s),
                           std::sqrt(squares / static_cast<double>(of_span[s].size())), std::move(of_span[s])});
    const RunMoment& moment = gap.moments.back();
    if (!gap.worst || moment.times_noise > gap.moments[*gap.worst].times_noise) gap.worst = gap.moments.size() - 1;
  }
  return gap;
}

std::vector<ComparedRun> drawn_runs(const Diagnosis& d, std::span<const Overlay> overlays) {
  const std::map<std::string, Floor> floors = floors_of(d);
  std::vector<ComparedRun> compared;
  for (const Overlay& overlay : overlays)
    if (overlay.run < d.features.maps.size())
      compared.push_back(compare(d, overlay.run, overlay.nominal, overlay.corrected, floors));
  std::ranges::sort(compared, {}, &ComparedRun::run);
  return compared;
}

std::vector<ComparedRun> compared_runs(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::vector<ComparedRun> compared = drawn_runs(d, overlays);
  std::vector<std::size_t> others;
  for (std::size_t r = 0; r < d.features.maps.size(); ++r)
    if (!d.repeats.empty() && d.observations.runs[r].world < d.observations.worlds.size() &&
        !std::ranges::binary_search(compared, r, {}, &ComparedRun::run))
      others.push_back(r);
  if (others.empty()) return compared;

  const std::map<std::string, Floor> floors = floors_of(d);
  const Predictor predictor(d.observations, d.features, d.repeats, 1);
  const std::optional<Variation> corrected = corrected_robot(d, predictor);
  const std::size_t drawn = compared.size();
  compared.resize(drawn + others.size());
  for_each_job(others.size(), d.options.jobs, [&](std::size_t i) {
    const runs::Run nominal = predictor.simulate(others[i], predictor.unvaried());
    const std::optional<runs::Run> after =
        corrected ? std::optional(predictor.simulate(others[i], *corrected)) : std::nullopt;
    compared[drawn + i] = compare(d, others[i], nominal, after, floors);
  });
  std::ranges::sort(compared, {}, &ComparedRun::run);
  return compared;
}

const ComparedRun* worst_run(std::span<const ComparedRun> runs) {
  const ComparedRun* worst = nullptr;
  for (const ComparedRun& run : runs) {
    const RunMoment* moment = run.nominal.worst_moment();
    if (moment && (!worst || moment->times_noise > worst->nominal.worst_moment()->times_noise)) worst = &run;
  }
  return worst;
}

std::vector<const ComparedRun*> worsened_runs(std::span<const ComparedRun> runs) {
  const auto increase = [](const ComparedRun* run) { return run->corrected->rms - run->nominal.rms; };
  std::vector<const ComparedRun*> worsened;
  for (const ComparedRun& run : runs)
    if (run.corrected && increase(&run) > kWorse * std::max(1.0, run.nominal.rms)) worsened.push_back(&run);
  std::ranges::stable_sort(worsened, std::ranges::greater{}, increase);
  return worsened;
}

std::string time_in_words(double t_s) {
  constexpr double kRoundsHalfUp = 1e-9;
  return fmt::format("{:.2f} s", t_s + kRoundsHalfUp);
}

std::string times_noise_in_words(double times) {
  return fmt::format("{:.{}f} \u00d7 noise", times, times < 9.95 ? 1 : 0);
}

std::string in_words(const ChannelMoment& moment) {
  const Channel& channel = diagnosis_channels()[moment.channel];
  const double noise = moment.times_noise > 0 ? std::abs(moment.difference()) / moment.times_noise : 0;
  const auto value = [&](double v) { return with_digits_of(v, noise) + unit_suffix(channel.unit); };
  return fmt::format("{}: measured {}, simulated {}, difference {} ({})", channel.column, value(moment.measured),
                     value(moment.simulated), value(moment.difference()), times_noise_in_words(moment.times_noise));
}

}  // namespace kenaf::gap::diagnose
