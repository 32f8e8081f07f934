// Reads a scene with the values of a fit, and computes its natural frequencies and its run with samples at the stations
// of the measured series.
#include "fit/forward_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "error_control/accuracy.hpp"
#include "error_control/mode_mesh.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/simulation.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"
#include "traverse/options/table.hpp"

namespace traverse::fit {

using scene::Scene;

namespace {

constexpr double samples_per_period = 8.0;  // of the fastest mode that is exact in time
constexpr double most_samples = 2e6;        // of a run

/// The place of a series among the numbers of a sample, and its unit.
struct Channel {
  std::size_t index = 0;
  std::string unit;
};

/// Unit number `component` of a list as "m, m, rad", or the only one.
std::string unit_of(const std::string& list, std::size_t component) {
  std::string_view rest = list;
  for (std::size_t i = 0; i < component && rest.find(", ") != rest.npos; ++i) rest.remove_prefix(rest.find(", ") + 2);
  return std::string(rest.substr(0, rest.find(", ")));
}

Channel channel_of(const options::MeasuredSeries& series, const Scene& scene, const results::Layout& layout) {
  const std::vector<double>& probes = scene.output.probes;
  std::size_t component = static_cast<std::size_t>(series.component - 1), index = 0;
  if (series.x)
    component = static_cast<std::size_t>(std::find(probes.begin(), probes.end(), *series.x) - probes.begin());
  std::vector<std::string> names;
  for (const results::Layout::Field& field : layout.fields) {
    if (field.name == series.dataset && component < field.width())
      return {index + component, unit_of(field.unit, field.row.empty() ? 0 : component % field.row.back())};
    if (field.name == series.dataset)
      throw InputError(fmt::format("fit_to_{}_component = {}: {} has rows of {} numbers", series.name, component + 1,
                                   series.dataset, field.width()));
    index += field.width();
    names.push_back(field.name);
  }
  const std::string near = options::nearest(series.dataset, names);
  throw InputError(fmt::format("fit_to_{}_dataset = {}: a run of the scene stores no such dataset over time{}",
                               series.name, series.dataset, near.empty() ? "" : "; did you mean " + near + "?"));
}

/// The peaks whose error decides the accuracy of these series; empty: all.
std::vector<std::string> controlled_peaks(const options::Fit& fit) {
  std::vector<std::string> peaks;
  const auto add = [&](const std::string& peak) {
    if (std::find(peaks.begin(), peaks.end(), peak) == peaks.end()) peaks.push_back(peak);
  };
  for (const options::MeasuredSeries& series : fit.series) {
    const std::string quantity = series.dataset.substr(series.dataset.rfind('/') + 1);
    if (!series.x) return {};
    if (quantity != "velocity") add(quantity);
    if (quantity == "velocity") add("deflection");
    if (quantity == "velocity") add("acceleration");
  }
  return peaks;
}

}  // namespace

ForwardModel::ForwardModel(const Scene& scene, std::vector<std::string>& notes)
    : given_(*scene.given), fit_(*scene.fit), name_(scene.name) {
  choose(notes);
  if (!fit_.series.empty()) set_interval();
  if (fit_.frequencies.empty()) return;
  std::vector<double> checked;
  add_frequencies(start(), checked);
}

std::vector<double> ForwardModel::start() const {
  std::vector<double> values;
  for (const options::FitParameter& parameter : fit_.parameters) values.push_back(parameter.start);
  return values;
}

void ForwardModel::choose(std::vector<std::string>& notes) {
  const results::Stage stage("choice of the model of the fit");
  const std::vector<double> first = start();
  std::vector<double> low, high;
  for (const options::FitParameter& parameter : fit_.parameters) {
    low.push_back(parameter.low);
    high.push_back(parameter.high);
  }
  const auto finest = [&](bool modes, auto choose_one) {
    std::optional<scene::NumericalModel> all;
    for (const std::vector<double>* values : std::array{&first, &std::as_const(low), &std::as_const(high)}) {
      Scene scene = scene::read_scene_of_fit(given_, fit_, *values, modes);
      if (scene.accuracy_of.empty()) scene.accuracy_of = controlled_peaks(fit_);
      std::vector<std::string> own;
      const scene::NumericalModel one = choose_one(scene, own);
      if (!all) notes.insert(notes.end(), own.begin(), own.end());
      all = all ? error_control::finer(*all, one) : one;
    }
    return *all;
  };
  if (!fit_.series.empty())
    model_ = finest(false, [](const Scene& scene, std::vector<std::string>& own) {
      return error_control::choose(PETSC_COMM_SELF, scene, own).model;
    });
  if (!fit_.frequencies.empty())
    model_of_modes_ = finest(true, [](const Scene& scene, std::vector<std::string>& own) {
      return error_control::chooses_mode_mesh(scene)
                 ? error_control::choose_mode_mesh(PETSC_COMM_SELF, scene, own).model
                 : scene.model;
    });
}

Scene ForwardModel::scene(const std::vector<double>& values, bool modes) const {
  Scene scene =
      error_control::with(scene::read_scene_of_fit(given_, fit_, values, modes), modes ? model_of_modes_ : model_);
  scene.name = name_;
  if (modes) {
    for (const options::MeasuredFrequency& frequency : fit_.frequencies)
      scene.mode_count = std::max(scene.mode_count, frequency.number);
    return scene;
  }
  if (interval_ > 0.0) scene.output.interval = interval_;
  if (end_ > 0.0) scene.end_time = end_;
  return scene;
}

/// The samples are as dense as the rows of the densest series, and as the steps or the fastest mode need.
void ForwardModel::set_interval() {
  const Scene first = scene(start(), false);
  std::vector<std::string> ignored;
  run::SharedBeam shared(PETSC_COMM_SELF, first, ignored);
  shared.set_up(first, !first.model.step || first.model.modes > 0, ignored);
  run::Passage passage(first, shared, ignored);
  const run::Outputs outputs = run::outputs_of({first, passage.system().fleet(), shared.bridge()});
  for (const options::MeasuredSeries& series : fit_.series)
    units_.push_back(channel_of(series, first, outputs.layout()).unit);
  duration_ = passage.plan().end_time;
  double measured = duration_;
  for (const options::MeasuredSeries& series : fit_.series)
    measured =
        std::min(measured, (series.time.back() - series.time.front()) / static_cast<double>(series.time.size() - 1));
  const double needed = first.exact_in_time()
                            ? 2.0 * std::numbers::pi / shared.modal->omega().back() / samples_per_period
                            : passage.plan().time_step;
  interval_ = measured / std::ceil(measured / needed * (1.0 - 1e-9));
  find_lanes(first, shared);
}

void ForwardModel::set_end(double end) {
  if (fit_.series.empty()) return;
  instants_ = static_cast<std::size_t>(std::ceil(end / interval_ * (1.0 - 1e-12))) + 1;
  if (static_cast<double>(instants_) > most_samples)
    throw InputError(
        fmt::format("the measured series last until {:g} s of the scene, {} samples of {:g} s; allowed: at most {:g} "
                    "(fit_to_{}_to)",
                    end, instants_, interval_, most_samples, fit_.series.front().name));
  end_ = static_cast<double>(instants_ - 1) * interval_;
}

std::vector<std::vector<double>> ForwardModel::run(const std::vector<std::vector<double>>& points) const {
  const options::WithoutMonitors without_monitors;
  std::vector<std::vector<double>> responses(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    naming(points[i], [&] {
      responses[i].reserve(size());
      if (!fit_.frequencies.empty()) add_frequencies(points[i], responses[i]);
      if (!fit_.series.empty() && stored_.empty()) add_series(points[i], responses[i]);
    });
  if (!stored_.empty()) add_series_in_lanes(points, responses);
  return responses;
}

void ForwardModel::naming(const std::vector<double>& values, const std::function<void()>& compute) const {
  try {
    compute();
  } catch (const Error& error) {
    std::string point;
    for (std::size_t j = 0; j < values.size(); ++j)
      point += fmt::format("{}{} = {:g}", j == 0 ? "" : ", ", fit_.parameters[j].name(), values[j]);
    throw Error(fmt::format("the run of the fit with {}: {}", point, error.what()), error.status());
  }
}

void ForwardModel::add_frequencies(const std::vector<double>& values, std::vector<double>& response) const {
  const Scene modal = scene(values, true);
  std::vector<std::string> ignored;
  const run::SharedBeam shared(PETSC_COMM_SELF, modal, ignored);
  std::vector<double> places;
  for (const options::MeasuredFrequency& frequency : fit_.frequencies)
    places.insert(places.end(), frequency.x.begin(), frequency.x.end());
  const beam::ShapePoints points(shared.beam->mesh(), places);
  const modes::Modes found = places.empty() ? modes::natural_modes(*shared.beam, modal.mode_count, false)
                                            : modes::natural_modes(*shared.beam, modal.mode_count, points);
  const std::vector<double>& omega = found.omega;
  for (const options::MeasuredFrequency& frequency : fit_.frequencies) {
    const auto i = static_cast<std::size_t>(frequency.number - 1);
    if (i >= omega.size())
      throw InputError(fmt::format("fit_to_{}_frequency = {}: the bridge by elements has {} modes only", frequency.name,
                                   frequency.number, omega.size()));
    response.push_back(omega[i] / (2.0 * std::numbers::pi));
  }
  for (const options::MeasuredFrequency& frequency : fit_.frequencies)
    for (const double place : frequency.x) {
      const auto distance = [&](double x) { return std::abs(x - place); };
      const auto nearest = std::ranges::min_element(found.x, {}, distance) - found.x.begin();
      const auto i = static_cast<std::size_t>(frequency.number - 1);
      response.push_back(found.motion[i] != modes::Motion::bending ? 0.0
                                                                   : found.shape[i][static_cast<std::size_t>(nearest)]);
    }
}

void ForwardModel::add_series(const std::vector<double>& values, std::vector<double>& response) const {
  const Scene own = scene(values, false);
  std::vector<std::string> ignored;
  run::SharedBeam shared(PETSC_COMM_SELF, own, ignored);
  shared.set_up(own, !own.model.step || own.model.modes > 0, ignored);
  run::Simulation simulation(own, shared, {.stored = true}, ignored);
  const run::Outputs outputs = run::outputs_of({own, simulation.system().fleet(), shared.bridge()});
  std::vector<std::size_t> channels;
  for (const options::MeasuredSeries& series : fit_.series)
    channels.push_back(channel_of(series, own, outputs.layout()).index);
  const std::size_t first = response.size();
  response.resize(first + fit_.series.size() * instants_);
  std::size_t k = 0;
  std::vector<double> row;
  run::ObserverBy recorder(
      [&](const integrate::Instant& instant) {
        if (!is_stored(instant.purpose) || k == instants_) return;
        outputs.fill(simulation.evaluation().observed(), row);
        for (std::size_t s = 0; s < channels.size(); ++s) response[first + s * instants_ + k] = row[channels[s]];
        ++k;
      },
      [](double, long) { return run::caught_signal() == 0; });
  simulation.run({&recorder});
  if (k < instants_) throw SolverError(fmt::format("the run ended after {} of {} samples", k, instants_));
}

}  // namespace traverse::fit
