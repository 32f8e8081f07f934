// Calls the functions of each train.
#include "engine/linear_trains.hpp"

#include <algorithm>
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
  set_all_own();
}

void LinearTrains::set_all_own() {
  std::vector<std::size_t> all(trains_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  set_own(std::move(all));
}

void LinearTrains::set_own(std::vector<std::size_t> trains) {
  own_ = std::move(trains);
  is_own_.assign(trains_.size(), 0);
  for (const std::size_t k : own_) is_own_[k] = 1;
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
  for (const auto& train : trains_) train->state(p, pd, pdd);
}

void LinearTrains::copy_contacts_to(train::Fleet& fleet) const {
  for (const auto& train : trains_) train->copy_contacts_to(fleet);
}

bool LinearTrains::residual_may_grow() {
  bool grows = false;
  for (const auto& train : trains_) grows = train->residual_may_grow() || grows;
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
