// Reads what an interrupted study or screen has stored in its results file.
#pragma once

#include <mpi.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::results {

struct StoredStudy {
  std::map<std::string, std::string> options;  // options of the study
  std::map<std::string, std::vector<double>>
      datasets;                              // datasets of /study by their names in this group: coordinates and results
  std::map<std::string, std::string> texts;  // attributes of /study
  std::map<std::string, double> numbers;

  void keep(base::Bytes& bytes);
};

/// A digest of each run's row of results, in the order of the columns: a number below 2^53. datasets: the stored
/// datasets.
std::vector<double> row_digests(const std::map<std::string, std::vector<double>>& datasets);
inline constexpr const char* row_digest = "row_digest";  // the name of its dataset

/// Reads the study of a file; empty if there is no file or the file has no study. FileError if it cannot be read, or if
/// its rows differ from the rows that were written.
StoredStudy read_study(const std::string& path);
/// Options, datasets and attributes of another group, such as "/screen", in the same form.
StoredStudy read_group(const std::string& path, const std::string& group);

/// Collective. Rank 0 reads the stored rows of what `option` continues (study_resume). `read` returns the reason why
/// the file contains others ("other runs"), or an empty text. For a reason, or an error, InputError on all ranks; `all`
/// is what is computed without the option: "all runs are".
void read_to_resume(MPI_Comm comm, const std::string& option, const std::string& file, const std::string& others,
                    const std::string& all, const std::function<std::string()>& read);

}  // namespace traverse::results
