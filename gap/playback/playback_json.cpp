#include <algorithm>
#include <string_view>

#include "gap/diagnose/channels.hpp"
#include "gap/playback/playback.hpp"
#include "server/live/json_writer.hpp"

namespace kenaf::gap::playback {
namespace {

using live::JsonWriter;

constexpr int kDigits = 4, kFloorDigits = 6;

std::string_view column_of(std::size_t channel) {
  return diagnose::diagnosis_channels()[channel].column;
}

void write_texts(JsonWriter& out, std::string_view key, const std::vector<std::string>& texts) {
  out.key(key).open('[');
  for (const std::string& text : texts) out.comma().text(text);
  out.close(']');
}

std::string_view pose_from_name(PoseFrom from) {
  switch (from) {
    case PoseFrom::measured:
      return "measured";
    case PoseFrom::dead_reckoning:
      return "dead reckoning";
    case PoseFrom::nothing:
      break;
  }
  return "nothing";
}

void write_body(JsonWriter& out, const PlayedBody& body) {
  out.comma().open('{').key("kind").text(body.kind).key("pose_from").text(pose_from_name(body.pose_from));
  if (body.pose_from != PoseFrom::nothing) {
    constexpr std::string_view kPlaces[] = {"x", "y", "z"}, kTurns[] = {"roll", "pitch", "yaw"};
    out.key("pose").open('{');
    for (std::size_t i = 0; i < 3; ++i) out.key(kPlaces[i]).numbers(body.p_WB_m[i], kDigits);
    for (std::size_t i = 0; i < 3; ++i) out.key(kTurns[i]).numbers(body.angles_rad[i], kDigits);
    out.close('}');
  }
  out.key("flipper").open('[');
  for (const std::vector<double>& angles : body.flipper_rad) out.comma().numbers(angles, 3);
  out.close(']').key("track_m").open('[');
  for (const std::vector<double>& travel : body.track_m) out.comma().numbers(travel, 3);
  out.close(']').key("channels").open('{');
  for (const auto& [column, values] : body.channels) out.key(column).numbers(values, kDigits);
  out.close('}').close('}');
}

// Columns that can be drawn, with their units and, if a report has it, their share of the gap.
void write_channels(JsonWriter& out, const Playback& playback, const PlayedRun& played) {
  out.key("channels").open('[');
  for (const diagnose::Channel& channel : diagnose::diagnosis_channels()) {
    const std::string column(channel.column);
    if (std::ranges::none_of(played.bodies, [&](const PlayedBody& body) { return body.channels.contains(column); }))
      continue;
    out.comma().open('{').key("column").text(column).key("unit").text(channel.unit);
    out.key("wraps").boolean(channel.angle);
    const Floor& floor = playback.floors.at(column);
    out.key("floor").number(floor.value, kFloorDigits).key("floor_from").text(floor_name(floor.from));
    if (playback.report) {
      const auto share = playback.report->channel_share.find(column);
      if (share != playback.report->channel_share.end()) out.key("share").number(share->second);
    }
    out.close('}');
  }
  out.close(']');
}

void write_worst(JsonWriter& out, const diagnose::RunMoment& worst) {
  const diagnose::ChannelMoment& most = worst.channels.front();
  out.open('{').key("t_s").number(worst.at_s, kDigits).key("floors").number(worst.times_noise);
  out.key("column").text(column_of(most.channel));
  out.key("recorded").number(most.measured, kFloorDigits).key("simulated").number(most.simulated, kFloorDigits);
  out.key("difference").number(most.difference(), kFloorDigits);
  out.key("difference_floors").number(most.times_noise).close('}');
}

// What the simulations differ by, in means over spans, and where each is worst.
void write_gaps(JsonWriter& out, const PlayedRun& played) {
  out.key("gaps").open('[');
  for (std::size_t i = 0; i < played.gaps.size(); ++i) {
    const diagnose::RunGap& gap = played.gaps[i];
    out.comma().open('{').key("kind").text(played.bodies[i + 1].kind).key("span_s").number(kSpan_s);
    out.key("differences").open('{');
    for (const diagnose::ChannelCourse& course : gap.channels)
      out.key(column_of(course.channel)).numbers(course.difference, kFloorDigits);
    out.close('}').key("difference_floors").open('{');
    for (const diagnose::ChannelCourse& course : gap.channels)
      out.key(column_of(course.channel)).numbers(course.times_noise, 3);
    out.close('}').key("floors").open('{');
    for (const diagnose::ChannelCourse& course : gap.channels) out.key(column_of(course.channel)).number(course.rms);
    out.close('}').key("worst");
    if (gap.worst)
      write_worst(out, *gap.worst_moment());
    else
      out.raw("null");
    out.close('}');
  }
  out.close(']');
}

}  // namespace

std::string playback_json(const Playback& playback) {
  // One object with the keys in the order of playback.hpp.
  JsonWriter out;
  out.open('{').key("format").text("kenaf-playback/2").key("name").text(playback.name);
  out.key("source").text(playback.source).key("first").integer(playback.first);
  out.key("at_s").number(playback.at_s, kDigits);
  out.key("robot").open('{').key("name").text(playback.robots.nominal.name);
  live::write_dimensions(out, physics::dimensions_of(playback.robots.nominal));
  out.close('}').key("corrected").boolean(playback.robots.corrected.has_value());
  out.key("report");
  if (playback.report) {
    out.open('{').key("verdict").text(playback.report->verdict);
    write_texts(out, "named", playback.report->named);
    out.key("stage").text(playback.report->stage);
    double largest = 0;
    for (const ReportedPhase& phase : playback.report->phases) largest = std::max(largest, phase.share);
    out.key("largest_share").number(largest, kDigits);
    out.close('}');
  } else {
    out.raw("null");
  }
  out.key("runs").open('[');
  for (const ListedRun& run : playback.runs) {
    out.comma().open('{').key("file").text(run.entry.file).key("manoeuvre").text(run.entry.manoeuvre);
    out.key("world").text(run.world_name).key("rows").integer(run.rows);
    out.key("duration_s").number(run.duration_s, kDigits);
    if (playback.report) {
      double share = 0;
      for (const ReportedPhase& phase : reported_phases_of(playback, run)) share += phase.share;
      out.key("share").number(share, kDigits);
      const auto worst = playback.report->worst_of_run.find(run.entry.file);
      if (worst != playback.report->worst_of_run.end())
        out.key("worst")
            .open('{')
            .key("t_s")
            .number(worst->second.at_s, kDigits)
            .key("floors")
            .number(worst->second.times_noise)
            .close('}');
    }
    out.close('}');
  }
  out.close(']');
  write_texts(out, "notes", playback.notes);
  return out.close('}').take();
}

std::string played_run_json(const Playback& playback, std::size_t index, const PlayedRun& played) {
  // One object with the keys in the order of playback.hpp.
  const ListedRun& listed = playback.runs.at(index);
  JsonWriter out;
  out.open('{').key("file").text(played.entry.file).key("manoeuvre").text(played.entry.manoeuvre);
  out.key("world").text(listed.world_name).key("rows").integer(played.rows);
  out.key("t_s").numbers(played.times_s, kDigits);
  out.key("bodies").open('[');
  for (const PlayedBody& body : played.bodies) write_body(out, body);
  out.close(']');
  write_channels(out, playback, played);
  write_gaps(out, played);
  out.key("phases").open('[');
  for (const diagnose::PhaseSpan& phase : played.phases) {
    out.comma().open('{').key("phase").text(phase.name);
    out.key("from_s").number(phase.from_s, kDigits).key("to_s").number(phase.to_s, kDigits).close('}');
  }
  out.close(']').key("marks").open('[');
  for (const ReportedPhase& mark : played.marks) {
    out.comma().open('{').key("manoeuvre").text(mark.manoeuvre).key("phase").text(mark.phase);
    out.key("run").text(mark.run).key("from_s").number(mark.from_s, kDigits).key("to_s").number(mark.to_s, kDigits);
    out.key("share").number(mark.share, kDigits).close('}');
  }
  out.close(']');
  write_texts(out, "notes", played.notes);
  return out.close('}').take();
}

}  // namespace kenaf::gap::playback
