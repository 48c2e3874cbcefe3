#include "gap/challenge/key.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "formats/runs/whole_file.hpp"
#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/sha256.hpp"
#include "physics/effects.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::challenge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "kenaf-gap-key/1";
constexpr std::string_view kBeginning = "{\n \"format\"";  // of each key's text
// Limits beyond which scoring a case would never end.
constexpr int kMostRepeats = 100, kMostIterations = 1000;
constexpr double kShortestStep_s = 1e-5, kLongestStep_s = 0.01;

Json background_json(const Background& background) {
  Json json{{"floors", background.floors}, {"numbers", Json::object()}};
  for (const BackgroundNumber& number : background.numbers) json["numbers"][number.key] = number.value;
  return json;
}

Json case_json(const SealedCase& sealed) {
  // Members that a stratum or the exact challenge does not have are left out.
  const CasePlan& plan = sealed.plan;
  Json json{{"name", plan.name}, {"stratum", stratum_name(plan.stratum)}, {"effects", Json::array()}};
  for (const HiddenEffect& hidden : plan.effects) {
    Json effect{
        {"effect", hidden.effect}, {"parameter", hidden.parameter}, {"value", hidden.value}, {"floors", hidden.floors}};
    if (plan.is_imperfect()) {
      effect["times_background"] = hidden.times_background;
      effect["shares"] = Json::object();
      for (const StageShare& share : hidden.shares) effect["shares"][share.stage] = share.share;
    }
    json["effects"].push_back(std::move(effect));
  }
  if (!plan.foreign.empty())
    json["foreign"] = {{"name", plan.foreign}, {"amount", plan.foreign_amount}, {"floors", plan.foreign_floors}};
  if (!plan.foreign.empty() && plan.is_imperfect()) json["foreign"]["times_background"] = plan.foreign_times_background;
  if (!plan.number.key.empty())
    json["number"] = {{"key", plan.number.key},
                      {"value", plan.number.value},
                      {"floors", plan.number.floors},
                      {"times_background", plan.number.times_background}};
  if (plan.is_imperfect()) json["background"] = background_json(plan.background);
  if (is_outside(plan.stratum))
    json["looks_like"] = {{"effect", plan.look_alike.effect}, {"angle_deg", plan.look_alike.angle_deg}};
  json["manoeuvres"] = plan.manoeuvres;
  if (!plan.longest_s.empty()) json["longest_s"] = plan.longest_s;
  json["unseen"] = plan.unseen;
  json["repeats"] = plan.repeats;
  if (!plan.engine.empty()) json["engine"] = plan.engine;
  json["physics"] = {{"time_step_s", plan.physics.time_step_s},
                     {"solver_iterations", plan.physics.solver_iterations},
                     {"contact_stiffness_npm", plan.physics.contact_stiffness_npm},
                     {"contact_damping_nspm", plan.physics.contact_damping_nspm}};
  json["noise_scale"] = plan.noise_scale;
  json["noise_memory_s"] = plan.noise_memory_s;
  if (plan.count_scale > 0) json["count_scale"] = plan.count_scale;
  json["seed"] = plan.seed;
  json["data_sha256"] = sealed.data_sha256;
  return json;
}

// Throws if a case does not hide what its stratum says, or has values that no challenge plans.
void check(const CasePlan& plan) {
  const Stratum stratum = plan.stratum;
  const bool hides_one = stratum == Stratum::single || stratum == Stratum::withheld;
  const std::size_t effects = stratum == Stratum::pair ? 2 : hides_one ? 1 : 0;
  const bool has_effects = stratum == Stratum::baseline ? plan.effects.size() <= 1 : plan.effects.size() == effects;
  if (!has_effects || plan.foreign.empty() == (stratum == Stratum::foreign) ||
      plan.number.key.empty() == (stratum == Stratum::withheld_number))
    throw std::runtime_error(fmt::format("{} does not hide the effects of its stratum", plan.name));
  for (const HiddenEffect& hidden : plan.effects) {
    const auto* effect = physics::find_effect(hidden.effect);
    const auto* parameter = effect == nullptr ? nullptr : physics::find_parameter(*effect, hidden.parameter);
    if (parameter == nullptr)
      throw std::runtime_error(fmt::format("{} hides {}:{}, which is not in the catalogue of this program", plan.name,
                                           hidden.effect, hidden.parameter));
    if (!(hidden.value >= parameter->min && hidden.value <= parameter->max))
      throw std::runtime_error(fmt::format("{} hides {}:{} = {}, which is out of its range", plan.name, hidden.effect,
                                           hidden.parameter, hidden.value));
  }
  // Throws if background, number and effects do not make a valid robot.
  hidden_robot(plan);
  if (!plan.longest_s.empty() && plan.longest_s.size() != plan.manoeuvres.size())
    throw std::runtime_error(fmt::format("{} does not give the end time of each manoeuvre", plan.name));
  const physics::PhysicsSettings& physics = plan.physics;
  if (plan.repeats < 1 || plan.repeats > kMostRepeats || !(physics.time_step_s >= kShortestStep_s) ||
      !(physics.time_step_s <= kLongestStep_s) || physics.solver_iterations < 1 ||
      physics.solver_iterations > kMostIterations)
    throw std::runtime_error(fmt::format(
        "{} has a number of repeats, a time step or a number of iterations that is out of range", plan.name));
}

SealedCase case_of(const Json& json) {
  // Reads what case_json() writes; members that not every case has may be missing.
  SealedCase sealed;
  CasePlan& plan = sealed.plan;
  json.at("name").get_to(plan.name);
  plan.stratum = stratum_of(json.at("stratum").get<std::string>());
  for (const Json& effect : json.at("effects")) {
    plan.effects.push_back({effect.at("effect"), effect.at("parameter"), effect.at("floors"), effect.at("value")});
    if (!effect.contains("times_background")) continue;
    effect["times_background"].get_to(plan.effects.back().times_background);
    for (const auto& [stage, share] : effect.at("shares").items()) plan.effects.back().shares.push_back({stage, share});
  }
  if (json.contains("foreign")) {
    const Json& foreign = json["foreign"];
    foreign.at("name").get_to(plan.foreign);
    foreign.at("amount").get_to(plan.foreign_amount);
    foreign.at("floors").get_to(plan.foreign_floors);
    if (foreign.contains("times_background")) foreign["times_background"].get_to(plan.foreign_times_background);
  }
  if (json.contains("number")) {
    const Json& number = json["number"];
    plan.number = {number.at("key"), number.at("value"), number.at("floors"), number.at("times_background")};
  }
  if (json.contains("background")) {
    json["background"].at("floors").get_to(plan.background.floors);
    for (const auto& [key, value] : json["background"].at("numbers").items())
      plan.background.numbers.push_back({key, value});
  }
  if (is_outside(plan.stratum))
    plan.look_alike = {json.at("looks_like").at("effect"), json.at("looks_like").at("angle_deg")};
  json.at("manoeuvres").get_to(plan.manoeuvres);
  if (json.contains("longest_s")) json["longest_s"].get_to(plan.longest_s);
  json.at("unseen").get_to(plan.unseen);
  json.at("repeats").get_to(plan.repeats);
  if (json.contains("engine")) json["engine"].get_to(plan.engine);
  const Json& physics = json.at("physics");
  physics.at("time_step_s").get_to(plan.physics.time_step_s);
  physics.at("solver_iterations").get_to(plan.physics.solver_iterations);
  physics.at("contact_stiffness_npm").get_to(plan.physics.contact_stiffness_npm);
  physics.at("contact_damping_nspm").get_to(plan.physics.contact_damping_nspm);
  json.at("noise_scale").get_to(plan.noise_scale);
  json.at("noise_memory_s").get_to(plan.noise_memory_s);
  if (json.contains("count_scale")) json["count_scale"].get_to(plan.count_scale);
  json.at("seed").get_to(plan.seed);
  json.at("data_sha256").get_to(sealed.data_sha256);
  check(plan);
  return sealed;
}

unsigned char byte_of(std::string_view two_digits) {
  unsigned char byte = 0;
  if (std::from_chars(two_digits.begin(), two_digits.end(), byte, 16).ptr != two_digits.end())
    throw std::runtime_error(fmt::format("\"{}\" is not a pair of hexadecimal digits", two_digits));
  return byte;
}

// XORs the bytes with a keystream of SHA-256 over (stream, seed, block number), 32 bytes a block. Its own inverse.
std::string with_keystream(std::string bytes, std::uint64_t seed, std::string_view of = "key") {
  std::string block;  // 64 hexadecimal digits, two for each byte
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t in_block = i % 32;
    if (in_block == 0) block = sha256(fmt::format("{} of a kenaf-gap challenge, seed {}, block {}", of, seed, i / 32));
    bytes[i] = static_cast<char>(bytes[i] ^ byte_of(std::string_view(block).substr(2 * in_block, 2)));
  }
  return bytes;
}

std::string in_digits(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text + "\n";
}

std::string from_digits(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) bytes += static_cast<char>(byte_of(text.substr(i, 2)));
  return bytes;
}

fs::path made_case_file(const fs::path& folder, const std::string& name) {
  return folder / (name + ".enciphered");
}
// Each text has a stream of its own: two texts under one stream would reveal each other.
std::string made_case_stream(const std::string& name, std::size_t cases, ChallengeKind kind) {
  return fmt::format("{} of {}{}", name, cases,
                     kind == ChallengeKind::exact ? "" : fmt::format(" {}", kind_name(kind)));
}

}  // namespace

bool is_sealed_dataset(const fs::path& dataset, const SealedCase& sealed) try {
  return sha256_of_dataset(dataset) == sealed.data_sha256;
} catch (const std::exception&) {
  return false;  // missing or incomplete
}

std::string key_text(const ChallengeKey& key) {
  Json json{{"format", kFormat},
            {"seed", key.seed},
            {"salt", sha256(fmt::format("salt of a kenaf-gap challenge, seed {}", key.seed))}};
  if (key.kind != ChallengeKind::exact) json["challenge"] = kind_name(key.kind);
  json["cases"] = Json::array();
  for (const SealedCase& sealed : key.cases) json["cases"].push_back(case_json(sealed));
  return json.dump(1) + "\n";
}

ChallengeKey read_key(const std::string& text) try {
  const Json json = Json::parse(text);
  if (json.at("format") != kFormat) throw std::runtime_error(fmt::format("its format is not {}", kFormat));
  ChallengeKey key{json.at("seed"), {}};
  if (json.contains("challenge")) key.kind = challenge_kind_of(json["challenge"].get<std::string>());
  for (const Json& sealed : json.at("cases")) key.cases.push_back(case_of(sealed));
  return key;
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("key.json is not the key of a challenge: {}", error.what()));
}

std::string commitment_text(const std::string& key_text) {
  return "# SHA-256 of the key of this challenge, made before its first case was diagnosed.\n"
         "# Once key.json is here: sha256sum --check commitment.txt\n" +
         sha256(key_text) + "  key.json\n";
}

std::string enciphered(const std::string& key_text, std::uint64_t seed) {
  return in_digits(with_keystream(key_text, seed));
}

std::string deciphered(const std::string& text, std::uint64_t seed) {
  return with_keystream(from_digits(text), seed);
}

void keep_made_case(const fs::path& folder, const SealedCase& sealed, std::uint64_t seed, std::size_t cases,
                    ChallengeKind kind) {
  const std::string& name = sealed.plan.name;
  const std::string stream = made_case_stream(name, cases, kind);
  runs::write_whole_file(made_case_file(folder, name),
                         in_digits(with_keystream(key_text({seed, {sealed}, kind}), seed, stream)));
}

std::optional<SealedCase> made_case(const fs::path& folder, const std::string& name, std::uint64_t seed,
                                    std::size_t cases, ChallengeKind kind) try {
  const fs::path file = made_case_file(folder, name);
  if (!fs::exists(file)) return std::nullopt;
  const std::string text =
      with_keystream(from_digits(runs::read_whole_file(file)), seed, made_case_stream(name, cases, kind));
  const ChallengeKey key = read_key(text);
  if (key.seed != seed || key.cases.size() != 1 || key.cases[0].plan.name != name) return std::nullopt;
  if (!is_sealed_dataset(folder / name, key.cases[0])) return std::nullopt;
  return key.cases[0];
} catch (const std::exception&) {
  return std::nullopt;  // damaged; the case can be made again
}

std::optional<ChallengeKey> sealed_key(const fs::path& folder, std::uint64_t seed) try {
  if (!fs::exists(folder / "commitment.txt") || !fs::exists(folder / "key.enciphered")) return std::nullopt;
  const std::string text = deciphered(runs::read_whole_file(folder / "key.enciphered"), seed);
  if (runs::read_whole_file(folder / "commitment.txt") != commitment_text(text)) return std::nullopt;
  return read_key(text);
} catch (const std::exception&) {
  return std::nullopt;  // damaged; all cases can be made again
}

bool is_sealed_by_another(const fs::path& folder, std::uint64_t seed) try {
  const fs::path file = folder / "key.enciphered";
  return fs::exists(file) && !deciphered(runs::read_whole_file(file), seed).starts_with(kBeginning);
} catch (const std::exception&) {
  return false;  // damaged, so no seed opens it
}

ChallengeKey open_key(const fs::path& folder) {
  if (!fs::exists(folder / "commitment.txt"))
    throw std::runtime_error(
        fmt::format("{}: is not the folder of a challenge, because it has no commitment.txt", folder.string()));
  if (!fs::exists(folder / "key.json"))
    throw std::runtime_error(
        fmt::format("{}: is not finished: key.json is written once all cases are diagnosed", folder.string()));
  const std::string text = runs::read_whole_file(folder / "key.json");
  if (runs::read_whole_file(folder / "commitment.txt") != commitment_text(text))
    throw std::runtime_error(
        fmt::format("{}: key.json does not match commitment.txt; one of them was changed", folder.string()));
  ChallengeKey key = read_key(text);
  for (const SealedCase& sealed : key.cases)
    if (const fs::path data = case_folder(folder, sealed.plan.name);
        fs::exists(data) && !is_sealed_dataset(data, sealed))
      throw std::runtime_error(fmt::format("{}: the data does not match its seal, so it was changed", data.string()));
  return key;
}

fs::path case_folder(const fs::path& folder, const std::string& name) {
  return folder / "cases" / name;
}

fs::path report_folder(const fs::path& folder, const std::string& name) {
  return folder / "reports" / name;
}

}  // namespace kenaf::gap::challenge
