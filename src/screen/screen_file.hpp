// The results file of a screen: a row for each bridge, written as it is finished, so that an interrupted screen can be
// continued.
#pragma once

#include <mpi.h>

#include <map>
#include <string>
#include <vector>

#include "results/place.hpp"
#include "results/recorder.hpp"
#include "screen/fleet.hpp"
#include "screen/screen_table.hpp"
#include "screen/stock.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::screen {

/// A screen with everything that was read.
struct Problem {
  const scene::Scene& scene;
  std::vector<Bridge> stock;
  std::vector<Formation> fleet;
  std::string digest;
  std::vector<std::string> notes;  // on how the tables are written
};

/// Reads and checks stock and fleet. InputError.
Problem read_problem(const scene::Scene& scene);

/// Collective. With screen_resume: on rank 0 the finished rows of the results file, by the index of their bridge;
/// otherwise none. InputError if the file belongs to another screen.
std::map<std::size_t, std::vector<double>> stored_rows(MPI_Comm comm, const Problem& problem);

class ScreenFile {
 public:
  /// Collective. Creates the file; rows: those that are known, which are written and removed.
  ScreenFile(MPI_Comm comm, results::Place place, const Problem& problem, const std::vector<std::string>& notes,
             std::map<std::size_t, std::vector<double>>& rows, Totals& totals);
  /// Writes a finished row. If the disk is full, all ranks end with FileError.
  void put(std::size_t bridge, const std::vector<double>& row);
  /// Writes what governs, and the summary with further attributes. FileError.
  void finish(const Totals& totals, std::size_t bridges, double seconds, const std::string& ended,
              const std::vector<results::Attribute>& further);

 private:
  void write(std::size_t bridge, const std::vector<double>& row);

  MPI_Comm comm_;
  std::size_t formations_;
  results::Recorder recorder_;
};

}  // namespace traverse::screen
