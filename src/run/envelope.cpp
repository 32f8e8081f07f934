#include "run/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace traverse::app {
namespace {

constexpr double at_passage = 1e-6;  // of the time between two instants: so near it is not known on which side one is

constexpr double same_moment = 0.02;  // of the largest one there

}  // namespace

Envelope::Forces Envelope::Forces::at(double t, const Forces& through) const {
  const double part = (t - time) / (through.time - time);
  return {t, moment + part * (through.moment - moment), shear + part * (through.shear - shear)};
}

void Envelope::note(Probe& probe, std::size_t quantity, double value, double t, double other) const {
  Extreme &least = probe.least[quantity], &greatest = probe.greatest[quantity];
  if (std::isnan(least.time) || value < least.value) least = {value, t, other};
  if (std::isnan(greatest.time) || value > greatest.value) greatest = {value, t, other};
}

void Envelope::note_forces(Probe& probe, const Forces& now) const {
  note(probe, moment_, now.moment, now.time, now.shear);
  note(probe, shear_, now.shear, now.time, now.moment);
}

// What is behind a passage is known with the second instant that follows it. Where the moment, which does not jump, is
// not the same from both sides, instants are too far apart for straight lines.
bool Envelope::note_sides(Probe& probe, const std::vector<double>& passages, const Forces& now) const {
  const Forces& last = probe.before[1];
  const bool passes = probe.passed < passages.size() && passages[probe.passed] <= now.time;
  if (!passes) {
    if (!probe.ahead || probe.instants == 0) return true;
    const Forces behind = last.at(probe.ahead->time, now);
    const double most = std::max(-probe.least[moment_].value, probe.greatest[moment_].value);
    if (std::abs(behind.moment - probe.ahead->moment) <= same_moment * most) {
      note_forces(probe, *probe.ahead);
      note_forces(probe, behind);
    }
    probe.ahead.reset();
    return true;
  }
  const double passage = passages[probe.passed++];
  probe.ahead.reset();
  if (probe.instants >= 2) probe.ahead = last.at(passage, probe.before[0]);
  for (; probe.passed < passages.size() && passages[probe.passed] <= now.time; ++probe.passed) probe.ahead.reset();
  probe.instants = 0;
  return now.time - passage > at_passage * (now.time - last.time);
}

void Envelope::add(double t, std::span<const beam::Response> probes) {
  static const std::vector<double> none;
  probes_.resize(probes.size());
  for (std::size_t p = 0; p < probes.size(); ++p) {
    const beam::Response& r = probes[p];
    Probe& probe = probes_[p];
    const Forces now = {t, r.moment, r.shear};
    note(probe, deflection_, r.deflection, t, 0.0);
    note(probe, acceleration_, r.acceleration, t, 0.0);
    note_forces(probe, now);
    if (probe.instants > 0 && t <= probe.before[1].time) continue;  // the same instant, seen twice
    if (!note_sides(probe, p < passages_.size() ? passages_[p] : none, now)) continue;
    probe.before = {probe.before[1], now};
    ++probe.instants;
  }
}

std::vector<results::Recorder::Dataset> Envelope::datasets() const {
  std::vector<results::Recorder::Dataset> sets;
  if (probes_.empty()) return sets;
  const auto add = [&](const std::string& name, std::size_t quantity, double Extreme::*number, const char* unit) {
    std::vector<double> values;
    for (const Probe& probe : probes_)
      values.insert(values.end(), {probe.least[quantity].*number, probe.greatest[quantity].*number});
    sets.push_back({"/envelope/" + name, {probes_.size(), 2}, std::move(values), unit});
  };
  const std::pair<const char*, const char*> names[] = {
      {"deflection", "m"}, {"acceleration", "m/s2"}, {"moment", "N m"}, {"shear", "N"}};
  for (std::size_t q = 0; q < quantities_; ++q) {
    add(names[q].first, q, &Extreme::value, names[q].second);
    add(std::string(names[q].first) + "_time", q, &Extreme::time, "s");
  }
  add("moment_shear", moment_, &Extreme::other, "N");
  add("shear_moment", shear_, &Extreme::other, "N m");
  return sets;
}

}  // namespace traverse::app
