#include <fmt/format.h>

#include <toml++/toml.h>
#include <sstream>

#include "description/description_file.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap {
namespace {

// Not where `effects` is an inline table, to which nothing can be added from below.
bool reads_as(const std::string& text, const toml::table& root) try {
  return toml::parse(text) == root;
} catch (const toml::parse_error&) {
  return false;
}

// A whole number in TOML is of another type.
std::string as_float(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

std::string corrected_robot_toml(const Diagnosis& d, const std::string& robot_name_or_path) {
  std::string text = read_description_file("robot", robot_name_or_path, ".toml").text;
  if (!text.ends_with('\n')) text += '\n';
  toml::table root = toml::parse(text);
  bool replaces = false;
  std::string added;
  for (const OnCurve& place : d.decision.best.places) {
    const EffectCurve& curve = d.curves.curves[place.curve];
    if (!root.contains("effects")) root.insert("effects", toml::table{});
    toml::table& effects = *root["effects"].as_table();
    replaces |= effects.contains(curve.effect->name);
    if (!effects.contains(curve.effect->name)) effects.insert(curve.effect->name, toml::table{});
    effects[curve.effect->name].as_table()->insert_or_assign(curve.parameter->name, place.value);
    added += fmt::format("\n[effects.{}]                # found by a diagnosis of runs\n{} = {}\n", curve.effect->name,
                         curve.parameter->name, as_float(place.value));
  }
  if (!replaces && reads_as(text + added, root)) return text + added;
  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

}  // namespace kenaf::gap
