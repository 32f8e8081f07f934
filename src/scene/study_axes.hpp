// The axes of a study: combines listed and drawn dimensions by study_combine, and gives the factors of a sensitivity
// analysis the values of its design.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traverse/options/options.hpp"
#include "traverse/options/study.hpp"
#include "vary_reader.hpp"

namespace traverse::scene {

class StudyAxes {
 public:
  /// Fills the axes and dimensions of `study`. Both must outlive this object.
  StudyAxes(const options::Options& o, options::Study& study);

  /// Adds a dimension with `count` listed values, or with draws from them.
  void add_listed(options::StudyDimension dimension, double count);
  /// Adds a dimension whose values are drawn, or are set by a design.
  void add_drawn(options::StudyDimension dimension, const VaryReader& reader);
  /// Gives the factors of a sensitivity analysis the values of its design.
  void finish_design();
  /// The number of all runs, which may be too great for an integer, and its factors in words.
  double runs() const { return runs_; }
  /// The allowed number. A sensitivity analysis stores the points of its design only.
  double most_runs() const { return study_.sensitivity ? 1e8 : VaryReader::most_values; }
  const std::string& sizes() const { return sizes_; }

 private:
  static constexpr double tail = 0.025;  // of a distribution, outside the range of elementary effects

  void add_factor(options::StudyDimension dimension, const VaryReader& reader);
  /// The values of factor i at the points of a design in the unit cube.
  std::vector<double> values_of(const VaryReader& reader, const std::vector<double>& cube, std::size_t i,
                                std::size_t factors) const;
  /// The values of factor i for central differences about the means.
  static std::vector<double> local_values(const VaryReader& reader, std::size_t i, std::size_t factors);
  std::size_t draws(const std::string& dimension) const;
  /// Assigns a dimension to the shared axis.
  void merge(const char* name, std::size_t length, options::StudyDimension& dimension);
  void draw_from_list(options::StudyDimension& dimension) const;

  const options::Options& o_;
  options::Study& study_;
  std::string combine_, sizes_;
  std::uint64_t seed_ = 1;
  std::size_t draws_ = 0;
  double runs_ = 1.0;
  std::optional<std::size_t> joint_;  // the axis that several dimensions share
  std::size_t first_factor_ = 0;      // dimension of the first factor of a sensitivity analysis
  std::vector<VaryReader> readers_;   // of its factors
};

}  // namespace traverse::scene
