// EN 1991-2, 6.4.6.5: the larger of two effects, (1 + phi'_dyn + phi''/2) times the static effect of a train, and Phi
// times the static effect of LM71, or of SW/0 on continuous bridges. Also the limited quantities of LM71.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "norm/static_bridge.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {

/// Results of the runs of one train: the peaks of deflection (m) and moment (N m), magnitudes, [speed][probe].
struct TrainPeaks {
  std::vector<double> deflection, moment;
};
struct ComputedPeaks {
  std::vector<double> speeds, probes;  // m/s, m
  std::vector<TrainPeaks> trains;      // in the order of the loads that are trains
};

/// phi'_dyn = max |dynamic/static| - 1 of one train and effect, not below 0: over all speeds, and over the probes with
/// at least a quarter of its greatest static effect, because the ratio of two small numbers near supports and points of
/// contraflexure is meaningless.
struct DynamicFactor {
  double value = 0.0, speed = 0.0, x = 0.0;  // m/s, m
};

class NormCheck {
 public:
  /// The loads are the trains, then the rules' load models; on continuous bridges SW/0 is added to LM71.
  /// eccentricities: of each probe, m; those of other tracks than that of the trains are not compared. Empty: all are
  /// on it.
  NormCheck(const beam::BeamModel& model, const options::NormRules& rules, std::vector<LoadModel> trains,
            const std::vector<double>& probes, std::vector<double> eccentricities = {});

  /// Compares trains with computed runs by 6.4.6.5. Values of incomplete runs are NaN.
  void compare(const ComputedPeaks& computed);
  /// One effect: the governing train, LM71 or SW/0, and the ratio of both.
  struct Row {
    Effect effect = Effect::deflection;
    std::size_t train = 0, model = 0;  // indices of loads
    DynamicFactor dynamic;
    double of_train = 0.0, train_x = 0.0;  // (1 + phi'_dyn + phi''/2) times static
    double of_model = 0.0, model_x = 0.0;  // Phi times alpha times static
    double static_train = 0.0, static_model = 0.0;

    double ratio() const { return of_train / of_model; }
  };
  const std::vector<Row>& rows() const { return rows_; }
  const StaticEffects& effects() const { return effects_; }

  /// Sets the quantities of the limits that follow from static effects.
  void find(std::vector<results::Verdict>& verdicts) const;
  void print() const;
  /// /static and /norm of the results file.
  void record(results::Recorder& recorder) const;

 private:
  double length_at(const Place& place) const;
  double phi_at(const Place& place) const;
  double alpha(std::size_t load) const;
  double factor(std::size_t load, const Place& place) const;
  bool is_beside_the_trains(std::size_t probe) const;
  DynamicFactor dynamic_factor(const ComputedPeaks& computed, std::size_t train, Effect effect) const;
  results::EvaluatedQuantity of_lm71(Effect effect, bool over_span) const;
  results::EvaluatedQuantity of_trains() const;
  std::string length_text() const;
  void print_static() const;
  void print_rows() const;

  std::vector<double> eccentricities_;  // m, of the probes
  double track_ = 0.0;                  // m: that of the track of the trains
  options::NormRules rules_;
  std::vector<double> lengths_;  // L_Phi of each span, m
  double n0_ = 0.0;              // Hz
  double speed_ = 0.0;           // m/s, greatest speed of the runs; 0: there are no runs
  std::size_t trains_ = 0;       // number of loads that are trains; the others are load models
  std::vector<std::string> models_;
  StaticEffects effects_;
  std::vector<Row> rows_;
};

}  // namespace traverse::norm
