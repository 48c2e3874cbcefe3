// Shapes of sensors' messages that clients depend on. "Recorded": by a UT2004 server in 2007.
#include "server/world_server/report.hpp"
#include "server/world_server/scan_angles.hpp"
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

physics::SensorDescription gps() {
  physics::SensorDescription sensor{};
  sensor.type = physics::SensorType::gps;
  sensor.name = "GPS";
  return sensor;
}

std::string message_of(Dialect dialect, const physics::SensorDescription& sensor, const physics::Reading& reading) {
  std::vector<physics::SensorSample> samples{{0, 3104.5749, reading}};
  std::string out;
  write_samples(samples, {sensor}, dialect, formats_of(dialect), false, out);
  return out;
}

// As clients count the values of a scan: the text's numbers, in single or in double precision.
template <typename Number>
std::size_t values_counted(std::string_view line) {
  const auto resolution = static_cast<Number>(number_in(line, "Resolution"));
  const auto field_of_view = static_cast<Number>(number_in(line, "FOV"));
  return static_cast<std::size_t>(static_cast<int>(field_of_view / resolution) + 1);
}

std::size_t values_sent(const std::string& line) {
  const std::size_t range = line.find("{Range ");
  return static_cast<std::size_t>(std::count(line.begin() + static_cast<std::ptrdiff_t>(range), line.end(), ',')) + 1;
}

physics::SensorDescription scanner(double field_of_view_rad, double resolution_rad) {
  physics::SensorDescription sensor{};
  sensor.type = physics::SensorType::range_scanner;
  sensor.name = "Scanner1";
  sensor.field_of_view_rad = field_of_view_rad;
  sensor.resolution_rad = resolution_rad;
  return sensor;
}

}  // namespace

TEST_CASE("UT2004's GPS has no time, and without a fix neither latitude nor longitude, as recorded") {
  CHECK(message_of(Dialect::ut2004, gps(), physics::GpsReading{0, 0, 0, false}) ==
        "SEN {Type GPS} {Name GPS} {Fix 0} {Satellites 0}\r\n");
}

// A client takes the third group for the latitude, the fourth for the longitude and the last for the satellites.
TEST_CASE("UT2004's GPS with a fix tells latitude and longitude before it") {
  CHECK(message_of(Dialect::ut2004, gps(), physics::GpsReading{39 + 8.03 / 60, -(77 + 13.0 / 60), 11, true}) ==
        "SEN {Type GPS} {Name GPS} {Latitude 39,8.0300,N} {Longitude 77,13.0000,W} {Fix 1} {Satellites 11}\r\n");
}

TEST_CASE("A scan of 181 values over half a turn has the angles that were recorded") {
  const physics::SensorDescription sick = scanner(3.14159265, 0.01745329);
  physics::RangeScanReading reading;
  reading.range_m.assign(sick.scan_values(), 2);
  CHECK(sick.scan_values() == 181);
  CHECK(message_of(Dialect::ut2004, sick, reading)
            .starts_with("SEN {Time 3104.57} {Type RangeScanner} {Name Scanner1} {Resolution 0.0174} {FOV 3.1415} "
                         "{Range 2.0000,2.0000,"));
}

TEST_CASE("A scan's field of view over its resolution counts its values") {
  for (const auto& [field_of_view_rad, resolution_rad] : {std::pair{3.14159265, 0.01745329},
                                                          {4.71238898, 0.00872665},
                                                          {4.189, 0.0184},
                                                          {4.712, 0.00436},
                                                          {1.8, 0.01},
                                                          {0.3, 0.1},
                                                          {6.28318530, 0.0058177},
                                                          {1.0, 0.003},
                                                          {2.0, 1.0},
                                                          {6.283, 0.001}}) {
    INFO(field_of_view_rad << " / " << resolution_rad);
    const physics::SensorDescription sensor = scanner(field_of_view_rad, resolution_rad);
    physics::RangeScanReading reading;
    reading.range_m.assign(sensor.scan_values(), 1);
    for (const Dialect dialect : {Dialect::ut2004, Dialect::udk}) {
      std::string line = message_of(dialect, sensor, reading);
      line.resize(line.size() - 2);
      CHECK(values_sent(line) == sensor.scan_values());
      CHECK(values_counted<double>(line) == sensor.scan_values());
      CHECK(values_counted<float>(line) == sensor.scan_values());
      CHECK(number_in(line, "FOV") == Approx(field_of_view_rad).margin(1e-4));
      CHECK(number_in(line, "Resolution") == Approx(resolution_rad).epsilon(0.01).margin(1e-4));
    }
  }
}

TEST_CASE("Every shipped scanner's values are counted by its angles, also by those of CONF") {
  for (const char* class_name : {"Kenaf", "P2AT", "P2DX", "P3AT", "Husky", "Jackal", "Warthog"}) {
    INFO(class_name);
    Conversation talk;
    talk.send("INIT {ClassName USARBot." + std::string(class_name) + "} {Location 0,0,0}\r\n");
    REQUIRE(talk.session->robot);
    talk.simulation.advance(talk.wall_s);
    for (const std::string& line : talk.lines()) {
      if (line.find("{Type RangeScanner}") == std::string::npos) continue;
      CHECK(values_counted<double>(line) == values_sent(line));
      const std::string conf = talk.answer_to("GETCONF {Type RangeScanner}\r\n");
      CHECK(number_in(conf, "Resolution") == number_in(line, "Resolution"));
      CHECK(number_in(conf, "Fov") == number_in(line, "FOV"));
    }
  }
}

TEST_CASE("A single ray has its own angles, and a Session's precision is kept") {
  const ScanAngles ray = scan_angles(scanner(0.001, 0.01), {4, true});
  CHECK(ray.resolution_rad == 0.01);
  CHECK(ray.field_of_view_rad == 0.001);
  const ScanAngles precise = scan_angles(scanner(4.71238898, 0.00872665), {8, false});
  CHECK(precise.resolution_rad == 0.00872665);
  CHECK(precise.format.decimals == 8);
}

TEST_CASE("A P2AT's sonars are one line of UT2004's: eight in front, F1 to F8, eight behind, R1 to R8") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2AT} {Location 0,0,0}\r\n");
  talk.simulation.advance(talk.wall_s);
  const std::vector<std::string> sonars = talk.lines("SEN {Time 0.0000} {Type Sonar} ");
  REQUIRE(sonars.size() == 1);
  CHECK(sonars[0].size() + 2 < 1024);
  std::size_t at = 0;
  for (const char side : {'F', 'R'}) {
    for (const char number : std::string_view("12345678")) {
      const std::string group = std::string("{Name ") + side + number + " Range ";
      INFO(group);
      const std::size_t found = sonars[0].find(group);
      REQUIRE(found != std::string::npos);
      CHECK(found > at);
      at = found;
    }
  }
}

TEST_CASE("A P2DX's sonars are one line, F1 to F8, as recorded") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2DX} {Location 4.5,1.9,1.8} {Name R1}\r\n");
  talk.simulation.advance(talk.wall_s);
  const std::string sonars = talk.last("SEN {Time 0.0000} {Type Sonar} {Name F1 Range ");
  CHECK(std::ranges::count(sonars, '{') == 10);  // Time, Type and eight
  CHECK(sonars.find("{Name F8 Range ") != std::string::npos);
}

}  // namespace kenaf::world_server
