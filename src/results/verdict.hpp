// The verdicts of a run on the limits of the user.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "traverse/options/verdict_limit.hpp"

namespace traverse::results {

/// The greatest value of a quantity in a run, or the reason why it is unknown.
struct EvaluatedQuantity {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double value = unknown;  // a magnitude
  double time = unknown;   // s
  double x = unknown;      // m, a place on the bridge
  std::string thing{};     // another object: "vehicle 3, rear_wheel"; "train A3 at 64 m/s (230 km/h)"
  std::string why{};       // the reason why it is unknown; empty: it is known

  /// "x = 12.5 m", "vehicle 3, rear_wheel"
  std::string place() const;
};

struct Verdict {
  options::VerdictLimit limit;
  std::string unit;
  EvaluatedQuantity found;
  std::size_t runs = 1, exceeded_in = 0;  // number of runs with this quantity, and number of runs that exceed the limit

  bool evaluated() const { return found.why.empty(); }
  bool within_limit() const { return found.value <= limit.value; }
  /// The remaining part of the limit, relative to it: below 0 if it is exceeded.
  double margin() const { return 1.0 - found.value / limit.value; }
  /// "kept", "broken" or "not judged".
  std::string word() const;
};

/// Prints one line for each verdict, followed by unusual input of their scene.
void print_verdicts(const std::vector<Verdict>& verdicts, const std::vector<std::string>& unusual);

/// The results of many runs for each limit.
struct LimitResults {
  std::vector<options::VerdictLimit> limits;
  std::vector<double> value, x;  // [runs][limits], EvaluatedQuantity::unknown if a run does not have it; m
  std::vector<std::string> why;  // [limits], reason of runs without the quantity

  LimitResults() = default;
  LimitResults(const std::vector<options::VerdictLimit>& by, std::size_t runs)
      : limits(by), value(runs * by.size(), EvaluatedQuantity::unknown), x(value), why(by.size()) {}
};
/// A verdict on each limit by the run with the greatest value; run_text(i) names run i.
std::vector<Verdict> worst_of(const LimitResults& results, const std::function<std::string(std::size_t)>& run_text);

/// A name for each limit: its quantity, "deck_acceleration", with a number from the second limit of a quantity on,
/// "deck_acceleration_2".
std::vector<std::string> names_of_limits(const std::vector<options::VerdictLimit>& limits);
/// Writes /criterion, the dimension of all datasets with a value for each limit, with their names.
void record_limits(Recorder& recorder, const std::vector<options::VerdictLimit>& limits);
/// Writes /verdicts of the results file.
void record_verdicts(Recorder& recorder, const std::vector<Verdict>& verdicts);

}  // namespace traverse::results
