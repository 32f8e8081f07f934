// Runs a scene in the process of the test and reads its results file.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace traverse::test {

using Values = std::vector<std::pair<std::string, std::string>>;

/// The datasets of a results file. Each is read completely at its first use.
class Results {
 public:
  explicit Results(std::string file) : file_(std::move(file)) {}
  /// All values of a dataset in row-major order; throws std::runtime_error if it does not exist.
  const std::vector<double>& operator()(const std::string& name);
  /// Column c of a dataset whose rows are the stored instants.
  std::vector<double> column(const std::string& name, std::size_t c = 0);
  std::vector<double> time() { return (*this)("/time"); }
  double attribute(const std::string& object, const std::string& name) const;
  const std::string& file() const { return file_; }

 private:
  std::string file_;
  std::map<std::string, std::vector<double>> read_;
};

/// The number of instants in a results file, also while a run writes it; 0 before the first instant, and while the file
/// cannot be read.
std::size_t stored_instants(const std::string& file);

/// Collective over comm. Runs options/scenes/NAME.yml (or a path that ends in .yml) with additional options, given as
/// names without dash and values. The results file is temporary. Exceptions of the program are not caught.
Results run_scene(const std::string& name, const Values& options = {}, MPI_Comm comm = MPI_COMM_WORLD);
/// Runs a scene given as YAML text.
Results run_yaml(const std::string& text, const Values& options = {}, MPI_Comm comm = MPI_COMM_WORLD);

/// The residual of the energy balance over the largest of its terms.
double energy_error(Results& run);

/// The value of largest magnitude, and its index.
std::pair<double, std::size_t> peak(const std::vector<double>& values);
/// Largest |a - b| over largest |b|.
double relative_difference(const std::vector<double>& a, const std::vector<double>& b);
/// The rows of a comma-separated file with two or more columns of numbers and # comments.
std::vector<std::vector<double>> read_table(const std::string& file);

}  // namespace traverse::test
