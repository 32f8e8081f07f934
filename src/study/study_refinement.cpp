#include "study/study_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace traverse::app {
namespace {

using options::Study;
using results::StudyTable;

constexpr std::array peaks = {"peak_deflection", "peak_acceleration", "peak_moment", "greatest_wheel_force"};

/// A run's largest number of a column, or one of its numbers; NaN where it has not ended.
double number_of(const StudyTable::Column& column, std::size_t run) {
  const auto begin = column.values.begin() + static_cast<std::ptrdiff_t>(run * column.width);
  return *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(column.width));
}

/// Runs of one curve: its name, and where a run stands in it.
struct Curves {
  std::vector<std::string> names;
  std::vector<std::size_t> curve, place;  // of each run
};

Curves sorted(const Study& study) {
  Curves curves;
  const options::StudyDimension& speeds = study.dimensions[study.speeds];
  const std::vector<double> ascending = speeds_of(study);
  const auto apart = [&](std::size_t axis) {
    return axis != speeds.axis && std::find(study.over.begin(), study.over.end(), axis) == study.over.end();
  };
  std::map<std::vector<std::size_t>, std::size_t> known;
  for (std::size_t run = 0; run < study.runs(); ++run) {
    std::vector<std::size_t> at;
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      if (apart(axis)) at.push_back(study.place(run, axis));
    const auto [found, is_new] = known.try_emplace(at, curves.names.size());
    if (is_new) {
      std::string name;
      for (const options::StudyDimension& d : study.dimensions)
        if (apart(d.axis))
          name += fmt::format("{} {} {:.6g}", name.empty() ? " at" : ",", d.name(), study.value(run, d));
      curves.names.push_back(name);
    }
    curves.curve.push_back(found->second);
    const double speed = study.value(run, speeds);
    curves.place.push_back(
        static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), speed) - ascending.begin()));
  }
  return curves;
}

}  // namespace

std::vector<double> speeds_of(const Study& study) {
  std::vector<double> speeds = study.dimensions[study.speeds].values;
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

std::vector<SpeedCurve> curves_of(const StudyTable& table) {
  const Study& study = table.study();
  const Curves runs = sorted(study);
  const std::size_t speeds = study.dimensions[study.speeds].values.size();
  std::vector<SpeedCurve> curves;
  const auto add = [&](std::string quantity, auto number) {
    const std::size_t first = curves.size();
    std::replace(quantity.begin(), quantity.end(), '_', ' ');
    for (const std::string& name : runs.names)
      curves.push_back({quantity + name, std::vector<double>(speeds, std::numeric_limits<double>::quiet_NaN())});
    for (std::size_t run = 0; run < table.runs(); ++run) {
      double& greatest = curves[first + runs.curve[run]].value[runs.place[run]];
      greatest = std::fmax(greatest, number(run));
    }
  };
  for (const char* peak : peaks)
    if (const StudyTable::Column* column = table.find(peak))
      if (column->width > 0) add(peak, [column](std::size_t run) { return number_of(*column, run); });
  std::set<std::string> known;
  const StudyTable::Column* judged = table.find("judged");
  const std::vector<results::Verdict> verdicts = table.verdicts();
  for (std::size_t l = 0; l < verdicts.size(); ++l) {
    const std::string& quantity = verdicts[l].limit.quantity;
    if (quantity == "contact_loss" || !known.insert(quantity).second) continue;
    add(quantity, [&](std::size_t run) { return judged->values[run * judged->width + l]; });
  }
  return curves;
}

Study with_speeds(Study study, const std::vector<double>& added) {
  options::StudyDimension& speeds = study.dimensions[study.speeds];
  speeds.values.insert(speeds.values.end(), added.begin(), added.end());
  std::sort(speeds.values.begin(), speeds.values.end());
  study.axes[speeds.axis].length = speeds.values.size();
  return study;
}

}  // namespace traverse::app
