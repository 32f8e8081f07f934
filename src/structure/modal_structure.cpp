// Modal forces, accelerations, energies and nodal values by superposition of the modes; nodal displacements include the
// static correction for the other modes.
#include "structure/modal_structure.hpp"

#include <algorithm>
#include <cmath>

#include "beam/shape.hpp"

namespace traverse::structure {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

ModalStructure::ModalStructure(const ModalBridge& bridge, double gravity, std::shared_ptr<BeamOperator> statics)
    : MovingStructure(bridge.beam(), std::move(statics), gravity),
      bridge_(bridge),
      modes_(bridge.modes()),
      compliance_(*this) {
  int rank = 0;
  MPI_Comm_rank(beam_.comm(), &rank);
  n_ = rank == 0 ? static_cast<int>(modes_) : 0;
  const std::vector<std::vector<double>>& shape = bridge_.basis().shape;
  by_unknown_.resize(modes_ * shape.front().size());
  for (std::size_t i = 0; i < modes_; ++i)
    for (std::size_t u = 0; u < shape[i].size(); ++u) by_unknown_[u * modes_ + i] = shape[i][u];
  if (line_.has_tracks_beside()) find_shapes_of_track();
  for (const std::vector<double>& nodal : shape)
    mode_extents_.push_back(extent_of(nodal.data(), beam_.layout(), static_cast<int>(nodal.size())));

  weight_displacement_.assign(shape.front().size(), 0.0);
  weight_.assign(modes_, 0.0);
  const auto first = static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
  if (gravity != 0.0) {
    double* own = weight_displacement_.data() + first;
    std::copy(dead_load_.begin(), dead_load_.end(), own);
    release_held(own);
    statics_->solve_static(own);
    for (std::size_t k = 0; k < dead_load_.size(); ++k) {
      weight_work_ += dead_load_[k] * own[k];
      const double* phi = shapes(static_cast<int>(first) + static_cast<int>(k));
      for (std::size_t i = 0; i < modes_; ++i) weight_[i] += phi[i] * dead_load_[k];
    }
    const auto add_up = [&](double* x, std::size_t count) {
      MPI_Allreduce(MPI_IN_PLACE, x, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, beam_.comm());
    };
    add_up(weight_displacement_.data(), weight_displacement_.size());
    add_up(weight_.data(), modes_);
    add_up(&weight_work_, 1);
  }
  for (std::vector<double>* x : {&modal_force_, &stiffness_, &v_predicted_, &w_predicted_, &z_, &q_, &displacements_})
    x->assign(modes_, 0.0);
  if (bridge_.coupled()) {
    const auto m = static_cast<Eigen::Index>(modes_);
    inverse_.resize(m, m);
  }
  factorise();
}

void ModalStructure::find_shapes_of_track() {
  const auto values = 2 * static_cast<std::size_t>(per_node());
  const int elements = line_.tracks() * line_.mesh.elements();
  by_element_.assign(values * static_cast<std::size_t>(elements) * modes_, 0.0);
  for (int element = 0; element < elements; ++element) {
    const auto phi = [&](int k) {
      return &by_element_[(values * static_cast<std::size_t>(element) + static_cast<std::size_t>(k)) * modes_];
    };
    line_.for_unknowns(element, [&](int k, int unknown, double factor) {
      for (std::size_t i = 0; i < modes_; ++i) phi(k)[i] += factor * shapes(unknown)[i];
    });
  }
}

// --- loads and states ----------------------------------------------------------------------------------------------

void ModalStructure::load(const std::vector<recovery::ElementLoad>& forces) {
  forces_ = forces;
  std::fill(modal_force_.begin(), modal_force_.end(), 0.0);
  for (const recovery::ElementLoad& force : forces_) {
    const auto unknowns = line_.unknowns(force.element);
    const auto parts = on_unknowns(line_, force);
    for (int k = 0; k < 2 * per_node(); ++k) {
      const double* phi = shapes(force.element, k, unknowns);
      for (std::size_t i = 0; i < modes_; ++i) modal_force_[i] += phi[i] * parts[static_cast<std::size_t>(k)];
    }
  }
}

void ModalStructure::add_modal_forces(const ElementLoads& contacts, double* to) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  for (std::size_t a = 0; a < contacts.elements.size(); ++a) {
    const auto unknowns = line_.unknowns(contacts.elements[a]);
    for (std::size_t k = 0; k < m; ++k) {
      const double* phi = shapes(contacts.elements[a], static_cast<int>(k), unknowns);
      const double force = contacts.values[a * m + k];
      for (std::size_t i = 0; i < modes_; ++i) to[i] += phi[i] * force;
    }
  }
}

Powers ModalStructure::accelerations(const double* v, const double* w, const ElementLoads& contacts, double* a) {
  if (n_ == 0) return {};
  for (int i = 0; i < n_; ++i) {
    const double omega = bridge_.omega()[i];
    a[i] = modal_force_[i] - 2.0 * bridge_.sigma()[i] * w[i] - omega * omega * v[i];
  }
  subtract_cross_damping(w, a);
  add_modal_forces(contacts, a);
  return powers(w);
}

/// Subtracts the cross damping forces at the rates w from the modal forces.
void ModalStructure::subtract_cross_damping(const double* w, double* forces) const {
  if (!bridge_.coupled()) return;
  Eigen::Map<Eigen::VectorXd>(forces, n_).noalias() -=
      bridge_.cross_damping() * Eigen::Map<const Eigen::VectorXd>(w, n_);
}

double ModalStructure::work_rate(const double* w) const {
  double work = 0.0;
  for (int i = 0; i < n_; ++i) work += modal_force_[i] * w[i];
  return work;
}

double ModalStructure::damping(const double* w) const {
  double lost = 0.0;
  for (int i = 0; i < n_; ++i) lost += 2.0 * bridge_.sigma()[i] * w[i] * w[i];
  if (bridge_.coupled() && n_ > 0) {
    const Eigen::Map<const Eigen::VectorXd> rate(w, n_);
    for (int i = 0; i < n_; ++i) lost += w[i] * bridge_.cross_damping().col(i).dot(rate);
  }
  return lost;
}

void ModalStructure::add_values(const std::vector<int>& elements, const double* v, const double* w, double* v_elements,
                                double* w_elements) const {
  if (n_ == 0) return;
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  for (std::size_t a = 0; a < elements.size(); ++a) {
    const auto unknowns = line_.unknowns(elements[a]);
    std::array<double, 6> of_weight{};
    line_.for_unknowns(elements[a], [&](int k, int unknown, double factor) {
      of_weight[static_cast<std::size_t>(k)] += factor * weight_displacement_[static_cast<std::size_t>(unknown)];
    });
    for (std::size_t k = 0; k < m; ++k) {
      const double* phi = shapes(elements[a], static_cast<int>(k), unknowns);
      double value = of_weight[k], rate = 0.0;
      for (std::size_t i = 0; i < modes_; ++i) {
        value += phi[i] * (v != nullptr ? v[i] : v_predicted_[i] + z_[i]);
        rate += phi[i] * (v != nullptr ? w[i] : w_predicted_[i] + shift_ * z_[i]);
      }
      v_elements[a * m + k] = value;
      w_elements[a * m + k] = rate;
    }
  }
}

// --- observation ---------------------------------------------------------------------------------------------------

// Energy of the modes only: the energy of the static correction and the work for it are not included.
StructureEnergy ModalStructure::energy(const double* v, const double* w) {
  StructureEnergy e;
  if (n_ == 0) return e;
  e.strain = 0.5 * weight_work_;
  e.potential = -weight_work_;
  for (int i = 0; i < n_; ++i) {
    const double omega = bridge_.omega()[i];
    e.kinetic += 0.5 * w[i] * w[i];
    e.strain += 0.5 * omega * omega * v[i] * v[i] + weight_[i] * v[i];
    e.potential -= weight_[i] * v[i];
  }
  e.dissipated = powers_.sum.dissipation;
  e.work = powers_.sum.work;
  return e;
}

void ModalStructure::observe(const double* v, const double* w, const double* a, const ElementLoads& contacts,
                             bool /*with_loads*/, NodalMotion& out) {
  const auto size = static_cast<std::size_t>(beam_.local_unknowns());
  const auto first = static_cast<std::size_t>(beam_.first_column()) * static_cast<std::size_t>(beam_.block());
  std::vector<double>&q = observed_, &share = share_;
  q.assign(4 * modes_, 0.0);
  share.assign(modes_, 0.0);
  if (n_ > 0) {
    std::copy_n(v, n_, q.begin());
    std::copy_n(w, n_, q.begin() + n_);
    std::copy_n(a != nullptr ? a : accelerations_[0].data(), n_, q.begin() + 2 * n_);
  }
  MPI_Bcast(q.data(), static_cast<int>(3 * modes_), MPI_DOUBLE, 0, beam_.comm());

  out.coordinates.assign(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(modes_));

  // Forces except the self-weight; the static deflections under them and dampers' forces, minus the modes' share.
  out.P.assign(size, 0.0);
  add_contacts(contacts, out.P.data());
  for (const recovery::ElementLoad& force : forces_) add_force(line_, force, out.P.data());
  static_displacement_ = out.P;
  bridge_.add_forces_on_others(&q[modes_], static_displacement_.data());
  release_held(static_displacement_.data());
  const auto rows = static_cast<Eigen::Index>(size), modes = static_cast<Eigen::Index>(modes_);
  const Eigen::Map<const ByRows> phi(by_unknown_.data() + first * modes_, rows, modes);
  Eigen::Map<Eigen::VectorXd>(share.data(), modes).noalias() =
      phi.transpose() * Eigen::Map<const Eigen::VectorXd>(static_displacement_.data(), rows);
  MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(modes_), MPI_DOUBLE, MPI_SUM, beam_.comm());
  if (bridge_.given()) {  // there are no other modes
    std::fill(static_displacement_.begin(), static_displacement_.end(), 0.0);
    std::fill(share.begin(), share.end(), 0.0);
  } else {
    statics_->solve_static(static_displacement_.data());
  }
  for (std::size_t i = 0; i < modes_; ++i) share[i] /= bridge_.omega()[i] * bridge_.omega()[i];

  Eigen::Map<Eigen::MatrixXd> motion(q.data(), modes, 4);  // q, q', q'', and accelerations due to own_drag
  for (std::size_t i = 0; i < modes_; ++i) {
    q[i] -= share[i];
    q[3 * modes_ + i] = bridge_.own_drag()[i] * q[modes_ + i];
  }
  nodal_.noalias() = phi * motion;
  out.drag.resize(size);
  v_nodal_.resize(size);
  w_nodal_.resize(size);
  a_nodal_.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    v_nodal_[k] = weight_displacement_[first + k] + static_displacement_[k] + nodal_(row, 0);
    w_nodal_[k] = nodal_(row, 1);
    a_nodal_[k] = nodal_(row, 2);
    out.drag[k] = nodal_(row, 3);
    out.P[k] += dead_load_[k];
  }
  out.v = v_nodal_.data();
  out.w = w_nodal_.data();
  out.a = a_nodal_.data();
}

}  // namespace traverse::structure
