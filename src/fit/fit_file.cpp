// Writes the measurements with their computed counterparts, the estimates and the minima of all starts.
#include "fit/fit_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "run/model_record.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"

namespace traverse::fit {
namespace {

using Dataset = results::Recorder::Dataset;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::string units_of(const Residuals& residuals) {
  std::string units;
  for (const Unknown& one : residuals.unknowns()) units += (units.empty() ? "" : ", ") + one.unit;
  return units;
}

/// The numbers of all unknowns as one dataset.
template <class Get>
Dataset of_unknowns(const char* name, const Residuals& residuals, const std::string& unit, Get get) {
  Dataset set{std::string("/fit/") + name, {residuals.unknowns().size()}, {}, unit};
  for (std::size_t j = 0; j < residuals.unknowns().size(); ++j) set.values.push_back(get(j));
  return set;
}

void add_estimates(const Residuals& residuals, const Estimates& estimates, std::vector<Dataset>& sets) {
  const std::string units = units_of(residuals);
  const bool known = !estimates.of.empty();
  const std::size_t count = residuals.unknowns().size();
  sets.push_back(of_unknowns("estimate", residuals, units,
                             [&](std::size_t j) { return known ? estimates.of[j].value : unknown; }));
  sets.push_back(of_unknowns("standard_error", residuals, units,
                             [&](std::size_t j) { return known ? estimates.of[j].standard_error : unknown; }));
  sets.push_back(of_unknowns("at_bound", residuals, "1",
                             [&](std::size_t j) { return known ? (estimates.of[j].at_bound ? 1.0 : 0.0) : unknown; }));
  Dataset correlation{"/fit/correlation", {count, count}, std::vector<double>(count * count, unknown), "1"};
  for (std::size_t i = 0; known && i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      correlation.values[i * count + j] =
          estimates.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  sets.push_back(std::move(correlation));
}

void add_minima(const options::Fit& fit, const Residuals& residuals, const std::vector<Minimum>& minima,
                std::vector<Dataset>& sets) {
  const auto starts = static_cast<std::size_t>(fit.starts);
  const std::size_t count = residuals.unknowns().size();
  Dataset misfit{"/fit/starts/misfit", {starts}, std::vector<double>(starts, unknown), "1"};
  Dataset reached{
      "/fit/starts/estimate", {starts, count}, std::vector<double>(starts * count, unknown), units_of(residuals)};
  for (std::size_t i = 0; i < minima.size(); ++i) {
    misfit.values[i] = minima[i].misfit();
    for (std::size_t j = 0; j < count; ++j)
      reached.values[i * count + j] = residuals.unknowns()[j].value(minima[i].u[static_cast<Eigen::Index>(j)]);
  }
  sets.push_back(std::move(misfit));
  sets.push_back(std::move(reached));
}

void add_shapes(const options::Fit& fit, const Residuals& residuals, const FitCourse& course,
                std::vector<Dataset>& sets) {
  const bool known = !course.minima.empty();
  Dataset mac{"/fit/frequencies/mac", {fit.frequencies.size()}, {}, "1"};
  for (std::size_t f = 0; f < fit.frequencies.size(); ++f) {
    const std::size_t count = fit.frequencies[f].x.size();
    mac.values.push_back(known && count > 0 ? residuals.shape(f, course.response).mac : unknown);
    if (count == 0) continue;
    Dataset computed{
        "/fit/shapes/" + fit.frequencies[f].name + "/computed", {count}, std::vector<double>(count, unknown), "1"};
    if (known) computed.values = residuals.shape(f, course.response).computed;
    sets.push_back(std::move(computed));
  }
  if (fit.modal_size() > fit.frequencies.size()) sets.push_back(std::move(mac));
}

void add_computed(const options::Fit& fit, const Residuals& residuals, const FitCourse& course,
                  std::vector<Dataset>& sets) {
  const bool known = !course.minima.empty();
  if (const std::size_t count = fit.frequencies.size(); count > 0) {
    Dataset computed{"/fit/frequencies/computed", {count}, std::vector<double>(count, unknown), "Hz"};
    if (known) std::copy_n(course.response.begin(), count, computed.values.begin());
    sets.push_back(std::move(computed));
    add_shapes(fit, residuals, course, sets);
  }
  Dataset sd{"/fit/series_sd", {fit.series.size()}, {}, ""};
  for (std::size_t s = 0; s < fit.series.size(); ++s) {
    const std::size_t count = fit.series[s].time.size();
    Dataset computed{"/fit/series/" + fit.series[s].name + "/computed",
                     {count},
                     std::vector<double>(count, unknown),
                     residuals.unit(s)};
    if (known) computed.values = residuals.compared(s, course.response, course.minima[course.best].u).computed;
    sets.push_back(std::move(computed));
    sd.values.push_back(residuals.sd(s));
    sd.unit += (s == 0 ? "" : ", ") + residuals.unit(s);
  }
  if (!fit.series.empty()) sets.push_back(std::move(sd));
}

std::vector<Dataset> changing(const options::Fit& fit, const Residuals& residuals, const FitCourse& course) {
  std::vector<Dataset> sets;
  add_computed(fit, residuals, course, sets);
  add_minima(fit, residuals, course.minima, sets);
  add_estimates(residuals, course.estimates, sets);
  return sets;
}

std::vector<Dataset> constant(const options::Fit& fit, const Residuals& residuals) {
  const std::string units = units_of(residuals);
  const std::vector<Unknown>& unknowns = residuals.unknowns();
  std::vector<Dataset> sets = {
      of_unknowns("low", residuals, units, [&](std::size_t j) { return unknowns[j].low; }),
      of_unknowns("high", residuals, units, [&](std::size_t j) { return unknowns[j].high; }),
      of_unknowns("start", residuals, units, [&](std::size_t j) { return unknowns[j].start; })};
  if (const std::size_t count = fit.frequencies.size(); count > 0) {
    Dataset measured{"/fit/frequencies/measured", {count}, {}, "Hz"}, sd{"/fit/frequencies/sd", {count}, {}, "Hz"};
    for (const options::MeasuredFrequency& f : fit.frequencies) {
      measured.values.push_back(f.value);
      sd.values.push_back(f.sd);
    }
    sets.push_back(std::move(measured));
    sets.push_back(std::move(sd));
  }
  for (const options::MeasuredFrequency& f : fit.frequencies) {
    if (f.x.empty()) continue;
    sets.push_back({"/fit/shapes/" + f.name + "/x", {f.x.size()}, f.x, "m"});
    sets.push_back({"/fit/shapes/" + f.name + "/measured", {f.x.size()}, f.shape, "1"});
  }
  for (std::size_t s = 0; s < fit.series.size(); ++s) {
    const options::MeasuredSeries& series = fit.series[s];
    const std::string group = "/fit/series/" + series.name;
    sets.push_back({group + "/time", {series.time.size()}, series.time, "s"});
    sets.push_back({group + "/measured", {series.time.size()}, residuals.measured(s), residuals.unit(s)});
  }
  return sets;
}

}  // namespace

FitFile::FitFile(MPI_Comm comm, results::Place place, const scene::Scene& scene, const Residuals& residuals,
                 const std::vector<std::string>& notes)
    : fit_(*scene.fit),
      recorder_(comm, std::move(place), run::layout_without_series(scene), run::attributes(comm, scene),
                scene.options) {
  run::record_model(scene, notes, recorder_);
  std::vector<std::string> names, frequencies, series;
  for (const Unknown& one : residuals.unknowns()) names.push_back(one.name);
  for (const options::MeasuredFrequency& f : fit_.frequencies) frequencies.push_back(f.name);
  recorder_.names("/unknown", names);
  recorder_.names("/other_unknown", names);
  for (const options::MeasuredSeries& s : fit_.series) series.push_back(s.name);
  recorder_.names("/measured_frequency", frequencies);
  recorder_.names("/measured_series", series);
  recorder_.datasets(constant(fit_, residuals));
  for (const options::MeasuredSeries& s : fit_.series) {
    recorder_.attributes("/fit/series/" + s.name, {{"dataset", s.dataset}});
    if (s.x)
      recorder_.attributes("/fit/series/" + s.name, {{"x", *s.x}});
    else
      recorder_.attributes("/fit/series/" + s.name, {{"component", static_cast<long>(s.component)}});
  }
  recorder_.datasets(changing(fit_, residuals, {}));
  recorder_.publish();
}

void FitFile::update(const Residuals& residuals, const FitCourse& course) {
  recorder_.rewrite(changing(fit_, residuals, course));
}

void FitFile::finish(const FitCourse& course) {
  if (!recorder_.writes()) return;
  recorder_.change_beside();
  std::vector<results::Attribute> summary;
  if (!course.minima.empty()) {
    summary.push_back({"misfit", course.minima[course.best].misfit()});
    summary.push_back({"residual_ratio", course.estimates.ratio});
    summary.push_back({"converged", has_converged(course.minima[course.best]) ? 1L : 0L});
    summary.push_back({"minima", static_cast<long>(distinct_minima(course.minima).size())});
    std::string text;
    for (const std::string& sentence : course.estimates.sentences) text += (text.empty() ? "" : "\n") + sentence;
    summary.push_back({"findings", text});
  }
  summary.push_back({"runs", course.evaluations});
  summary.push_back({"wall_seconds", course.seconds});
  summary.push_back({"ended", course.ended});
  recorder_.finish_with(summary, {"runs", "wall_seconds"});
}

}  // namespace traverse::fit
