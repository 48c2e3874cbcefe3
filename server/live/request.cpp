#include "server/live/request.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

namespace kenaf::live {

namespace {

using nlohmann::json;

double number(const json& object, const char* key, double least, double most) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) throw std::runtime_error(std::string(key) + " is not a number");
  const double value = found->get<double>();
  if (!(value >= least && value <= most)) throw std::runtime_error(std::string(key) + " is out of range");
  return value;
}

bool boolean(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_boolean())
    throw std::runtime_error(std::string(key) + " is not true or false");
  return found->get<bool>();
}

std::uint32_t robot(const json& object) {
  return static_cast<std::uint32_t>(number(object, "robot", 1, 4294967295.0));
}

// Four numbers, null for a flipper that keeps its command.
void read_flippers(const json& object, const char* key, robot::JointMode mode, robot::Command& command) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  if (!found->is_array() || found->size() != robot::kFlipperCount) {
    throw std::runtime_error(std::string(key) + " is not a list of four");
  }
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const json& value = (*found)[i];
    if (value.is_null()) continue;
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      throw std::runtime_error(std::string(key) + " holds something that is neither a number nor null");
    }
    command.flipper[i] = {mode, value.get<double>()};
  }
}

DriveRequest drive(const json& object) {
  constexpr double kFastest_mps = 100;
  DriveRequest request{robot(object), {}};
  request.command.track_speed_mps = {number(object, "left", -kFastest_mps, kFastest_mps),
                                     number(object, "right", -kFastest_mps, kFastest_mps)};
  request.command.flipper.fill({robot::JointMode::brake, 0});
  read_flippers(object, "flipper_angle", robot::JointMode::angle, request.command);
  read_flippers(object, "flipper_speed", robot::JointMode::speed, request.command);
  return request;
}

LookRequest look(const json& object) {
  constexpr double kFarthest_rad = 100;
  const auto name = object.find("camera");
  if (name == object.end() || !name->is_string()) throw std::runtime_error("camera is missing");
  LookRequest request{robot(object), name->get<std::string>(), {}};
  const auto angle = [&](const char* key) -> std::optional<double> {
    if (!object.contains(key)) return std::nullopt;
    return number(object, key, -kFarthest_rad, kFarthest_rad);
  };
  request.order = {angle("pan"), angle("tilt"), angle("fov")};
  return request;
}

PlaceRequest place(const json& object) {
  constexpr double kFarthest_m = 1e4;
  const auto found = object.find("p");
  if (found == object.end()) return {};
  if (!found->is_array() || found->size() != 3) throw std::runtime_error("p is not a list of three");
  world_server::GroundPlace where{{0, 0, 0}, object.contains("yaw") ? number(object, "yaw", -100, 100) : 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const json& value = (*found)[i];
    if (!value.is_number()) throw std::runtime_error("p holds something that is not a number");
    const double m = value.get<double>();
    if (!(std::abs(m) <= kFarthest_m)) throw std::runtime_error("p is out of range");
    where.p_W[static_cast<Eigen::Index>(i)] = m;
  }
  return {where};
}

ShowRequest show(const json& object) {
  ShowRequest request;
  if (object.contains("contacts")) request.contacts = boolean(object, "contacts");
  if (object.contains("sensors"))
    request.sensors = static_cast<std::uint32_t>(number(object, "sensors", 0, 4294967295.0));
  return request;
}

Request read(const json& object) {
  const auto found = object.find("type");
  if (found == object.end() || !found->is_string()) throw std::runtime_error("type is missing");
  const auto& type = found->get_ref<const std::string&>();
  if (type == "drive") return drive(object);
  if (type == "look") return look(object);
  if (type == "show") return show(object);
  if (type == "ping") return PingRequest{number(object, "t", -1e15, 1e15)};
  if (type == "pause") return PauseRequest{boolean(object, "on")};
  if (type == "step") return StepRequest{number(object, "time", 1e-4, 60)};
  if (type == "speed") {
    const double value = number(object, "value", 0, 1000);
    if (value > 0 && value < 1e-3) throw std::runtime_error("value is out of range");
    return SpeedRequest{value};
  }
  if (type == "reset") return ResetRequest{};
  if (type == "place") return place(object);
  if (type == "take") return TakeRequest{robot(object)};
  if (type == "let-go") return LetGoRequest{robot(object)};
  if (type == "remove") return RemoveRequest{robot(object)};
  throw std::runtime_error("an unknown type");
}

}  // namespace

std::variant<Request, std::string> parse_request(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return "not a JSON object";
  try {
    return read(object);
  } catch (const std::runtime_error& error) {
    return std::string(error.what());
  }
}

}  // namespace kenaf::live
