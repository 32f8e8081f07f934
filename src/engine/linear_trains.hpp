// The linear trains of a fleet as one in the stages of a step: they load the structure together, and their passes end
// when the forces of all have converged. Other ranks may move some of them (coupling/train_sharing.hpp).
#pragma once

#include <memory>
#include <vector>

#include "base/interval.hpp"
#include "engine/linear_train.hpp"

namespace traverse::engine {

class LinearTrains {
 public:
  /// first: the first vehicle of each train in the fleet, ascending from 0; vehicles that may leave the surface, or
  /// touch it at several points, are one train. Other arguments as for LinearTrain.
  LinearTrains(const train::Fleet& fleet, const std::vector<std::size_t>& first, const beam::Mesh* mesh, int per_node,
               double surface_height);

  std::size_t count() const { return trains_.size(); }
  LinearTrain& train(std::size_t k) { return *trains_[k]; }
  /// From when to when each train is computed (s); at first always. Before it runs in its steady motion, afterwards it
  /// is of no interest.
  std::vector<base::Interval>& presence() { return presence_; }
  /// The trains that are computed in steps from t to `end` (s), on any rank.
  std::vector<std::size_t> present(double t, double end) const;
  /// The trains that this rank moves while they are computed, ascending; at first all.
  void assign(std::vector<std::size_t> trains);
  void assign_all();
  const std::vector<std::size_t>& assigned() const { return assigned_; }
  /// Whether a train that is absent now is computed in steps from t to `end`.
  bool enters(double t, double end) const;
  /// Before a step from t to `end`.
  void set_present(double t, double end);
  std::size_t train_of(int vehicle) const { return train_of_[static_cast<std::size_t>(vehicle)]; }
  bool moves(int vehicle) const { return state_[train_of(vehicle)] == State::own; }
  bool is_present(int vehicle) const { return state_[train_of(vehicle)] != State::absent; }

  void set_method(const base::Method& method, double h);
  void restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd);

  // Of this rank's trains that are computed, as the functions of LinearTrain:
  void begin_step();
  void predict(const train::Fleet& fleet, std::size_t stage, double t);
  bool place(train::Fleet& fleet);
  const std::vector<int>& elements() const { return own_.size() == 1 ? own_train(0).elements() : elements_; }
  void set_contact_field(const structure::ContactField& field, const structure::ElementCompliance* own);
  void add_loads();
  bool update_forces();
  bool converged() const;
  void end_stage();
  base::Powers powers() const;
  base::Powers powers_at_start() const;
  void set_powers_at_start(const base::Powers& of_all);
  void accelerations(double* pdd) const;
  void finish_step();

  // Of all trains that are computed, on any rank:
  void state(double* p, double* pd, double* pdd) const;
  void copy_contacts_to(train::Fleet& fleet) const;
  bool ends_with_stage() const { return trains_.front()->ends_with_stage(); }
  bool residual_may_grow();
  void keep(base::Bytes& bytes);

 private:
  enum class State : char { absent, of_other_rank, own };
  LinearTrain& own_train(std::size_t i) const { return *trains_[own_[i]]; }
  void select();

  std::vector<std::unique_ptr<LinearTrain>> trains_;
  std::vector<std::size_t> train_of_;  // for each vehicle
  std::vector<base::Interval> presence_;
  std::vector<std::size_t> assigned_, present_, own_;  // ascending; own: assigned and present
  std::vector<State> state_;                           // of each train
  std::vector<int> elements_, listed_;  // under wheels of several own trains, now and in the last contact field
};

}  // namespace traverse::engine
