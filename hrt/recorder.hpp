// Records cycles into a kenaf-runs/1 CSV file. Its own thread writes, so that no cycle waits for the disk.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "hrt/transport.hpp"
#include "robot/columns.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {

// One value for each column that the robot records, in the order of robot::columns().
inline constexpr std::size_t kRecordColumns =
    static_cast<std::size_t>(std::ranges::count_if(robot::columns(), &robot::Column::by_robot));
using RecordRow = std::array<double, kRecordColumns>;
std::vector<std::string> record_columns();

// Returns one row: `state` with the command in force from its time on. NaN if a quantity was not measured since the
// previous state.
RecordRow record_row(const robot::State& state, const robot::Command& command, double t_s);

// Thread safety: add() is for one thread at a time, and neither locks nor allocates; trouble() and is_writing() are for
// any thread; finish() must follow the last add().
class Recorder {
 public:
  // 2^13 rows are 82 s of 10 ms cycles: longer than a disk stalls, 3 MB of memory.
  static constexpr std::size_t kQueueRows = 8192;

  // Throws Error(HRT_E_RECORD) if the file cannot be created. `wait_when_full`: add() may wait for the disk, because
  // robot time waits too; otherwise a row that finds the queue full is dropped and counted.
  Recorder(const std::string& path, bool wait_when_full);
  ~Recorder();  // finishes, ignoring errors. Without a row no file is made, and an existing one stays

  // `t_s`: from an Estimate, because the clock of `state` may be set back. Time in the file counts from the first state
  // added. A state no later than the previous one is skipped.
  void add(const robot::State& state, const robot::Command& command, double t_s);

  // Says at once what has made the recording incomplete, with the file: a row that could not be written (a full disk),
  // or rows that found the queue full; "" while it is whole.
  std::string trouble() const;
  // False from the first row on that could not be written: no later one is.
  bool is_writing() const { return !broken_.load(std::memory_order_acquire); }

  // Writes the queued rows and closes the file. Throws Error(HRT_E_RECORD) with the reason if the file is incomplete;
  // the rows written so far stay in the part file.
  void finish();

 private:
  void write_rows();
  std::string lost_rows() const;

  std::string path_;
  bool wait_when_full_;
  std::unique_ptr<runs::RunWriter> writer_;  // until finish()

  // A ring buffer between two threads: add() fills queue_[added_ % kQueueRows] and then counts it in added_, the writer
  // does the same with taken_. So each index is stored by one thread only, and a row is seen whole.
  std::vector<RecordRow> queue_;
  std::atomic<std::uint32_t> added_ = 0, taken_ = 0;
  std::atomic<std::uint32_t> wake_ = 0;  // changes with each row and at the end: the writer sleeps on it
  std::atomic<bool> ended_ = false;
  std::atomic<std::uint64_t> lost_ = 0;

  // of add()
  bool started_ = false;
  double start_t_s_ = 0, last_t_s_ = 0;

  // The writer stores failure_ once, before broken_; until then nobody reads it.
  std::string failure_;
  std::atomic<bool> broken_ = false;
  std::thread thread_;
};

}  // namespace kenaf::hrt
