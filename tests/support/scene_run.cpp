// Runs a scene within the test's process by temporary files, reads datasets and attributes from HDF5, and computes
// peaks and relative differences.
#include "support/scene_run.hpp"

#include <hdf5.h>
#include <petscsys.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "base/petsc.hpp"
#include "support/folders.hpp"
#include "traverse/app/run.hpp"
#include "traverse/options/input.hpp"

namespace traverse::test {
namespace {

// Removes the temporary files after the tests.
struct Cleaner {
  ~Cleaner() {
    std::error_code ignored;
    for (const std::string& file : files) std::filesystem::remove(file, ignored);
  }
  std::vector<std::string> files;
};

std::string temporary(const std::string& ending) {
  static Cleaner cleaner;
  static int count = 0;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  cleaner.files.push_back(
      (std::filesystem::temp_directory_path() / ("traverse_test_" + std::to_string(getpid()) + "_" +
                                                 std::to_string(rank) + "_" + std::to_string(++count) + ending))
          .string());
  return cleaner.files.back();
}

Results run_words(std::vector<std::string> words, MPI_Comm comm) {
  std::string file = temporary(".h5");
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  int length = static_cast<int>(file.size());  // every rank names rank 0's file
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  file.resize(static_cast<std::size_t>(length));
  MPI_Bcast(file.data(), length, MPI_CHAR, 0, comm);
  words.insert(words.end(), {"-output_file", file, "-output_quiet", "true", "-accuracy_cache", "false"});
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) words.insert(words.begin() + 1, {"-step_ranks", "all"});  // unless the test sets another value
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  base::check(PetscOptionsClear(nullptr));
  options::Input input = options::read_input(static_cast<int>(argv.size()), argv.data());
  options::put_into_petsc(input);
  app::run(comm, scene::read_scene());
  MPI_Barrier(comm);
  return Results(file);
}

void add(std::vector<std::string>& words, const Values& options) {
  for (const auto& [name, value] : options) {
    words.push_back("-" + name);
    words.push_back(value);
  }
}

}  // namespace

Results run_scene(const std::string& name, const Values& options, MPI_Comm comm) {
  const bool path = name.size() > 4 && name.substr(name.size() - 4) == ".yml";
  std::vector<std::string> words = {"traverse", "-options_file",
                                    path ? name : source_folder() + "/options/scenes/" + name + ".yml"};
  add(words, options);
  return run_words(words, comm);
}

Results run_yaml(const std::string& text, const Values& options, MPI_Comm comm) {
  const std::string file = temporary(".yml");
  std::ofstream(file) << text;
  Results results = run_scene(file, options, comm);
  std::filesystem::remove(file);
  return results;
}

const std::vector<double>& Results::operator()(const std::string& name) {
  auto found = read_.find(name);
  if (found != read_.end()) return found->second;
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error("no results file " + file_);
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (set < 0) {
    H5Fclose(file);
    throw std::runtime_error("no dataset " + name + " in " + file_);
  }
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  const herr_t status = H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  if (status < 0) throw std::runtime_error("cannot read " + name);
  return read_[name] = std::move(values);
}

std::vector<double> Results::column(const std::string& name, std::size_t c) {
  const std::size_t rows = (*this)("/time").size();
  const std::vector<double>& values = (*this)(name);
  const std::size_t columns = values.size() / rows;
  std::vector<double> out(rows);
  for (std::size_t i = 0; i < rows; ++i) out[i] = values[i * columns + c];
  return out;
}

double Results::attribute(const std::string& object, const std::string& name) const {
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  double value = std::nan("");
  if (attribute >= 0) {
    H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(attribute);
  }
  H5Fclose(file);
  return value;
}

std::size_t stored_instants(const std::string& file) {
  const std::string copy = temporary(".copy.h5");  // the run has locked its own file
  std::error_code failed;
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing, failed);
  if (failed) return 0;
  hssize_t instants = 0;
  H5E_BEGIN_TRY {  // HDF5 prints no message on objects that do not exist yet
    const hid_t opened = H5Fopen(copy.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t time = H5Dopen2(opened, "/time", H5P_DEFAULT);
    const hid_t space = H5Dget_space(time);
    instants = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    H5Dclose(time);
    H5Fclose(opened);
  }
  H5E_END_TRY
  std::filesystem::remove(copy, failed);
  return instants > 0 ? static_cast<std::size_t>(instants) : 0;
}

double energy_error(Results& run) {
  double scale = 0.0;
  for (const char* term : {"kinetic", "strain", "potential", "work", "dissipated"})
    scale = std::max(scale, std::abs(peak(run(std::string("/energy/") + term)).first));
  return std::abs(peak(run("/energy/residual")).first) / scale;
}

std::pair<double, std::size_t> peak(const std::vector<double>& values) {
  const auto at =
      std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return {*at, static_cast<std::size_t>(at - values.begin())};
}

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) throw std::runtime_error("series of different lengths");
  double difference = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return scale > 0.0 ? difference / scale : difference;
}

std::vector<std::vector<double>> read_table(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("no file " + file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value; words >> value;) row.push_back(value);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace traverse::test
