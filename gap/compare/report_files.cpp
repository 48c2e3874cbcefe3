// The files of a report other than the page: JSON and CSV.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "formats/runs/whole_file.hpp"
#include "gap/compare/report.hpp"

namespace kenaf::gap::compare {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN; nlohmann-json writes null for it.
Json as_json(const Summary& summary) {
  return {{"mean", summary.mean()}, {"rms", summary.rms()}, {"max", summary.max()}};
}

Json as_json(const ErrorSummary& errors) {
  return {{"frames", std::lround(errors.position_m.weight())},
          {"position_m", as_json(errors.position_m)},
          {"y_m", as_json(errors.y_m)},
          {"roll_rad", as_json(errors.roll_rad)},
          {"pitch_rad", as_json(errors.pitch_rad)},
          {"yaw_rad", as_json(errors.yaw_rad)}};
}

// Only matched frames differ in time.
Json matched_as_json(const ErrorSummary& errors) {
  Json json = as_json(errors);
  json["time_difference_s"] = as_json(errors.time_s);
  return json;
}

Json as_json(const FrameError& error) {
  return {{"position_m", error.position_m}, {"y_m", error.y_m},         {"roll_rad", error.roll_rad},
          {"pitch_rad", error.pitch_rad},   {"yaw_rad", error.yaw_rad}, {"time_difference_s", error.time_s}};
}

Json as_json(const ComparedRun& run, std::size_t index) {
  return {{"manoeuvre", run.manoeuvre},
          {"repeat", run.repeat},
          {"real", run.real_file},
          {"sim", run.sim_file},
          {"real_world", run.real_world},
          {"sim_world", run.sim_world},
          {"matched_file", matched_file_name(index)},
          {"plane", run.plane == Plane::vertical ? "vertical" : "ground"},
          {"real_frames", run.real.size()},
          {"sim_frames", run.sim.size()},
          {"pairs", run.matching.pairs.size()},
          {"cost_m", run.matching.cost_m},
          {"start_offset",
           {{"x_m", run.start_offset.x_m},
            {"y_m", run.start_offset.y_m},
            {"yaw_rad", run.start_offset.yaw_rad},
            {"turned", run.start_offset.turned}}},
          {"matched", matched_as_json(run.errors.matched_summary)},
          {"same_time", as_json(run.errors.same_time_summary)},
          {"at_end", as_json(run.errors.at_end)}};
}

Json as_json(const runs::Dataset& dataset, const std::filesystem::path& folder) {
  return {{"folder", folder.string()},
          {"source", dataset.source},
          {"robot", dataset.robot},
          {"world", dataset.world},
          {"description", dataset.description}};
}

Json as_json(const ManoeuvreErrors& manoeuvre) {
  return {{"manoeuvre", manoeuvre.manoeuvre},
          {"runs", manoeuvre.runs},
          {"matched", matched_as_json(manoeuvre.matched)},
          {"same_time", as_json(manoeuvre.same_time)}};
}

}  // namespace

std::string matched_file_name(std::size_t run) {
  return fmt::format("matched-{:03}.csv", run);
}

std::string matched_csv(const ComparedRun& run) {
  std::string csv =
      "real_frame,sim_frame,weight,real_t_s,sim_t_s,real_x_m,real_z_m,real_pitch_rad,sim_x_m,sim_z_m,sim_pitch_rad,"
      "position_error_m,y_error_m,roll_error_rad,pitch_error_rad,yaw_error_rad,time_difference_s,"
      "same_time_position_error_m,same_time_pitch_error_rad,real_y_m,real_yaw_rad,sim_y_m,sim_yaw_rad,"
      "same_time_yaw_error_rad\n";
  const std::vector<double> weights = pair_weights(run.matching.pairs);
  for (std::size_t k = 0; k < run.matching.pairs.size(); ++k) {
    const FramePair& pair = run.matching.pairs[k];
    const PoseFrame &real = run.real[pair.real], &sim = run.sim[pair.sim];
    const FrameError error = frame_error(run.plane, real, sim), &same_time = run.errors.same_time[pair.real];
    fmt::format_to(std::back_inserter(csv), "{},{}", pair.real, pair.sim);
    for (const double value : {weights[k],
                               real.t_s,
                               sim.t_s,
                               real.x_m,
                               real.z_m,
                               real.pitch_rad,
                               sim.x_m,
                               sim.z_m,
                               sim.pitch_rad,
                               error.position_m,
                               error.y_m,
                               error.roll_rad,
                               error.pitch_rad,
                               error.yaw_rad,
                               error.time_s,
                               same_time.position_m,
                               same_time.pitch_rad,
                               real.y_m,
                               real.yaw_rad,
                               sim.y_m,
                               sim.yaw_rad,
                               same_time.yaw_rad}) {
      csv += ',';
      if (!std::isnan(value)) fmt::format_to(std::back_inserter(csv), "{:.9g}", value);
    }
    csv += '\n';
  }
  return csv;
}

std::string comparison_json(const Comparison& comparison) {
  Json json{{"format", "kenaf-gap-compare/1"},
            {"real", as_json(comparison.real, comparison.real_folder)},
            {"sim", as_json(comparison.sim, comparison.sim_folder)},
            {"options",
             {{"align_start", comparison.options.align_start},
              {"start_s", comparison.options.start_s},
              {"band_s", comparison.options.band_s ? Json(*comparison.options.band_s) : Json()}}}};
  json["all"] = as_json(over_all(comparison));
  json["all"].erase("manoeuvre");
  json["all"].erase("runs");
  json["manoeuvres"] = Json::array();
  for (const ManoeuvreErrors& manoeuvre : by_manoeuvre(comparison)) json["manoeuvres"].push_back(as_json(manoeuvre));
  json["runs"] = Json::array();
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) json["runs"].push_back(as_json(comparison.runs[i], i));
  json["left_out"] = Json::array();
  for (const LeftOut& run : comparison.left_out) {
    json["left_out"].push_back(
        {{"dataset", run.dataset}, {"file", run.file}, {"manoeuvre", run.manoeuvre}, {"why", run.why}});
  }
  // Names of files may hold any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_report(const Comparison& comparison, const std::filesystem::path& folder) {
  const std::string html = comparison_html(comparison);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw runs::RunFileError(folder.string() + ": cannot be created: " + error.message());
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    runs::write_whole_file(folder / matched_file_name(i), matched_csv(comparison.runs[i]));
  }
  runs::write_whole_file(folder / "compare.html", html);
  runs::write_whole_file(folder / "compare.json", comparison_json(comparison));
}

}  // namespace kenaf::gap::compare
