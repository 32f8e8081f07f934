// Modal damping from Rayleigh's damping and discrete dampers, and the responses of probes by modes. Modes that damping
// couples follow from the eigenvalue problem of the first-order system in (Omega u, u'): one of each conjugate pair is
// kept, and the damping is perturbed slightly where no complete set of eigenvectors exists.
#include "structure/modal_bridge.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "beam/shape.hpp"
#include "traverse/base/error.hpp"

namespace traverse::structure {
namespace {

using base::check;
constexpr double negligible_damping = 1e-6;  // damping between two modes over the geometric mean of their own

base::Handle<Vec> vector(MPI_Comm comm, const double* local, int size) {
  base::Handle<Vec> v;
  check(VecCreateMPIWithArray(comm, 1, size, PETSC_DETERMINE, local, v.out()));
  return v;
}

constexpr double residual_tolerance = 1e-9;  // residual of the complex modes over the norm of the matrix
constexpr double least_change = 1e-10;       // relative change of C if there are none
constexpr double most_change = 1e-6;

}  // namespace

ModalBridge::ModalBridge(const beam::Beam& beam, BeamOperator& statics, modes::Basis basis,
                         const std::vector<double>& ratios)
    : beam_(beam), statics_(statics), basis_(std::move(basis)) {
  set_damping(ratios);
  influence_ = influence_of(lines_of_modes(), {});
}

ModalBridge::ModalBridge(const beam::Beam& beam, BeamOperator& statics, int count)
    : beam_(beam), statics_(statics), basis_(modes::given_basis(beam, count)) {
  const std::vector<double>& ratio = beam.model().given->ratio;
  for (std::size_t i = 0; i < modes(); ++i) sigma_.push_back(ratio[i] * basis_.omega[i]);
  damper_sigma_.assign(modes(), 0.0);
  own_drag_.assign(modes(), 0.0);
  statics_.set_modal_flexibility(basis_.shape, basis_.omega, beam_.first_column() * beam_.block());
  influence_ = influence_of(lines_of_modes(), {});
}

const double* ModalBridge::shape(std::size_t mode) const {
  return basis_.shape[mode].data() + static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
}

/// The product of a matrix with every shape, this rank's unknowns; zero if there is no matrix.
Eigen::MatrixXd ModalBridge::on_shapes(Mat matrix) const {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(beam_.local_unknowns(), static_cast<Eigen::Index>(modes()));
  for (std::size_t i = 0; matrix != nullptr && i < modes(); ++i) {
    const base::Handle<Vec> phi = vector(beam_.comm(), shape(i), beam_.local_unknowns());
    const base::Handle<Vec> column =
        vector(beam_.comm(), product.col(static_cast<Eigen::Index>(i)).data(), beam_.local_unknowns());
    check(MatMult(matrix, phi, column));
  }
  return product;
}

/// phi^T forces, the same on all ranks.
Eigen::MatrixXd ModalBridge::share_of_modes(const Eigen::MatrixXd& forces) const {
  const auto m = static_cast<Eigen::Index>(modes());
  Eigen::MatrixXd share(m, m);
  for (Eigen::Index i = 0; i < m; ++i)
    share.row(i) = Eigen::Map<const Eigen::RowVectorXd>(shape(static_cast<std::size_t>(i)), forces.rows()) * forces;
  MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(share.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  return share;
}

void ModalBridge::set_damping(const std::vector<double>& ratios) {
  const beam::Rayleigh ab = beam_.rayleigh();
  if (ratios.empty()) ab_ = ab;
  const auto m = static_cast<Eigen::Index>(modes());
  Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(m, m);  // other than Rayleigh damping
  Eigen::VectorXd dampers = Eigen::VectorXd::Zero(m);
  // Rayleigh's a and b damp the beam, but not the mass of dampers and the foundation's springs.
  const bool other_mass = beam_.mass() != beam_.beam_mass() && ab.a != 0.0;
  if (beam_.dampers() != nullptr || (beam_.springs() != nullptr && ab.b != 0.0) || other_mass) {
    const Eigen::MatrixXd by_dampers = on_shapes(beam_.dampers());
    Eigen::MatrixXd forces = by_dampers - ab.b * on_shapes(beam_.springs());
    if (other_mass) forces -= ab.a * (on_shapes(beam_.mass()) - on_shapes(beam_.beam_mass()));
    damping = share_of_modes(forces);
    if (beam_.dampers() != nullptr) dampers = 0.5 * share_of_modes(by_dampers).diagonal();
    set_forces_on_others(forces, damping);
  }
  damper_sigma_.assign(dampers.begin(), dampers.end());
  Eigen::VectorXd root(m);  // square root of each mode's own damping
  for (std::size_t i = 0; i < modes(); ++i) {
    const double omega = basis_.omega[i];
    if (omega <= 0.0) throw InputError("model_modes: the beam floats; hold it with supports or a foundation");
    const auto k = static_cast<Eigen::Index>(i);
    const double c = ab.a + ab.b * omega * omega + damping(k, k);
    own_drag_.push_back(ratios.empty() ? 0.0 : 2.0 * ratios[std::min(i, ratios.size() - 1)] * omega);
    sigma_.push_back(0.5 * (c + own_drag_.back()));
    root[k] = std::sqrt(std::abs(2.0 * sigma_.back()));
  }
  damping.diagonal().setZero();
  if ((damping.array().abs() > negligible_damping * (root * root.transpose()).array()).any())
    cross_damping_ = 0.5 * (damping + damping.transpose());
}

/// Sets the damping forces on the other modes: the `forces` of the damping other than Rayleigh damping, minus the
/// modes' share.
void ModalBridge::set_forces_on_others(const Eigen::MatrixXd& forces, const Eigen::MatrixXd& share) {
  Eigen::MatrixXd others = on_shapes(beam_.mass()) * share - forces;
  for (Eigen::Index k = 0; k < others.rows(); ++k)
    if (beam_.fixed()[k] != 0) others.row(k).setZero();
  Eigen::ArrayXXd squares(2, others.cols());
  squares.row(0) = others.colwise().squaredNorm();
  squares.row(1) = forces.colwise().squaredNorm();
  MPI_Allreduce(MPI_IN_PLACE, squares.data(), static_cast<int>(squares.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  if ((squares.row(0) > negligible_damping * negligible_damping * squares.row(1)).any())
    forces_on_others_ = std::move(others);
}

void ModalBridge::add_forces_on_others(const double* rates, double* nodal) const {
  if (forces_on_others_.cols() == 0) return;
  Eigen::Map<Eigen::VectorXd>(nodal, forces_on_others_.rows()).noalias() +=
      forces_on_others_ * Eigen::Map<const Eigen::VectorXd>(rates, forces_on_others_.cols());
}

double ModalBridge::fastest_oscillation() const {
  double square = 0.0;
  for (std::size_t i = 0; i < modes(); ++i) square = std::max(square, omega()[i] * omega()[i] - sigma_[i] * sigma_[i]);
  return square > 0.0 ? std::sqrt(square) : omega().back();
}

const ComplexModes& ModalBridge::complex_modes() const {
  if (!complex_modes_) complex_modes_.emplace(omega(), sigma(), cross_damping());
  return *complex_modes_;
}

std::vector<double> ModalBridge::static_solution(const std::vector<double>& load) {
  const auto begin = static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
  std::vector<double> all(load.size(), 0.0);
  for (int i = 0; i < beam_.local_unknowns(); ++i)
    all[static_cast<std::size_t>(begin + i)] = beam_.fixed()[i] != 0 ? 0.0 : load[static_cast<std::size_t>(begin + i)];
  statics_.solve_static(all.data() + begin);
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  return all;
}

void ModalBridge::add_probes(const std::vector<double>& stations, double gravity,
                             const std::vector<double>& eccentricities) {
  probes_ = {};
  probes_.count = stations.size();
  if (given()) return add_given_probes(stations);
  recovery::Recovery recovery(beam_, stations, 0.0, eccentricities);
  record_forms(recovery);
  if (forces_on_others_.cols() > 0) record_others(recovery);
  recovery::Recovery with_weight(beam_, stations, gravity, eccentricities);
  record_weight(with_weight, gravity);
  std::vector<Line> lines = lines_of_modes();
  for (const auto quantity : {&recovery::Response::deflection, &recovery::Response::moment}) {
    const std::vector<double>& form = quantity == &recovery::Response::deflection ? probes_.deflection : probes_.moment;
    for (std::size_t p = 0; p < stations.size(); ++p)
      lines.push_back(
          correction_of(recovery, p, quantity, [&](std::size_t mode) { return form[mode * probes_.count + p]; }));
  }
  influence_ = influence_of(lines, stations, eccentricities);
}

// Deflections by the shapes; moments and contributions of other modes are zero.
void ModalBridge::add_given_probes(const std::vector<double>& stations) {
  for (const std::vector<double>& shape : basis_.shape)
    for (const double x : stations) {
      const beam::Station at = beam_.mesh().locate(x);
      const beam::Hermite psi = beam::hermite(at.xi, beam_.mesh().element(at.element).length);
      const auto unknowns = beam_.bridge().transverse(at.element);
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += psi.value[k] * shape[static_cast<std::size_t>(unknowns[k])];
      probes_.deflection.push_back(sum);
    }
  for (std::vector<double>* moment : {&probes_.moment, &probes_.moment_by_rate, &probes_.moment_by_acceleration})
    moment->assign(probes_.deflection.size(), 0.0);
  probes_.weight_deflection.assign(stations.size(), 0.0);
  probes_.weight_moment.assign(stations.size(), 0.0);
  std::vector<Line> lines = lines_of_modes();
  lines.resize(lines.size() + 2 * stations.size(), {std::vector<double>(basis_.shape.front().size(), 0.0)});
  influence_ = influence_of(lines, stations);
}

ModalSlopes ModalBridge::slopes(const std::vector<int>& unknowns, const std::vector<double>& stations, double gravity,
                                const std::vector<double>& eccentricities) {
  ModalSlopes slopes;
  slopes.count = unknowns.size() + stations.size();
  recovery::Recovery recovery(beam_, stations, 0.0, eccentricities);
  const auto begin = static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
  const std::vector<double> zero(beam_.local_unknowns(), 0.0);
  std::vector<recovery::Response> responses;
  const auto add = [&](const std::vector<double>& displacements, std::vector<double>& to) {
    for (const int unknown : unknowns) to.push_back(displacements[static_cast<std::size_t>(unknown)]);
    recovery.evaluate(displacements.data() + begin, zero.data(), zero.data(), {}, responses);
    for (const recovery::Response& r : responses) to.push_back(r.twist_along);
  };
  for (const auto& shape : basis_.shape) add(shape, slopes.of_q);
  add(weight_displacements(gravity), slopes.weight);
  std::vector<Line> lines = lines_of_modes();
  for (std::size_t k = 0; k < slopes.count; ++k) {
    const auto form = [&](std::size_t mode) { return slopes.of_q[mode * slopes.count + k]; };
    if (k >= unknowns.size()) {
      lines.push_back(correction_of(recovery, k - unknowns.size(), &recovery::Response::twist_along, form));
      continue;
    }
    std::vector<double> load(basis_.shape.front().size(), 0.0);
    load[static_cast<std::size_t>(unknowns[k])] = 1.0;
    lines.push_back(line_of(load, form));
  }
  slopes.influence = influence_of(lines, stations, eccentricities);
  return slopes;
}

void ModalBridge::record_forms(recovery::Recovery& recovery) {
  const std::vector<double> zero(beam_.local_unknowns(), 0.0);
  std::vector<recovery::Response> responses;
  for (std::size_t i = 0; i < modes(); ++i) {
    recovery.evaluate(shape(i), zero.data(), zero.data(), {}, responses);
    for (const recovery::Response& r : responses) {
      probes_.deflection.push_back(r.deflection);
      probes_.moment.push_back(r.moment);
    }
    recovery.evaluate(zero.data(), zero.data(), shape(i), {}, responses);
    const double squared = basis_.omega[i] * basis_.omega[i];  // adds inertia: the mode's shape, also on a bed
    for (std::size_t p = 0; p < responses.size(); ++p) {
      probes_.deflection[i * probes_.count + p] -= squared * responses[p].deflection;
      probes_.moment_by_acceleration.push_back(responses[p].moment);
    }
    recovery.evaluate(zero.data(), shape(i), zero.data(), {}, responses);
    for (const recovery::Response& r : responses) {
      const std::size_t at = probes_.moment_by_rate.size();
      probes_.moment_by_rate.push_back(r.moment + own_drag_[i] * probes_.moment_by_acceleration[at]);
    }
  }
}

/// The static deflections of the other modes per rate of each mode.
void ModalBridge::record_others(recovery::Recovery& recovery) {
  const auto begin = static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
  const std::vector<double> zero(beam_.local_unknowns(), 0.0);
  std::vector<recovery::Response> responses;
  for (std::size_t i = 0; i < modes(); ++i) {
    std::vector<double> force(basis_.shape.front().size(), 0.0);
    const auto own = forces_on_others_.col(static_cast<Eigen::Index>(i));
    std::copy(own.begin(), own.end(), force.begin() + begin);
    const std::vector<double> others = static_solution(force);
    recovery.evaluate(others.data() + begin, zero.data(), zero.data(), {}, responses);
    for (std::size_t p = 0; p < responses.size(); ++p) {
      probes_.deflection_by_rate.push_back(responses[p].deflection);
      probes_.moment_by_rate[i * probes_.count + p] += responses[p].moment;
    }
  }
}

/// Displacements under the beam's own weight, of all ranks' unknowns.
std::vector<double> ModalBridge::weight_displacements(double gravity) {
  std::vector<double> weight(basis_.shape.front().size(), 0.0);
  beam_.add_self_weight(gravity, weight.data() + static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block());
  return static_solution(weight);
}

void ModalBridge::record_weight(recovery::Recovery& recovery, double gravity) {
  const auto begin = static_cast<std::ptrdiff_t>(beam_.first_column()) * beam_.block();
  const std::vector<double> displacements = weight_displacements(gravity), zero(beam_.local_unknowns(), 0.0);
  std::vector<recovery::Response> responses;
  recovery.evaluate(displacements.data() + begin, zero.data(), zero.data(), {}, responses);
  for (const recovery::Response& r : responses) {
    probes_.weight_deflection.push_back(r.deflection);
    probes_.weight_moment.push_back(r.moment);
  }
}

ComplexModes::ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
                           const Eigen::MatrixXd& cross_damping) {
  const auto m = static_cast<Eigen::Index>(omega.size());
  const Eigen::Map<const Eigen::VectorXd> frequency(omega.data(), m), decay(sigma.data(), m);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * m, 2 * m);  // time derivative of (Omega u, u')
  rates.topRightCorner(m, m) = frequency.asDiagonal();
  rates.bottomLeftCorner(m, m) = -rates.topRightCorner(m, m);
  rates.bottomRightCorner(m, m) = -cross_damping;
  rates.bottomRightCorner(m, m).diagonal() -= 2.0 * decay;
  solve(rates);
  Eigen::MatrixXd changed = rates;
  for (double change = least_change; !(residual(rates) <= residual_tolerance + 2.0 * change); change *= 10.0) {
    if (change > most_change)
      throw SolverError("the complex modes of the damped bridge were not found; take other model_modes, or 0");
    changed.bottomRightCorner(m, m) = (1.0 + change) * rates.bottomRightCorner(m, m);
    solve(changed);
  }
}

void ComplexModes::solve(const Eigen::MatrixXd& rates) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(rates);
  const Eigen::MatrixXcd shapes = solver.eigenvectors(), inverse = shapes.inverse();
  std::vector<Eigen::Index> selected;
  for (Eigen::Index j = 0; j < rates.cols(); ++j)
    if (solver.eigenvalues()[j].imag() >= 0.0) selected.push_back(j);
  const auto count = static_cast<Eigen::Index>(selected.size());
  lambda.resize(count);
  state.resize(rates.cols(), 2 * count);
  coordinates.resize(2 * count, rates.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index j = selected[static_cast<std::size_t>(k)];
    lambda[k] = solver.eigenvalues()[j];
    const double pair_factor = lambda[k].imag() > 0.0 ? 2.0 : 1.0;
    state.col(k) = pair_factor * shapes.col(j).real();
    state.col(count + k) = -pair_factor * shapes.col(j).imag();
    coordinates.row(k) = inverse.row(j).real();
    coordinates.row(count + k) = inverse.row(j).imag();
  }
}

/// The difference between the matrix of these modes and `rates`, over its norm.
double ComplexModes::residual(const Eigen::MatrixXd& rates) const {
  const Eigen::Index count = lambda.size();
  const auto re = coordinates.topRows(count), im = coordinates.bottomRows(count);
  Eigen::MatrixXd rotated(2 * count, rates.cols());
  rotated.topRows(count) = lambda.real().asDiagonal() * re - lambda.imag().asDiagonal() * im;
  rotated.bottomRows(count) = lambda.imag().asDiagonal() * re + lambda.real().asDiagonal() * im;
  return (state * rotated - rates).norm() / rates.norm();
}

}  // namespace traverse::structure
