// What an interrupted study has left in its results file.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::results {

struct StoredStudy {
  std::map<std::string, std::string> options;           // that it was asked for
  std::map<std::string, std::vector<double>> datasets;  // of /study, without the folder: coordinates and results
  std::map<std::string, std::string> texts;             // attributes of /study
  std::map<std::string, double> numbers;

  void keep(base::Bytes& bytes);
};

/// A digest of each run's row of results, in the order of the columns: a number below 2^53. Datasets as they are
/// stored.
std::vector<double> row_digests(const std::map<std::string, std::vector<double>>& datasets);
inline constexpr const char* row_digest = "row_digest";  // the name of its dataset

/// Empty where there is no file, or none with a study. FileError where it cannot be read, or its rows are not those
/// that were written.
StoredStudy read_study(const std::string& path);

}  // namespace traverse::results
