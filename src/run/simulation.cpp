// Builds a run, passes its instants to evaluation and observers, and collects the result.
#include "run/simulation.hpp"

#include <fmt/format.h>

#include "run/process.hpp"

namespace traverse::run {
namespace {

constexpr double rounding_worth_a_note = 1e-9;  // relative error of static deflections

}  // namespace

Simulation::Simulation(const scene::Scene& scene, const SharedBeam& shared, const Wants& wants,
                       std::vector<std::string>& notes, const Plan* earlier)
    : comm_(shared.comm), scene_(scene), passage_(scene, shared, notes, earlier) {
  passage_.start(notes);
  if (const double error = system().static_error(); error > rounding_worth_a_note)
    notes.push_back(fmt::format(
        "static deflections: relative error about {:.1g}, by rounding in the many elements between supports", error));
  evaluation_.emplace(scene, system(), shared.bridge(), plan(), wants, notes);
}

void Simulation::begin(Observers observers) {
  passage_.begin([&](const integrate::Instant& instant) { sample(instant, observers); });
}

void Simulation::run(Observers observers) {
  passage_.run([&](const integrate::Instant& instant) { sample(instant, observers); },
               [&](double t, long steps) {
                 evaluation_->step(t);
                 bool goes_on = true;
                 for (Observer* observer : observers) goes_on = observer->step(t, steps) && goes_on;
                 return goes_on;
               },
               [&](double t) {
                 for (Observer* observer : observers) observer->before_step(t);
               });
}

void Simulation::sample(const integrate::Instant& instant, Observers observers) {
  evaluation_->sample(instant);
  for (Observer* observer : observers) observer->sample(instant);
}

Result Simulation::result() {
  Result result = evaluation_->finish();
  results::Summary& summary = result.summary;
  summary.steps = passage_.steps();
  summary.rejected_steps = passage_.rejected();
  summary.solves = system().beam_solves();
  summary.factorisations = system().factorisations();
  summary.linearisation_residual = system().linearisation_residual();
  summary.static_error = system().static_error();
  summary.energy_left = system().energy_left();
  return result;
}

double Simulation::static_deflection(double x) {
  return caught_signal() == 0 ? system().weights().static_peak(x, evaluation_->paths(), evaluation_->time()) : 0.0;
}

std::vector<double> Simulation::static_deflections() {
  std::vector<double> deflections;
  for (const double x : scene_.output.probes) deflections.push_back(static_deflection(x));
  return deflections;
}

void Simulation::keep(base::Archive& archive) {
  passage_.keep(archive);
  evaluation_->keep(archive);
}

}  // namespace traverse::run
