// Calls the functions of each train.
#include "engine/linear_trains.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace traverse::engine {

LinearTrains::LinearTrains(const train::Fleet& fleet, const std::vector<std::size_t>& first, const beam::Mesh* mesh,
                           int per_node, double surface_height) {
  const std::shared_ptr<const Surfaces> surfaces = LinearTrain::surfaces_of(fleet, mesh);
  const std::size_t count = surfaces ? first.size() : 1;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t past = k + 1 < count ? first[k + 1] : fleet.vehicles.size();
    trains_.push_back(std::make_unique<LinearTrain>(fleet, first[k], past, surfaces, mesh, per_node, surface_height));
    train_of_.resize(past, k);
  }
  presence_.resize(trains_.size());
  present_ = present(0.0, 0.0);
  assign_all();
}

std::vector<std::size_t> LinearTrains::present(double t, double end) const {
  std::vector<std::size_t> trains;
  for (std::size_t k = 0; k < trains_.size(); ++k)
    if (presence_[k].overlaps({t, end})) trains.push_back(k);
  return trains;
}

void LinearTrains::assign(std::vector<std::size_t> trains) {
  assigned_ = std::move(trains);
  select();
}

void LinearTrains::assign_all() {
  assigned_.resize(trains_.size());
  std::iota(assigned_.begin(), assigned_.end(), std::size_t{0});
  select();
}

bool LinearTrains::enters(double t, double end) const {
  for (std::size_t k = 0; k < trains_.size(); ++k)
    if (state_[k] == State::absent && presence_[k].overlaps({t, end})) return true;
  return false;
}

void LinearTrains::set_present(double t, double end) {
  const auto as_before = [&](std::size_t k) { return presence_[k].overlaps({t, end}) == (state_[k] != State::absent); };
  bool same = true;
  for (std::size_t k = 0; same && k < trains_.size(); ++k) same = as_before(k);
  if (same) return;
  present_ = present(t, end);
  select();
}

void LinearTrains::select() {
  own_.clear();
  std::set_intersection(assigned_.begin(), assigned_.end(), present_.begin(), present_.end(), std::back_inserter(own_));
  state_.assign(trains_.size(), State::absent);
  for (const std::size_t k : present_) state_[k] = State::of_other_rank;
  for (const std::size_t k : own_) state_[k] = State::own;
}

void LinearTrains::set_method(const base::Method& method, double h) {
  for (const auto& train : trains_) train->set_method(method, h);
}

void LinearTrains::restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd) {
  for (const auto& train : trains_) train->restart(fleet, p, pd, pdd);
}

void LinearTrains::begin_step() {
  for (const std::size_t k : own_) trains_[k]->begin_step();
}

void LinearTrains::predict(const train::Fleet& fleet, std::size_t stage, double t) {
  for (const std::size_t k : own_) trains_[k]->predict(fleet, stage, t);
}

bool LinearTrains::place(train::Fleet& fleet) {
  for (const std::size_t k : own_)
    if (!trains_[k]->place(fleet)) return false;
  if (own_.size() == 1) return true;
  elements_.clear();
  for (const std::size_t k : own_)
    elements_.insert(elements_.end(), trains_[k]->elements().begin(), trains_[k]->elements().end());
  std::sort(elements_.begin(), elements_.end());
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  return true;
}

void LinearTrains::set_contact_field(const structure::ContactField& field, const structure::ElementCompliance* own) {
  const bool changed = field.of_list && elements() != listed_;
  for (const std::size_t k : own_) trains_[k]->set_contact_field(field, own, elements(), changed);
  if (changed) listed_ = elements();
}

void LinearTrains::add_loads() {
  for (const std::size_t k : own_) trains_[k]->add_loads();
}

bool LinearTrains::update_forces() {
  for (const std::size_t k : own_)
    if (!trains_[k]->update_forces()) return false;
  return true;
}

bool LinearTrains::converged() const {
  return std::all_of(own_.begin(), own_.end(), [this](std::size_t k) { return trains_[k]->converged(); });
}

void LinearTrains::end_stage() {
  for (const std::size_t k : own_) trains_[k]->end_stage();
}

base::Powers LinearTrains::powers() const {
  base::Powers sum;
  for (const std::size_t k : own_) sum += trains_[k]->powers();
  return sum;
}

base::Powers LinearTrains::powers_at_start() const {
  base::Powers sum;
  for (const std::size_t k : own_) sum += trains_[k]->powers_at_start();
  return sum;
}

void LinearTrains::set_powers_at_start(const base::Powers& of_all) {
  for (const auto& train : trains_) train->powers_at_start() = {};
  trains_.front()->powers_at_start() = of_all;  // only the sum counts
}

void LinearTrains::accelerations(double* pdd) const {
  for (const std::size_t k : own_) trains_[k]->accelerations(pdd);
}

void LinearTrains::finish_step() {
  for (const std::size_t k : own_) trains_[k]->finish_step();
}

void LinearTrains::state(double* p, double* pd, double* pdd) const {
  for (const std::size_t k : present_) trains_[k]->state(p, pd, pdd);
}

void LinearTrains::copy_contacts_to(train::Fleet& fleet) const {
  for (const std::size_t k : present_) trains_[k]->copy_contacts_to(fleet);
}

bool LinearTrains::residual_may_grow() {
  bool grows = false;
  for (const std::size_t k : present_) grows = trains_[k]->residual_may_grow() || grows;
  return grows;
}

void LinearTrains::keep(base::Bytes& bytes) {
  LinearTrain::Lists lists;
  for (const auto& train : trains_)
    if (!bytes.reads()) train->keep(lists, false);
  bytes(lists);
  for (const auto& train : trains_)
    if (bytes.reads()) train->keep(lists, true);
}

}  // namespace traverse::engine
