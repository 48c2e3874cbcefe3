#include "gap/recordings/json_fields.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

using Json = nlohmann::json;
using JsonStamp = std::optional<std::int64_t>;

constexpr std::size_t kDeepestJson = 64;  // objects in objects that are listed

Json parsed(std::string_view text) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw RecordingError("a message that is no JSON");
  return json;
}

const Json* member(const Json& object, const std::string& name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

std::optional<double> number_of(const Json* json) {
  if (json == nullptr) return std::nullopt;
  if (json->is_boolean()) return json->get<bool>() ? 1 : 0;
  return json->is_number() ? std::optional(json->get<double>()) : std::nullopt;
}

JsonStamp stamp_of(const Json& object) {
  const Json* header = member(object, "header");
  const Json* stamp = header != nullptr ? member(*header, "stamp") : member(object, "timestamp");
  if (stamp == nullptr) return std::nullopt;
  const std::optional<double> seconds = number_of(member(*stamp, "sec"));
  std::optional<double> nanoseconds = number_of(member(*stamp, "nsec"));
  if (!nanoseconds) nanoseconds = number_of(member(*stamp, "nanosec"));
  if (!seconds || !nanoseconds || !(std::abs(*seconds) < 9e9) || !(std::abs(*nanoseconds) < 1e10)) return std::nullopt;
  return static_cast<std::int64_t>(*seconds) * 1000000000 + static_cast<std::int64_t>(*nanoseconds);
}

// Where `key` is in the object's own list of names.
std::optional<std::size_t> place_by_name(const Json& object, const std::string& key) {
  for (const auto& [name, list] : object.items()) {
    if (!list.is_array() || !is_list_of_names(name)) continue;
    const auto found = std::ranges::find_if(list, [&key](const Json& text) { return text == key; });
    if (found != list.end()) return static_cast<std::size_t>(found - list.begin());
  }
  return std::nullopt;
}

// The text by which an element of an array is named.
const Json* name_of_element(const Json& element) {
  if (!element.is_object()) return nullptr;
  for (const auto& [name, value] : element.items())
    if (value.is_string() && is_name_of_element(name)) return &value;
  return nullptr;
}

const Json* element_of(const Json& object, const Json& array, const PathStep& step) {
  if (!array.is_array()) return nullptr;
  std::optional<std::size_t> place = step.index;
  if (!step.key.empty()) {
    const auto named = std::ranges::find_if(array, [&step](const Json& element) {
      const Json* name = name_of_element(element);
      return name != nullptr && *name == step.key;
    });
    place = named != array.end() ? std::optional(static_cast<std::size_t>(named - array.begin()))
                                 : place_by_name(object, step.key);
  }
  return place && *place < array.size() ? &array[*place] : nullptr;
}

std::optional<FieldValue> value_in(const Json& json, const FieldPath& path) {
  const Json* at = &json;
  JsonStamp stamp = stamp_of(*at);
  for (const PathStep& step : path) {
    const Json* object = at;
    at = member(*object, step.field);
    if (at != nullptr && (step.index || !step.key.empty())) at = element_of(*object, *at, step);
    if (at == nullptr) return std::nullopt;
    if (const JsonStamp own = stamp_of(*at)) stamp = own;
  }
  const std::optional<double> value = number_of(at);
  return value ? std::optional(FieldValue{*value, stamp}) : std::nullopt;
}

// Lists the numbers of a message.
class JsonLister {
 public:
  explicit JsonLister(const TakeField& take) : take_(take) {}

  void list(const Json& json, const std::string& path, JsonStamp stamp, std::size_t depth) {
    if (listed_ >= kMostListed || depth > kDeepestJson) return;
    if (const std::optional<double> value = number_of(&json)) {
      ++listed_;
      take_(path, {*value, stamp});
    } else if (json.is_object()) {
      list_object(json, path.empty() ? "" : path + ".", stamp, depth);
    }
  }

 private:
  void list_object(const Json& object, const std::string& before, JsonStamp stamp, std::size_t depth) {
    if (const JsonStamp own = stamp_of(object)) stamp = own;
    for (const auto& [name, value] : object.items()) {
      if (name.empty() || name.find_first_of(".[]") != name.npos) continue;  // no path leads there
      if (!value.is_array()) {
        list(value, before + name, stamp, depth + 1);
        continue;
      }
      const std::size_t elements = std::min<std::size_t>(value.size(), kMostListedOfArray);
      for (std::size_t i = 0; i < elements; ++i)
        list(value[i], before + with_key(name, key_of(object, value[i], i)), stamp, depth + 1);
    }
  }

  static std::string key_of(const Json& object, const Json& element, std::size_t index) {
    std::string key;
    if (const Json* name = name_of_element(element)) key = name->get<std::string>();
    for (const auto& [name, list] : object.items())
      if (!element.is_object() && list.is_array() && is_list_of_names(name) && index < list.size() &&
          list[index].is_string())
        key = list[index].get<std::string>();
    const bool usable =
        !key.empty() && key.find_first_of("[]") == key.npos && key.find_first_not_of("0123456789") != key.npos;
    return usable ? key : std::to_string(index);
  }

  const TakeField& take_;
  std::size_t listed_ = 0;
};

}  // namespace

void find_json_fields(std::string_view text, std::span<const FieldPath> paths, const TakeFound& take) {
  const Json json = parsed(text);
  for (std::size_t i = 0; i < paths.size(); ++i) take(i, value_in(json, paths[i]));
}

void list_json_fields(std::string_view text, const TakeField& take) {
  JsonLister(take).list(parsed(text), "", std::nullopt, 0);
}

}  // namespace kenaf::gap::recordings
