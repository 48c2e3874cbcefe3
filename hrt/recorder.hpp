// Records cycles into a kenaf-runs/1 CSV file. A thread of its own writes, so that no cycle waits for the disk.
#pragma once

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "hrt/transport.hpp"
#include "robot/columns.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {

// A value for each column that the robot records, in the order of robot::columns().
inline constexpr std::size_t kRecordColumns =
    static_cast<std::size_t>(std::ranges::count_if(robot::columns(), &robot::Column::by_robot));
using RecordRow = std::array<double, kRecordColumns>;
std::vector<std::string> record_columns();

// One row: `state` with the command that is in force from its time on. NaN where nothing was measured since the state
// before.
RecordRow record_row(const robot::State& state, const DriveCommand& command, double t_s);

// Thread safety: add() belongs to one thread at a time; finish() comes after the last add().
class Recorder {
 public:
  // 2^13 rows are 82 s of 10 ms cycles: longer than a disk is busy, 3 MB of memory.
  static constexpr std::size_t kQueueRows = 8192;

  // Throws Error(HRT_E_RECORD) where the file cannot be made. `wait_when_full`: add() may wait for the disk, since
  // robot time waits too; otherwise a row that finds the queue full is lost and counted.
  Recorder(const std::string& path, bool wait_when_full);
  ~Recorder();  // finishes; errors are lost then. Without a row the file is not made, and one of its name stays

  // `t_s`: an Estimate's, because the clock of `state` may be put back. Time in the file counts from the first state
  // added. A state no later than the one before is left out.
  void add(const robot::State& state, const DriveCommand& command, double t_s);

  // Writes what is queued and closes the file. Throws Error(HRT_E_RECORD): not whole, with the reason; what there is
  // stays in the part file.
  void finish();

 private:
  void write_rows();

  std::string path_;
  bool wait_when_full_;
  std::unique_ptr<runs::RunWriter> writer_;  // until finish()
  std::mutex mutex_;
  std::condition_variable row_added_, row_taken_;
  std::vector<RecordRow> queue_;  // a ring of kQueueRows
  std::size_t first_ = 0, count_ = 0, lost_ = 0;
  bool ended_ = false;
  bool started_ = false;
  double start_t_s_ = 0, last_t_s_ = 0;
  std::string failure_;
  std::thread thread_;
};

}  // namespace kenaf::hrt
