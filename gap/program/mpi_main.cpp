// kenaf-gap-mpi: runs kenaf-gap diagnose in several processes, on several machines.
//
//   mpirun -n 8 kenaf-gap-mpi diagnose DATASET --out DIR
//
// Every machine needs the dataset, the shipped data and the same build. The first process writes the reports. The exit
// status is that of kenaf-gap.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <vector>

#include "command_line/parse.hpp"
#include "gap/commands/commands.hpp"
#include "gap/ranks.hpp"

namespace {

namespace command_line = kenaf::command_line;
using kenaf::gap::Ranks;

constexpr int kBadInput = 2;

// Packs the results rank, rank + count, ... into one array: for each its size, then its values.
std::vector<double> packed(const std::vector<Eigen::VectorXd>& results, int rank, int count) {
  std::vector<double> numbers;
  for (auto j = static_cast<std::size_t>(rank); j < results.size(); j += static_cast<std::size_t>(count)) {
    numbers.push_back(static_cast<double>(results[j].size()));
    numbers.insert(numbers.end(), results[j].begin(), results[j].end());
  }
  return numbers;
}

void unpack(const double* numbers, std::vector<Eigen::VectorXd>& results, int rank, int count) {
  for (auto j = static_cast<std::size_t>(rank); j < results.size(); j += static_cast<std::size_t>(count)) {
    const auto size = static_cast<Eigen::Index>(*numbers++);
    results[j] = Eigen::Map<const Eigen::VectorXd>(numbers, size);
    numbers += size;
  }
}

// Gives all ranks the results of every one.
void share(std::vector<Eigen::VectorXd>& results, int rank, int count) {
  const std::vector<double> own = packed(results, rank, count);
  const int own_size = static_cast<int>(own.size());
  std::vector<int> sizes(static_cast<std::size_t>(count)), offsets(sizes.size(), 0);
  MPI_Allgather(&own_size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  for (std::size_t r = 1; r < sizes.size(); ++r) offsets[r] = offsets[r - 1] + sizes[r - 1];
  std::vector<double> all(static_cast<std::size_t>(offsets.back() + sizes.back()));
  MPI_Allgatherv(own.data(), own_size, MPI_DOUBLE, all.data(), sizes.data(), offsets.data(), MPI_DOUBLE,
                 MPI_COMM_WORLD);
  for (int r = 0; r < count; ++r)
    if (r != rank) unpack(all.data() + offsets[static_cast<std::size_t>(r)], results, r, count);
}

bool any(bool mine) {
  int sum = mine ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  return sum > 0;
}

// The rank by the variables that launchers set: PMIx (Open MPI, Slurm), PMI (MPICH, Intel MPI). Zero without them.
int announced_rank() {
  for (const char* variable : {"PMIX_RANK", "PMI_RANK"})
    if (const char* rank = std::getenv(variable)) return std::atoi(rank);
  return 0;
}

Ranks start_mpi() {
  MPI_Init(nullptr, nullptr);
  Ranks ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.count);
  ranks.share = [rank = ranks.rank, count = ranks.count](std::vector<Eigen::VectorXd>& results) {
    share(results, rank, count);
  };
  ranks.any = any;
  return ranks;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Diagnoses with several processes, started with mpirun", "kenaf-gap-mpi"};
  program.require_subcommand(1);
  // MPI is started when the command line is right: without mpirun it starts processes of its own, which help and wrong
  // use can do without.
  std::optional<Ranks> ranks;
  kenaf::gap::commands::add_diagnose_command(program, [&ranks] { return ranks.emplace(start_mpi()); });
  try {
    // All ranks have the same arguments; only one prints what is wrong.
    using command_line::Speaks;
    const auto status = command_line::parse(program, argc, argv, announced_rank() > 0 ? Speaks::no : Speaks::yes);
    if (status) return *status;
  } catch (const std::exception& error) {
    // An error may concern one rank only: a machine without the dataset, a full disk.
    const Ranks of_error = ranks.value_or(Ranks{});
    std::fprintf(stderr, "kenaf-gap-mpi: process %d of %d: %s\n", of_error.rank, of_error.count, error.what());
    std::fflush(stderr);
    if (!ranks) return kBadInput;
    MPI_Abort(MPI_COMM_WORLD, kBadInput);  // another rank may wait for this one's results
  }
  MPI_Finalize();
  return 0;
}
