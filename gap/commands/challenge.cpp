// kenaf-gap challenge: makes and seals cases with hidden effects, and has them diagnosed by processes that cannot know
// these.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/random.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "command_line/checks.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/challenge/confinement.hpp"
#include "gap/challenge/diagnose_cases.hpp"
#include "gap/challenge/key.hpp"
#include "gap/challenge/make_case.hpp"
#include "gap/challenge/read_report.hpp"
#include "gap/challenge/sealed_data.hpp"
#include "gap/challenge/sha256.hpp"
#include "gap/challenge/stand_ins.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/interrupt.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/parallel.hpp"
#include "rollout/engines/body_in_engine.hpp"

namespace kenaf::gap::commands {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostCases = 10000;
// Shares of the total time, to estimate the time left.
constexpr double kMakingShare = 0.3;        // of making the cases
constexpr double kMakingAgainShare = 0.03;  // of making missing data again

struct Options {
  std::string out;
  std::size_t cases = 150;
  std::optional<std::uint64_t> seed;
  unsigned jobs = 0;
  bool imperfect = false;
  std::string engine;

  challenge::ChallengeKind kind() const {
    if (!engine.empty()) return challenge::challenge_kind_of(engine);
    return imperfect ? challenge::ChallengeKind::imperfect : challenge::ChallengeKind::exact;
  }
  // The option on the command line that gives this kind.
  std::string_view kind_option() const { return option_of(kind()); }
  static std::string_view option_of(challenge::ChallengeKind kind) {
    constexpr std::string_view kOptions[] = {"", " --imperfect", " --engine mujoco", " --engine ode"};
    return kOptions[static_cast<std::size_t>(kind)];
  }
};

std::uint64_t seed_from_system() {
  std::uint64_t seed = 0;
  if (::getrandom(&seed, sizeof seed, 0) != sizeof seed)
    throw std::runtime_error("the operating system provides no random seed; give one with --seed");
  return seed;
}

// Whether the folder holds a challenge, also one that was interrupted before its cases were sealed.
bool is_challenge(const fs::path& folder) {
  return fs::exists(folder / "commitment.txt") || fs::exists(folder / "cases.part");
}

void check_folder(const fs::path& folder, bool seed_given) {
  if (fs::exists(folder / "key.json"))
    throw std::runtime_error(fmt::format(
        "{}: this challenge is finished; `kenaf-gap score` compares its reports with its key", folder.string()));
  if (fs::exists(folder) && !fs::is_empty(folder) && !(seed_given && is_challenge(folder)))
    throw std::runtime_error(fmt::format(
        "{}: is not empty; give another folder, or the --seed of the challenge to continue there", folder.string()));
}

class Teller {
 public:
  explicit Teller(std::size_t cases) : cases_(static_cast<double>(cases)) {}
  // `before`: by an earlier, interrupted program; also in diagnosed().
  void made(bool before) {
    const std::lock_guard lock(mutex_);
    ++made_;
    tell("making cases", kMakingShare * made_ / cases_, made_, cases_, before);
  }
  void made_again(std::size_t made, std::size_t missing) {
    const auto count = static_cast<double>(made), of = static_cast<double>(missing);
    tell("making data again", kMakingAgainShare * count / of, count, of, false);
  }
  void all_were_made() { line_.skip(kMakingShare); }
  void diagnosed(const std::string& name, bool could, bool before) {
    ++diagnosed_;
    if (!could) {
      clear_progress_line();
      std::fprintf(stderr, "%s: could not be diagnosed\n", name.c_str());
    }
    tell("diagnosing", kMakingShare + (1 - kMakingShare) * diagnosed_ / cases_, diagnosed_, cases_, before);
  }

 private:
  void tell(std::string_view doing, double done, double count, double of, bool before) {
    if (before) line_.skip(done);
    const std::string what = fmt::format("{} ({} of {})", doing, count, of);
    line_.show(what, done);
    if (!line_.on_terminal()) std::fputs((what + "\n").c_str(), stderr);
  }
  std::mutex mutex_;
  ProgressLine line_;
  double cases_, made_ = 0, diagnosed_ = 0;
};

// Makes the data of all cases that were not made before; returns the key.
challenge::ChallengeKey make_cases(const Options& options, std::uint64_t seed, const fs::path& folder, Teller& teller,
                                   const std::atomic<bool>& stop) {
  challenge::ChallengeKey key{seed, {}, options.kind()};
  for (challenge::CasePlan& plan : challenge::plan_challenge(options.cases, seed, key.kind))
    key.cases.push_back({std::move(plan), {}});
  // A case whose key and data are complete is kept; any other is made from scratch.
  for_each_job(key.cases.size(), options.jobs, [&](std::size_t i) {
    if (stop) throw diagnose::Stopped();
    challenge::SealedCase& sealed = key.cases[i];
    std::optional<challenge::SealedCase> made =
        challenge::made_case(folder, sealed.plan.name, seed, options.cases, key.kind);
    const bool was_made = made.has_value();
    if (was_made) {
      sealed = *std::move(made);
    } else {
      const fs::path data = folder / sealed.plan.name;
      fs::remove_all(data);
      challenge::make_case(sealed.plan, data, 1, &stop);
      sealed.data_sha256 = challenge::sha256_of_dataset(data);
      challenge::keep_made_case(folder, sealed, seed, options.cases, key.kind);
    }
    teller.made(was_made);
  });
  return key;
}

// Removes everything from a folder of cases that belongs to none.
void remove_all_but_cases(const fs::path& folder, const challenge::ChallengeKey& key) {
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (std::ranges::none_of(
            key.cases, [&](const challenge::SealedCase& one) { return entry.path().filename() == one.plan.name; }))
      others.push_back(entry.path());
  for (const fs::path& other : others) fs::remove_all(other);
}

// Throws if the folder holds cases of another seed or number, which must not be lost by a typing error.
void check_same_cases(const fs::path& folder, const Options& options, std::uint64_t seed) {
  bool any = false;
  for (const challenge::CasePlan& plan : challenge::plan_challenge(options.cases, seed, options.kind())) {
    if (challenge::made_case(folder, plan.name, seed, options.cases, options.kind())) return;
    any |= fs::exists(folder / (plan.name + ".enciphered"));
  }
  if (any)
    throw std::runtime_error(fmt::format(
        "{}: contains cases of another --seed, --cases, --imperfect or --engine; give those, or another folder",
        folder.string()));
}

// Makes cases and commitment. Existing cases are kept; missing ones of a sealed challenge are made from its key.
challenge::ChallengeKey seal_cases(const Options& options, std::uint64_t seed, const fs::path& folder, Teller& teller,
                                   const std::atomic<bool>& stop) {
  if (auto key = challenge::sealed_key(folder, seed)) {
    if (key->cases.size() != options.cases)
      throw std::runtime_error(
          fmt::format("{0}: is a challenge of {1} cases; give --cases {1}", folder.string(), key->cases.size()));
    if (key->kind != options.kind())
      throw std::runtime_error(fmt::format("{}: is the {} challenge; continue it with `kenaf-gap challenge{}`",
                                           folder.string(), challenge::kind_name(key->kind),
                                           Options::option_of(key->kind)));
    challenge::make_missing_data(folder, *key, options.jobs, &stop,
                                 [&](std::size_t made, std::size_t missing) { teller.made_again(made, missing); });
    teller.all_were_made();
    return *std::move(key);
  }

  if (challenge::is_sealed_by_another(folder, seed))
    throw std::runtime_error(
        fmt::format("{}: was sealed with another --seed; give that one, or another folder", folder.string()));

  // Makes the cases in a folder that gets its final name only when they are sealed.
  const fs::path part = folder / "cases.part";
  fs::create_directories(part);
  check_same_cases(part, options, seed);
  challenge::ChallengeKey key = make_cases(options, seed, part, teller, stop);
  remove_all_but_cases(part, key);

  // A commitment that exists already must be that of these cases.
  const std::string text = challenge::key_text(key), commitment = challenge::commitment_text(text);
  if (fs::exists(folder / "commitment.txt") && runs::read_whole_file(folder / "commitment.txt") != commitment) {
    fs::remove_all(part);
    throw std::runtime_error(
        fmt::format("{}: the cases of --cases {} --seed {} do not match those sealed there; use the same version of "
                    "the program and the same numbers",
                    folder.string(), options.cases, seed));
  }
  // Written before "cases.part" goes, which marks the folder as a challenge until then.
  runs::write_whole_file(folder / "commitment.txt", commitment);
  runs::write_whole_file(folder / "key.enciphered", challenge::enciphered(text, seed));
  fs::remove_all(folder / "cases");
  fs::rename(part, folder / "cases");
  return key;
}

bool is_diagnosed(const challenge::CaseToDiagnose& one) try {
  return challenge::read_report(one.report / "report.json").has_value();
} catch (const std::exception&) {
  return false;  // damaged
}

// Makes, seals and diagnoses the cases; returns how many could be diagnosed.
std::size_t run(const Options& options, std::uint64_t seed) {
  const std::atomic<bool>& stop = interruption();
  const fs::path folder = fs::absolute(options.out).lexically_normal();
  Teller teller(options.cases);
  const challenge::ChallengeKey key = seal_cases(options, seed, folder, teller, stop);

  // Cases without a valid report are left to diagnose; each receives only what it may know.
  std::vector<challenge::CaseToDiagnose> left;
  std::vector<std::string> names;
  for (const challenge::SealedCase& sealed : key.cases) {
    const challenge::CasePlan& plan = sealed.plan;
    challenge::CaseToDiagnose one{challenge::case_folder(folder, plan.name),
                                  challenge::report_folder(folder, plan.name),
                                  challenge::withheld_names(plan),
                                  {}};
    if (plan.stratum == challenge::Stratum::baseline) one.against = one.data / challenge::kBeforeFolder;
    if (!one.without.empty())
      runs::write_whole_file(one.data / "without.txt", fmt::format("{}\n", fmt::join(one.without, "\n")));
    if (is_diagnosed(one)) {
      teller.diagnosed(plan.name, true, true);
    } else {
      left.push_back(std::move(one));
      names.push_back(plan.name);
    }
  }

  // Diagnoses them; a process that succeeds must also have left a valid report.
  if (!challenge::can_confine())
    std::fputs(
        "this kernel has no Landlock: the diagnosis does not get the key, but could read files outside its case\n",
        stderr);
  std::size_t diagnosed = key.cases.size() - left.size();
  diagnose_cases(left, options.jobs, stop, [&](std::size_t i, bool could) {
    could = could && is_diagnosed(left[i]);
    teller.diagnosed(names[i], could, false);
    diagnosed += could ? 1 : 0;
  });

  // Only now the key is published.
  if (stop) throw diagnose::Stopped();
  if (diagnosed == 0)
    throw std::runtime_error(
        fmt::format("no case could be diagnosed; the reason is in {}", (left[0].report / "diagnose.log").string()));
  runs::write_whole_file(folder / "key.json", challenge::key_text(key));
  fs::remove(folder / "key.enciphered");
  return diagnosed;
}

CLI::Validator engine_check(const std::vector<std::string>& engines) {
  if (!engines.empty()) return command_line::one_of(engines);
  return command_line::readable_by([](const std::string&) {
    throw std::runtime_error("must not be given: kenaf-gap was built without MuJoCo and ODE");
  });
}

}  // namespace

void add_challenge_command(CLI::App& program) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "challenge", "diagnoses cases with hidden effects, whose key stays sealed until all are diagnosed");
  command->add_option("--out", options->out, "folder for the cases, their reports and the key; required")
      ->type_name("DIR");
  command->add_option("--cases", options->cases, "how many")
      ->check(command_line::whole_number(1, kMostCases))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "seed of all random numbers, to repeat or continue a challenge [random]")
      ->check(command_line::whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  command->add_flag("--imperfect", options->imperfect,
                    "realistic cases: every number of the robot has a small error, runs are short and few");
  const std::vector<std::string> engines = engines::engine_names();
  const std::string built_with =
      engines.empty() ? "none: built without MuJoCo and ODE" : fmt::format("{}", fmt::join(engines, " or "));
  command
      ->add_option("--engine", options->engine,
                   fmt::format("like --imperfect, and another physics engine moves the robots ({})", built_with))
      ->type_name("NAME")
      ->check(engine_check(engines));
  command->add_option("--jobs", options->jobs, "parallel cases; 0: one per core")
      ->check(command_line::whole_number(0, command_line::kMostJobs))
      ->capture_default_str();

  command->callback([options] {
    if (options->out.empty()) throw CLI::RequiredError("--out");

    check_folder(options->out, options->seed.has_value());
    ::prctl(PR_SET_DUMPABLE, 0);  // no other process of this user may read the key out of this one's memory

    const std::uint64_t seed = options->seed ? *options->seed : seed_from_system();
    // The seed is revealed only if the program ends early: without it nobody could resume the challenge.
    const auto goes_on = [&](const std::string& why) {
      return std::runtime_error(fmt::format("{}; `kenaf-gap challenge --out {} --cases {} --seed {}{}` continues it",
                                            why, options->out, options->cases, seed, options->kind_option()));
    };
    std::size_t diagnosed = 0;
    try {
      diagnosed = run(*options, seed);
    } catch (const diagnose::Stopped&) {
      throw goes_on("interrupted");
    } catch (const std::exception& error) {
      if (options->seed || !is_challenge(options->out)) throw;
      throw goes_on(error.what());
    }
    fmt::print(
        "{} of {} cases are diagnosed; {}/key.json lists the effects hidden in them\n`kenaf-gap score {}` compares\n",
        diagnosed, options->cases, options->out, options->out);
    if (diagnosed < options->cases)
      throw RunsWentWrong(
          "not all cases could be diagnosed; the diagnose.log of each case without a report.json gives the reason");
  });
}

}  // namespace kenaf::gap::commands
