// Arranges the peaks in the table of a study as curves over the speed, one for each combination of the other axes, and
// inserts the new speeds into the study.
#include "study/study_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "results/sweep.hpp"

namespace traverse::study {
namespace {

using options::Study;
using results::StudyTable;

constexpr std::array peaks = {"peak_deflection", "peak_acceleration", "peak_moment", "greatest_wheel_force"};

/// The largest of a run's values in a column; NaN if the run has not ended.
double number_of(const StudyTable::Column& column, std::size_t run) {
  const auto begin = column.values.begin() + static_cast<std::ptrdiff_t>(run * column.width);
  return *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(column.width));
}

/// The curve of each run and its position on it.
struct Curves {
  std::vector<std::string> names;
  std::vector<std::size_t> curve, place;  // for each run
};

/// Whether runs with different values on an axis belong to different curves.
bool separates_curves(const Study& study, std::size_t axis) {
  return axis != study.dimensions[study.speeds].axis &&
         std::find(study.over.begin(), study.over.end(), axis) == study.over.end();
}

/// " of A3" for a sweep, " at track_seed 5" for a study.
std::string curve_name(const Study& study, std::size_t run) {
  std::string name;
  if (study.sweep) {
    name = results::train_name(study, study.place(run, 0));
    return name.empty() ? name : " of " + name;
  }
  for (const options::StudyDimension& d : study.dimensions)
    if (separates_curves(study, d.axis))
      name += fmt::format("{} {} {:.6g}", name.empty() ? " at" : ",", d.name(), study.value(run, d));
  return name;
}

Curves sort_runs(const Study& study) {
  Curves curves;
  const options::StudyDimension& speeds = study.dimensions[study.speeds];
  const std::vector<double> sorted = ascending(study, study.speeds);
  std::map<std::vector<std::size_t>, std::size_t> known;
  for (std::size_t run = 0; run < study.runs(); ++run) {
    std::vector<std::size_t> at;
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      if (separates_curves(study, axis)) at.push_back(study.place(run, axis));
    const auto [found, is_new] = known.try_emplace(at, curves.names.size());
    if (is_new) curves.names.push_back(curve_name(study, run));
    curves.curve.push_back(found->second);
    const double speed = study.value(run, speeds);
    curves.place.push_back(
        static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), speed) - sorted.begin()));
  }
  return curves;
}

/// The curves of a quantity over the speed. Each value is the greatest number(run) of the runs of that curve and speed.
template <class Number>
std::vector<SpeedCurve> curves_of_quantity(const Study& study, std::string quantity, Number number) {
  const Curves runs = sort_runs(study);
  std::vector<SpeedCurve> curves;
  std::replace(quantity.begin(), quantity.end(), '_', ' ');
  const std::size_t speeds = study.dimensions[study.speeds].values.size();
  for (const std::string& name : runs.names)
    curves.push_back({quantity + name, std::vector<double>(speeds, std::numeric_limits<double>::quiet_NaN())});
  for (std::size_t run = 0; run < study.runs(); ++run) {
    double& greatest = curves[runs.curve[run]].value[runs.place[run]];
    greatest = std::fmax(greatest, number(run));
  }
  return curves;
}

/// The curves of the quantity that limit number `l` is for.
std::vector<SpeedCurve> limited_curves(const StudyTable& table, std::size_t l) {
  const StudyTable::Column& limited = *table.find("judged");
  return curves_of_quantity(table.study(), table.limits()[l].quantity,
                            [&](std::size_t run) { return limited.values[run * limited.width + l]; });
}

}  // namespace

std::vector<double> ascending(const Study& study, std::size_t dimension) {
  std::vector<double> values = study.dimensions[dimension].values;
  std::sort(values.begin(), values.end());
  return values;
}

std::vector<SpeedCurve> curves_of(const StudyTable& table) {
  std::vector<SpeedCurve> curves;
  const auto add = [&curves](const std::vector<SpeedCurve>& more) {
    curves.insert(curves.end(), more.begin(), more.end());
  };
  for (const char* peak : peaks)
    if (const StudyTable::Column* column = table.find(peak))
      if (column->width > 0)
        add(curves_of_quantity(table.study(), peak, [column](std::size_t run) { return number_of(*column, run); }));
  std::set<std::string> known;
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const std::string& quantity = table.limits()[l].quantity;
    if (quantity != "contact_loss" && known.insert(quantity).second) add(limited_curves(table, l));
  }
  return curves;
}

std::vector<LimitedCurve> curves_below_limits(const StudyTable& table) {
  std::vector<LimitedCurve> below_limits;
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const options::VerdictLimit& limit = table.limits()[l];
    if (limit.quantity == "contact_loss") continue;
    const std::vector<SpeedCurve> curves = limited_curves(table, l);
    const auto exceeds = [&](double value) { return value > limit.value; };
    if (std::any_of(curves.begin(), curves.end(),
                    [&](const SpeedCurve& curve) { return std::ranges::any_of(curve.value, exceeds); }))
      continue;
    for (const SpeedCurve& curve : curves) below_limits.push_back({curve, limit.value});
  }
  return below_limits;
}

Refinement next_speeds(const StudyTable& table, double width) {
  const std::vector<double> speeds = ascending(table.study(), table.study().speeds);
  return table.study().refine < 0.0 ? refine_for_limits(speeds, curves_below_limits(table), width)
                                    : refine(speeds, curves_of(table), table.study().refine);
}

Study with_values(Study study, std::size_t dimension, const std::vector<double>& added) {
  options::StudyDimension& extended = study.dimensions[dimension];
  extended.values.insert(extended.values.end(), added.begin(), added.end());
  std::sort(extended.values.begin(), extended.values.end());
  study.axes[extended.axis].length = extended.values.size();
  return study;
}

}  // namespace traverse::study
