// EN 1991-2, 6.4.6.5: the worse of (1 + phi'_dyn + phi''/2) times the static effect of a train and of Phi times that of
// LM71, or of SW/0 on continuous bridges; and what limits ask of LM71.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "norm/static_effects.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {

/// What the runs of one train have shown: the peaks of deflection (m) and moment (N m), magnitudes, [speed][probe].
struct PassedTrain {
  std::vector<double> deflection, moment;
};
struct Passed {
  std::vector<double> speeds, probes;  // m/s, m
  std::vector<PassedTrain> trains;     // in the order of the loads that are trains
};

/// phi'_dyn = max |dynamic/static| - 1, not below 0, of one train and effect: over all speeds, and the probes with at
/// least a quarter of its greatest static effect, since nearer to supports and points of contraflexure two small
/// numbers are compared.
struct DynamicFactor {
  double value = 0.0, speed = 0.0, x = 0.0;  // m/s, m
};

class NormCheck {
 public:
  /// The loads are the trains, then the rules' load models, with SW/0 beside LM71 on continuous bridges.
  NormCheck(const beam::BeamModel& model, const options::NormRules& rules, std::vector<LoadModel> trains,
            const std::vector<double>& probes);

  /// Judges trains whose runs are known: 6.4.6.5. Runs that have not ended are NaN.
  void judge(const Passed& passed);
  /// One effect: the train that is worst, LM71 or SW/0, and which of the two governs.
  struct Row {
    Effect effect = Effect::deflection;
    std::size_t train = 0, model = 0;  // loads
    DynamicFactor dynamic;
    double of_train = 0.0, train_x = 0.0;  // (1 + phi'_dyn + phi''/2) times static
    double of_model = 0.0, model_x = 0.0;  // Phi times alpha times static
    double static_train = 0.0, static_model = 0.0;

    double ratio() const { return of_train / of_model; }
  };
  const std::vector<Row>& rows() const { return rows_; }
  const StaticEffects& effects() const { return effects_; }

  /// Puts findings in the place of those of limits that static effects find.
  void find(std::vector<results::Verdict>& verdicts) const;
  void print() const;
  /// /static and /norm of the file.
  void record(results::Recorder& recorder) const;

 private:
  double length_at(const Place& place) const;
  double phi_at(const Place& place) const;
  double factor(std::size_t load, const Place& place) const;
  DynamicFactor dynamic_factor(const Passed& passed, std::size_t train, Effect effect) const;
  results::EvaluatedQuantity of_lm71(Effect effect, bool over_span) const;
  results::EvaluatedQuantity of_trains() const;
  std::string length_text() const;
  void print_static() const;
  void print_rows() const;

  options::NormRules rules_;
  std::vector<double> lengths_;  // L_Phi of each span, m
  double n0_ = 0.0;              // Hz
  double speed_ = 0.0;           // m/s, the greatest that was run; 0: none
  std::size_t trains_ = 0;       // loads that are; the others are load models
  std::vector<std::string> models_;
  StaticEffects effects_;
  std::vector<Row> rows_;
};

}  // namespace traverse::norm
