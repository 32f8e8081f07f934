// Prints what a machine's messages and memory are worth to a step of many ranks: latencies, bandwidths, rates.
//   mpirun -n 2 build/benchmarks/machine_benchmark [FILE.csv [ROUNDS]]; also with other numbers of ranks.
//   benchmarks/scaling.py reads it.
//
// Medians over ROUNDS (21), by the clock. One message: half of a ping-pong between the first two ranks. Memory: a[i] =
// b[i]
// + s c[i] on every rank at once, far beyond the caches, 24 bytes an entry read and written.

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace {

int rounds = 21;

int rank_of() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int size_of() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// s of one, on rank 0.
double median_time(int times, const std::function<void()>& work) {
  std::vector<double> taken;
  for (int round = 0; round < rounds; ++round) {
    MPI_Barrier(MPI_COMM_WORLD);
    const double start = MPI_Wtime();
    for (int i = 0; i < times; ++i) work();
    taken.push_back((MPI_Wtime() - start) / times);
  }
  std::nth_element(taken.begin(), taken.begin() + rounds / 2, taken.end());
  return taken[static_cast<std::size_t>(rounds) / 2];
}

double message(int doubles, int times) {
  std::vector<double> data(static_cast<std::size_t>(doubles), 1.0);
  const int rank = rank_of();
  if (size_of() < 2) return 0.0;
  return 0.5 * median_time(times, [&] {
           if (rank > 1) return;
           if (rank == 0) MPI_Send(data.data(), doubles, MPI_DOUBLE, 1, 0, MPI_COMM_WORLD);
           MPI_Recv(data.data(), doubles, MPI_DOUBLE, 1 - rank, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
           if (rank == 1) MPI_Send(data.data(), doubles, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD);
         });
}

double allreduce(int doubles, int times) {
  std::vector<double> data(static_cast<std::size_t>(doubles), 1.0);
  return median_time(times, [&] {
    std::fill(data.begin(), data.end(), 1.0);
    MPI_Allreduce(MPI_IN_PLACE, data.data(), doubles, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  });
}

double allgather(int doubles, int times) {
  std::vector<double> own(static_cast<std::size_t>(doubles), 1.0),
      all(own.size() * static_cast<std::size_t>(size_of()));
  return median_time(
      times, [&] { MPI_Allgather(own.data(), doubles, MPI_DOUBLE, all.data(), doubles, MPI_DOUBLE, MPI_COMM_WORLD); });
}

/// B/s of each rank.
double memory() {
  constexpr std::size_t count = 8'000'000;
  std::vector<double> a(count, 1.0), b(count, 2.0), c(count, 3.0);
  const double time = median_time(1, [&] {
    const double factor = a[0];
    for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + factor * c[i];
    MPI_Barrier(MPI_COMM_WORLD);
  });
  return 24.0 * static_cast<double>(count) / time;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  if (argc > 2) rounds = std::max(1, std::atoi(argv[2]));
  std::ofstream table;
  if (argc > 1 && rank_of() == 0) table.open(argv[1]);
  table << "what,ranks,value,unit\n";
  const auto note = [&](const std::string& what, double value, const char* unit) {
    if (rank_of() != 0) return;
    std::printf("%-34s %12.4g %s\n", what.c_str(), value, unit);
    table << what << ',' << size_of() << ',' << value << ',' << unit << '\n';
  };
  note("memory of each rank", memory(), "B/s");
  if (size_of() > 1) {
    constexpr int large = 1 << 20;
    note("message of 8 B", message(1, 2000), "s");
    note("message of 1 kB", message(128, 2000), "s");
    note("bandwidth of 8 MB messages", 8.0 * large / message(large, 3), "B/s");
    note("allreduce of 8 B", allreduce(1, 2000), "s");
    note("allreduce of 4 kB", allreduce(512, 500), "s");
    note("allgather of 256 B from each", allgather(32, 2000), "s");
  }
  MPI_Finalize();
  return 0;
}
