// The computed counterparts of the measurements of a fit, as functions of its options.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/batch.hpp"
#include "run/shared_beam.hpp"
#include "traverse/options/fit.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::fit {

/// Mesh, step, modes and the instants of the samples are the same for all values of the options, so that the computed
/// values are smooth functions of the options.
class ForwardModel {
 public:
  /// Chooses the numerical model on this rank, the finest of those for the start and for all lowest and all highest
  /// values of the options. InputError if the scene of one of them cannot be computed. The scene must have a fit.
  ForwardModel(const scene::Scene& scene, std::vector<std::string>& notes);

  /// The options of the fit.
  const options::Entries& given() const { return given_.entries(); }
  /// The values at the start of the fit.
  std::vector<double> start() const;
  /// The duration of the run at the start of the fit, s.
  double duration() const { return duration_; }
  /// Sets the end of all runs, s. They have samples up to there.
  void set_end(double end);
  double interval() const { return interval_; }                     // s, between samples
  const std::vector<std::string>& units() const { return units_; }  // of the series
  std::size_t instants() const { return instants_; }

  /// For each point, one after another: the frequencies (Hz) of all measured frequencies, then the shapes of those that
  /// have one, at their places, and the samples of each series. Throws the error of the first run that fails or ends
  /// early, with its values.
  std::vector<std::vector<double>> run(const std::vector<std::vector<double>>& points) const;
  /// The number of points that are computed together.
  std::size_t width() const;
  std::size_t size() const { return fit_.modal_size() + fit_.series.size() * instants_; }

  /// The scene of the run or of the modes at these values, with the chosen model.
  scene::Scene scene(const std::vector<double>& values, bool modes) const;

 private:
  void choose(std::vector<std::string>& notes);
  /// Adds the values to the message of an error.
  void naming(const std::vector<double>& values, const std::function<void()>& compute) const;
  void set_interval();
  void find_lanes(const scene::Scene& scene, const run::SharedBeam& shared);
  void add_frequencies(const std::vector<double>& values, std::vector<double>& response) const;
  void add_series(const std::vector<double>& values, std::vector<double>& response) const;
  /// The series of all points, as runs in the lanes of batches.
  void add_series_in_lanes(const std::vector<std::vector<double>>& points,
                           std::vector<std::vector<double>>& responses) const;
  void add_samples(const std::vector<double>& samples, const scene::Scene& scene, double spacing,
                   std::vector<double>& response) const;

  const options::Options given_;
  const options::Fit fit_;
  std::string name_;
  std::vector<std::string> units_;
  scene::NumericalModel model_, model_of_modes_;
  double duration_ = 0.0, interval_ = 0.0, end_ = 0.0;
  std::size_t instants_ = 0;
  /// The stored responses of a batch, one for each series; empty: runs are computed one by one.
  std::vector<engine::Response> stored_;
  double step_speed_ = 0.0, fastest_ = 0.0;  // m/s: of the steps of all batches; of any point
};

}  // namespace traverse::fit
