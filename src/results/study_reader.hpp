// What an interrupted study has left in its results file.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace traverse::results {

struct StoredStudy {
  std::map<std::string, std::string> options;           // that it was asked for
  std::map<std::string, std::vector<double>> datasets;  // of /study, without the folder: coordinates and results
  std::map<std::string, std::string> texts;             // attributes of /study
  std::map<std::string, double> numbers;
};

/// Empty where there is no file, or none with a study. FileError where it cannot be read.
StoredStudy read_study(const std::string& path);

}  // namespace traverse::results
