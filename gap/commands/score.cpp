// kenaf-gap score: compares the reports of a challenge with its key.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>

#include "command_line/checks.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/make_case.hpp"
#include "gap/challenge/score.hpp"
#include "gap/challenge/sealed_data.hpp"
#include "gap/challenge/temporary_folder.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/datasets/dataset_files.hpp"
#include "gap/parallel.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::commands {
namespace {

namespace fs = std::filesystem;

constexpr double kDataShare = 0.2;  // of the total time if all data are missing, to estimate the time left

// Measures a case whose report has a corrected robot and whose hidden effects are in the catalogue, so that both can be
// simulated; empty for others.
challenge::CaseShrinks measure_shrinks(const fs::path& folder, const challenge::ScoredCase& scored) {
  const challenge::CasePlan& plan = scored.sealed.plan;
  const fs::path file = challenge::report_folder(folder, plan.name) / "robot.toml";
  // With a background the hidden effects are not the whole truth; the score has their shares of the gap instead.
  if (challenge::judge(plan, scored.report).hidden.empty() || plan.is_imperfect() || !scored.report ||
      !fs::exists(file))
    return {};
  const physics::RobotDescription report = physics::load_robot(file.string()),
                                  hidden = challenge::hidden_robot_in_model(plan);
  challenge::CaseShrinks shrinks;
  const challenge::ShrinksOfRuns own =
      challenge::shrinks_on(challenge::case_folder(folder, plan.name), report, hidden, 1);
  // A report of version 1 has one figure for all stages together, measured in another way.
  for (std::size_t s = 0; s < challenge::kEachChannelOnce.size(); ++s)
    for (const challenge::ReadStage& stage : scored.report->stages) {
      if (stage.stage != diagnose::passage_name(challenge::kEachChannelOnce[s])) continue;
      if (stage.named.empty() && stage.ambiguous_sets.empty()) continue;
      shrinks.heldout.push_back(own.of_stage[s]);
      shrinks.heldout.back().report = stage.shrink;
    }
  const challenge::TemporaryFolder unseen;
  challenge::make_unseen(plan, unseen.path, 1);
  shrinks.unseen = challenge::shrinks_on(unseen.path, report, hidden, 1).together;
  return shrinks;
}

}  // namespace

void add_score_command(CLI::App& program) {
  struct Options {
    std::string folder;
    bool shrinks = true;
    unsigned jobs = 0;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("score", "compares the reports of a challenge with its key");
  command->add_option("DIR", options->folder, "the folder of a finished challenge; required")->type_name("");
  command->add_flag("!--no-shrinks", options->shrinks, "leave out the figures that need simulations");
  command->add_option("--jobs", options->jobs, "threads; 0: one per core")
      ->check(command_line::whole_number(0, command_line::kMostJobs))
      ->capture_default_str();

  command->callback([options] {
    if (options->folder.empty()) throw CLI::RequiredError("DIR");

    // Checks key and folder before anything is calculated.
    const fs::path folder = options->folder;
    challenge::ChallengeKey key = challenge::open_key(folder);
    datasets::check_can_write(folder);

    // The shrinks need the cases' data; missing ones are made again.
    ProgressLine line;
    std::mutex mutex;
    double done = 0;
    if (options->shrinks)
      make_missing_data(folder, key, options->jobs, nullptr, [&](std::size_t made, std::size_t missing) {
        line.show("making data again", kDataShare * static_cast<double>(made) / static_cast<double>(missing));
      });
    line.skip(kDataShare);

    // Reads the reports and measures their shrinks.
    std::vector<challenge::ScoredCase> cases;
    for (challenge::SealedCase& sealed : key.cases) {
      std::optional<challenge::ReadReport> report =
          challenge::read_report(challenge::report_folder(folder, sealed.plan.name) / "report.json");
      cases.push_back({std::move(sealed), std::move(report), {}});
    }
    if (options->shrinks)
      for_each_job(cases.size(), options->jobs, [&](std::size_t i) {
        cases[i].shrinks = measure_shrinks(folder, cases[i]);
        const std::lock_guard lock(mutex);
        line.show("simulating the named and the hidden effects",
                  kDataShare + (1 - kDataShare) * ++done / static_cast<double>(cases.size()));
      });

    const std::string text = challenge::score_markdown(cases);
    std::fputs(text.c_str(), stdout);
    runs::write_whole_file(folder / "score.json", challenge::score_json(cases));
    runs::write_whole_file(folder / "score.md", text);
  });
}

}  // namespace kenaf::gap::commands
