// kenaf-gap merge: merges the pose from motion capture into a run that the robot recorded.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/logs/capture_up.hpp"
#include "gap/logs/merge_pose.hpp"
#include "gap/logs/wrapped_travel.hpp"

namespace kenaf::gap::commands {
namespace {

void print(const logs::MergedRun& merged) {
  // The offset, with what each quantity says of it, unless it was given.
  const logs::ClockOffset& offset = merged.offset;
  if (offset.quantities.empty()) {
    std::printf("time offset: %.4f s, as given\n", offset.offset_s);
  } else {
    std::printf("time offset: %.4f s, standard error %.4f s; run time = motion capture time + offset\n",
                offset.offset_s, offset.standard_error_s);
    for (const logs::QuantityOffset& quantity : offset.quantities)
      std::printf("  from %s: %.4f s, standard error %.4f s, gain %.3g, correlation %.3f%s\n", quantity.name.c_str(),
                  quantity.offset_s, quantity.standard_error_s, quantity.gain, quantity.correlation,
                  quantity.used ? "" : "; not used, because tracks slip");
    if (offset.from_tracks)
      std::printf(
          "  from the tracks alone: if the body follows its belts with a delay, the offset is wrong by that delay\n");
    std::printf("  both logs cover %.1f s\n", offset.overlap_s);
  }

  // The drift, where there is one, and what the run got.
  if (const logs::ClockDrift& drift = merged.drift; drift.standard_error > 0)
    std::printf("the clocks drift: the offset grows by %.0f ppm, standard error %.0f ppm, and is %.4f s at %.1f s\n",
                1e6 * drift.rate, 1e6 * drift.standard_error, drift.offset_s, drift.at_s);
  else if (drift.rate != 0)
    std::printf("the offset grows by %.0f ppm, as given, and is %.4f s at %.1f s\n", 1e6 * drift.rate, drift.offset_s,
                drift.at_s);
  const std::size_t rows = merged.run.row_count();
  std::printf("%zu of %zu rows have a pose, between captured ones at most %.3g s apart\n", merged.rows_with_pose, rows,
              merged.max_gap_s);
  for (const auto& [name, kept] : merged.renamed)
    std::printf("the column %s of the run is kept as %s\n", name.c_str(), kept.c_str());
}

logs::Up up_of(const std::string& name) {
  for (const logs::Up up : {logs::Up::y, logs::Up::minus_y, logs::Up::minus_z})
    if (name == logs::name_of(up)) return up;
  return logs::Up::z;
}

void check_up(const runs::Run& run, const logs::MotionCapture& capture, const std::string& file) {
  const auto seen = logs::up_seen(run, capture);
  if (!seen) return;
  throw std::runtime_error(
      fmt::format("{}: its {} axis points up, not z: {}. Nothing was written. Give --up {}, or --up z if z is up "
                  "nevertheless",
                  file, logs::name_of(seen->up), seen->why, logs::name_of(seen->up)));
}

}  // namespace

void add_merge_command(CLI::App& program) {
  struct Options {
    std::string run, capture, out, units = "m", up;
    logs::MergeOptions merge;
    bool force = false, unwrap = false;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "merge", "adds the pose from motion capture to a recorded run and reports the offset of the clocks");
  command->add_option("RUN", options->run, "the run, a CSV file; required")->type_name("");
  command->add_option("MOCAP", options->capture, "the motion capture, a CSV file; required")->type_name("");
  command->add_option("--out", options->out, "the CSV file to write; required")->type_name("FILE");
  command->add_option("--mocap-units", options->units, "unit of x_m, y_m and z_m in MOCAP: m or mm")
      ->check(command_line::one_of({"m", "mm"}))
      ->type_name("UNIT")
      ->capture_default_str();
  command->add_option("--up", options->up, "axis of MOCAP that points up: z, y, -y or -z [z, unless another is seen]")
      ->check(command_line::one_of({"z", "y", "-y", "-z"}))
      ->type_name("AXIS");
  command->add_flag("--keep-frame", options->merge.keep_frame,
                    "keep the frame of the motion capture; otherwise the first pose is the origin, x forward");
  command->add_option("--start", options->merge.start_s, "average the first pose over this time; 0: the first row [0]")
      ->check(command_line::number_in(0, 1e6))
      ->type_name("SECONDS");
  command
      ->add_option("--max-gap", options->merge.max_gap_s,
                   "longest gap between captured poses to interpolate over [2.5 times their median step]")
      ->check(command_line::number_in(1e-6, 1e6))
      ->type_name("SECONDS");
  command
      ->add_option("--offset", options->merge.offset_s,
                   "run time minus motion capture time at the run's first row, if known; otherwise it is estimated")
      ->check(command_line::number_in(-1e12, 1e12))
      ->type_name("SECONDS");
  command
      ->add_option_function<double>(
          "--drift", [options](double ppm) { options->merge.drift = 1e-6 * ppm; },
          "growth of the offset in millionths, if known; 0: clocks of the same speed; otherwise it is estimated, or 0 "
          "with --offset")
      ->check(command_line::number_in(-1e5, 1e5))
      ->type_name("PPM");
  command->add_flag("--unwrap", options->unwrap, "write the travel of tracks whose counter wraps without its jumps");
  command->add_flag("--force", options->force, "replace the output file if it exists");

  command->callback([options] {
    // Required options, and an output file that must not exist.
    for (const auto& [name, text] :
         {std::pair{"RUN", &options->run}, {"MOCAP", &options->capture}, {"--out", &options->out}})
      if (text->empty()) throw CLI::RequiredError(name);
    if (!options->force && std::filesystem::exists(options->out))
      throw std::runtime_error(
          fmt::format("{}: exists already; give another file, or --force to replace it", options->out));

    // Merges; errors get the names of the files, which the merge does not know.
    runs::Run run = runs::read_run(options->run);
    const logs::LengthUnit unit = options->units == "mm" ? logs::LengthUnit::millimetres : logs::LengthUnit::metres;
    const runs::Run captured = runs::read_run(options->capture);
    const std::pair<const std::string&, const runs::Run&> files[] = {{options->run, run}, {options->capture, captured}};
    for (const auto& [name, file] : files)
      if (!file.reading.empty()) std::printf("%s: is read with %s\n", name.c_str(), file.reading.c_str());
    if (options->unwrap)
      for (const std::string& done : logs::unwrap_travel(run))
        std::printf("%s: %s\n", options->run.c_str(), done.c_str());
    const logs::MotionCapture capture = logs::with_z_up(logs::motion_capture_of(captured, options->capture, unit),
                                                        up_of(options->up), options->capture);
    if (options->up.empty()) check_up(run, capture, options->capture);
    const logs::MergedRun merged = [&] {
      try {
        return logs::merge_pose(run, capture, options->merge);
      } catch (const logs::NoOffset& error) {
        throw std::runtime_error(
            fmt::format("{}, {}: the time offset cannot be estimated: {}. Nothing was written. If the offset is known, "
                        "give it with --offset",
                        options->run, options->capture, error.what()));
      } catch (const runs::RunFileError& error) {
        throw std::runtime_error(fmt::format("{}: {}", options->run, error.what()));
      }
    }();

    runs::write_run(options->out, merged.run);
    print(merged);
  });
}

}  // namespace kenaf::gap::commands
