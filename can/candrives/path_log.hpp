// True path of the simulated robot: a line of comma-separated values each 10 ms.
#pragma once

#include <fstream>
#include <functional>
#include <string>

#include "physics/world.hpp"

namespace kenaf::candrives {

inline constexpr double kPathPeriod_s = 0.01;

class PathLog {
 public:
  // Throws std::runtime_error if the file cannot be written.
  explicit PathLog(const std::string& file);
  ~PathLog();
  PathLog(const PathLog&) = delete;
  PathLog& operator=(const PathLog&) = delete;
  // Writes a line if a period has passed since the last; only then calls truth_now. If the file can no longer be
  // written, reports it once on stderr and skips the rest: the drives continue.
  void write(double t_s, const std::function<physics::RobotTruth()>& truth_now);

 private:
  void flush();

  const std::string name_;
  std::ofstream file_;
  double next_s_ = 0;
  int lines_ = 0;
  bool failure_reported_ = false;
};

}  // namespace kenaf::candrives
