// Products with M, C* and K* (equation 51 of the paper), factorisations of s^2 M + s C* + K* for the latest shifts, and
// static solutions with iterative refinement in extended precision.
#include "structure/beam_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "structure/ranges.hpp"

namespace traverse::structure {
namespace {

constexpr int most_refinements = 30;            // limit of iterative refinements of a static solution
constexpr double converged_correction = 4e-16;  // relative correction due to rounding
constexpr double stagnant = 0.5;                // corrections that decrease by less do not converge
constexpr double most_static_error = 0.1;       // relative

}  // namespace

BeamOperator::BeamOperator(const beam::Beam& beam)
    : comm_(beam.comm()),
      block_(beam.block()),
      nodes_(beam.local_columns()),
      left_rank_(MPI_PROC_NULL),
      right_rank_(MPI_PROC_NULL),
      fixed_(beam.fixed()),
      internal_(beam),
      stiffness_damping_(beam.rayleigh().b),
      halo_(2 * static_cast<std::size_t>(beam.block())) {
  MPI_Comm_size(comm_, &ranks_);
  if (beam.local_columns() > 0) {
    if (beam.first_column() > 0) left_rank_ = beam.owner(beam.first_column() - 1);
    if (beam.first_column() + beam.local_columns() < beam.columns())
      right_rank_ = beam.owner(beam.first_column() + beam.local_columns());
  }
  const auto read = [&](Mat matrix) { return solve::BlockTridiagonal::from(matrix, beam.block()); };
  mass_ = with_neighbour(read(beam.mass()));
  if (beam.springs() != nullptr) springs_ = with_neighbour(read(beam.springs()));
  const bool dampers = beam.dampers() != nullptr;
  const bool proportional = beam.springs() == nullptr && !dampers && beam.rail() == nullptr;
  if (proportional) mass_damping_ = beam.rayleigh().a;
  if (!proportional && (beam.rayleigh().a != 0.0 || dampers)) {
    solve::BlockTridiagonal drag = read(beam.beam_mass());
    drag.combine(beam.rayleigh().a, drag, dampers ? 1.0 : 0.0, dampers ? read(beam.dampers()) : drag, 0.0, drag);
    drag_ = with_neighbour(std::move(drag));
  }
  for (int i = 0; i < beam.block(); ++i) {
    damping_factors_.push_back(beam::Layout::of_bridge(beam.layout().kind[i]) ? stiffness_damping_ : 0.0);
  }
  damped_ = drag_ || mass_damping_.value_or(0.0) != 0.0 || stiffness_damping_ != 0.0;
  relative_.resize(unknowns());
  Shifted all{{}, proportional ? solve::BlockTridiagonal() : read(beam.damping()), read(beam.stiffness())};
  find_parts(beam, all);
  if (!parts_) {
    shifted_.push_back(std::move(all));
  } else {
    for (int part : parts_->of_kind) {
      const solve::Parts::Part& range = parts_->parts[static_cast<std::size_t>(part)];
      shifted_.push_back({solve::rows_of(mass_.rows, range),
                          proportional ? solve::BlockTridiagonal() : solve::rows_of(all.damping, range),
                          solve::rows_of(all.stiffness, range)});
    }
  }
  mass_factor_.emplace(new_factor());
  if (parts_) {
    for (std::size_t kind = 0; kind < shifted_.size(); ++kind)
      mass_factor_->parts().factor(static_cast<int>(kind), shifted_[kind].mass, fixed_);
  } else {
    mass_factor_->whole().factor(mass_.rows, fixed_);
  }
}

// Finds parts of this rank without coupling, also by springs that are added later.
void BeamOperator::find_parts(const beam::Beam& beam, const Shifted& all) {
  const std::vector<int>& parts = beam.parts();
  if (static_cast<int>(parts.size()) - 1 < std::max(2, ranks_) || beam.model().nonlinear()) return;
  std::vector<std::ptrdiff_t> begins;
  for (int begin : parts)
    if (begin >= beam.first_column() && begin <= beam.first_column() + nodes_)
      begins.push_back(begin - beam.first_column());
  std::vector<const solve::BlockTridiagonal*> matrices = {&mass_.rows, &all.stiffness};
  if (!mass_damping_) matrices.push_back(&all.damping);
  parts_ = solve::Parts::find(begins, matrices, fixed_);
}

BeamFactor BeamOperator::new_factor() const {
  if (parts_) return BeamFactor(solve::SeparateParts(block_, *parts_));
  return BeamFactor(solve::SubstructuredCholesky(comm_, block_, nodes_));
}

solve::BlockTridiagonal BeamOperator::shifted(std::size_t kind, double shift, double shift2) const {
  const Shifted& m = shifted_[kind];
  solve::BlockTridiagonal sum(block_, m.stiffness.nodes);
  const solve::BlockTridiagonal& mass = parts_ ? m.mass : mass_.rows;
  if (mass_damping_)
    sum.combine(shift2 + shift * *mass_damping_, mass, 0.0, mass, 1.0 + shift * stiffness_damping_, m.stiffness);
  else
    sum.combine(shift2, mass, shift, m.damping, 1.0, m.stiffness);
  return sum;
}

// The left neighbour stores the block that couples this rank's first column to its last column.
BeamOperator::Matrix BeamOperator::with_neighbour(solve::BlockTridiagonal rows) const {
  const int bb = rows.block * rows.block;
  std::vector<double> send(bb, 0.0), left(bb, 0.0);
  if (rows.nodes > 0)
    std::copy_n(rows.upper.data() + static_cast<std::ptrdiff_t>(rows.nodes - 1) * bb, bb, send.data());
  MPI_Sendrecv(send.data(), bb, MPI_DOUBLE, right_rank_, 0, left.data(), bb, MPI_DOUBLE, left_rank_, 0, comm_,
               MPI_STATUS_IGNORE);
  BlockRows products(rows, left);
  return {std::move(rows), std::move(left), std::move(products)};
}

void BeamOperator::borders(const double* x, double* left, double* right) const {
  const int b = block_;
  exchange(x, x + static_cast<std::ptrdiff_t>(nodes_ - 1) * b, b, left, right);
}

void BeamOperator::exchange(const double* first, const double* last, int count, double* left, double* right) const {
  if (left_rank_ == MPI_PROC_NULL && right_rank_ == MPI_PROC_NULL) return;
  MPI_Sendrecv(first, count, MPI_DOUBLE, left_rank_, 1, right, count, MPI_DOUBLE, right_rank_, 1, comm_,
               MPI_STATUS_IGNORE);
  MPI_Sendrecv(last, count, MPI_DOUBLE, right_rank_, 2, left, count, MPI_DOUBLE, left_rank_, 2, comm_,
               MPI_STATUS_IGNORE);
}

void BeamOperator::product(const Matrix& A, double sign, const double* x, double* r) const {
  borders(x, halo_.data(), halo_.data() + block_);
  Tile of_x, of_r;
  for (int first = 0; first < nodes_; first += beam::tile) {
    const int past = std::min(nodes_, first + beam::tile);
    const int from = std::max(first - 1, 0), to = std::min(past + 1, nodes_);
    of_x.separate(block_, x + block_ * static_cast<std::ptrdiff_t>(from), from - (first - 1), to - from);
    if (first == 0) of_x.set(block_, 0, halo_.data());
    if (past == nodes_) of_x.set(block_, past - first + 1, halo_.data() + block_);
    of_r.clear(block_, past - first);
    A.products.add(first, past, of_x.planes(), of_r.planes());
    of_r.add_to(block_, past - first, sign, r + block_ * static_cast<std::ptrdiff_t>(first));
  }
}

void BeamOperator::multiply(double sign, const double* m, const double* c, const double* k, double* r) const {
  std::fill_n(r, unknowns(), 0.0);
  if (m != nullptr) product(mass_, sign, m, r);
  if (c != nullptr && drag_) product(*drag_, sign, c, r);
  if (c != nullptr && mass_damping_.value_or(0.0) != 0.0) product(mass_, sign * *mass_damping_, c, r);
  if (k != nullptr && springs_) product(*springs_, sign, k, r);
  // The beams' elastic forces together with their damping b K_aa.
  const bool damps = c != nullptr && stiffness_damping_ != 0.0;
  if (k == nullptr && !damps) return;
  if (damps) add_damped_part(c, k);
  const double* x = damps ? relative_.data() : k;
  borders(x, halo_.data(), halo_.data() + block_);
  internal_.add(sign, x, halo_.data(), halo_.data() + block_, r);
}

// k + b c; the unknowns of a rail have no b.
void BeamOperator::add_damped_part(const double* c, const double* k) const {
  const int n = unknowns(), block = block_;
  const double b = stiffness_damping_;
  for (int i = 0; i < n; ++i) relative_[i] = b * c[i];
  for (int j = 0; j < block; ++j) {
    if (damping_factors_[j] != 0.0) continue;
    for (int i = j; i < n; i += block) relative_[i] = 0.0;
  }
  if (k == nullptr) return;
  for (int i = 0; i < n; ++i) relative_[i] += k[i];
}

void BeamOperator::solve_mass(double* x) const {
  ++solves;
  mass_factor_->solve(x);
}

void BeamOperator::set_modal_flexibility(const std::vector<std::vector<double>>& shapes,
                                         const std::vector<double>& omega, int first_unknown) {
  flexibility_modes_.clear();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto begin = shapes[i].begin() + first_unknown;
    flexibility_modes_.emplace_back(begin, begin + unknowns());
    for (double& value : flexibility_modes_.back()) value /= omega[i];
  }
}

void BeamOperator::solve_by_modes(double* x) const {
  std::vector<double> share;
  for (const std::vector<double>& shape : flexibility_modes_)
    share.push_back(std::inner_product(shape.begin(), shape.end(), x, 0.0));
  MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(share.size()), MPI_DOUBLE, MPI_SUM, comm_);
  std::fill_n(x, unknowns(), 0.0);
  for (std::size_t i = 0; i < flexibility_modes_.size(); ++i)
    for (int k = 0; k < unknowns(); ++k) x[k] += share[i] * flexibility_modes_[i][static_cast<std::size_t>(k)];
}

void BeamOperator::solve_static(double* x, const AddedSprings* added) {
  if (!flexibility_modes_.empty()) return solve_by_modes(x);
  const BeamFactor& factor = factored(0.0, 0.0, added);
  load_.assign(x, x + unknowns());
  residual_.resize(unknowns());
  factor.solve(x);
  ++solves;
  double before = 1.0, error = 1.0;
  for (int i = 0; i < most_refinements; ++i) {
    residual_ = load_;
    if (springs_) product(*springs_, -1.0, x, residual_.data());
    borders(x, halo_.data(), halo_.data() + block_);
    internal_.add<long double>(-1.0, x, halo_.data(), halo_.data() + block_, residual_.data());
    if (added != nullptr) {
      for (const AddedSprings::Term& t : *added->terms)
        residual_[t.row] -=
            t.shape * added->k[t.point] * (t.column < unknowns() ? x[t.column] : halo_[t.column - unknowns()]);
    }
    for (int j = 0; j < unknowns(); ++j)
      if (fixed_[j] != 0) residual_[j] = 0.0;
    factor.solve(residual_.data());
    ++solves;
    double sizes[2] = {0.0, 0.0};  // correction, solution
    for (int j = 0; j < unknowns(); ++j) {
      sizes[0] = std::max(sizes[0], std::abs(residual_[j]));
      sizes[1] = std::max(sizes[1], std::abs(x[j]));
      x[j] += residual_[j];
    }
    MPI_Allreduce(MPI_IN_PLACE, sizes, 2, MPI_DOUBLE, MPI_MAX, comm_);
    const double change = sizes[1] > 0.0 ? sizes[0] / sizes[1] : 0.0;
    // Predicts the next correction by the ratio of the last two.
    const double ratio = std::min(change / before, 1.0);
    error = change * std::max(ratio, std::numeric_limits<double>::epsilon());
    if (change <= converged_correction || ratio > stagnant) break;
    before = change;
  }
  static_error_ = std::max(static_error_, error);
  if (!(error <= most_static_error))
    throw SolverError(
        "the static deflection of the beam cannot be computed: rounding takes about " + std::to_string(100.0 * error) +
        " % of it. Either nothing holds the beam (support_types, foundation, track), or there are too many "
        "elements between supports (beam_elements_per_span)");
}

const BeamFactor& BeamOperator::factored(double shift, double shift2, const AddedSprings* added) {
  const long version = added != nullptr ? added->version : 0;
  auto same = [&](const Factor& f) {
    return f.added == version && std::abs(f.shift - shift) <= 1e-9 * std::abs(shift) &&
           std::abs(f.shift2 - shift2) <= 1e-9 * std::abs(shift2);
  };
  auto found = std::find_if(factors_.begin(), factors_.end(), same);
  if (found != factors_.end()) {
    factors_.splice(factors_.begin(), factors_, found);
  } else {
    if (factors_.size() < stored_factors)
      factors_.push_front({shift, shift2, version, 0, new_factor()});
    else
      factors_.splice(factors_.begin(), factors_, std::prev(factors_.end()));
    Factor& f = factors_.front();
    f.shift = shift;
    f.shift2 = shift2;
    f.added = version;
    f.stamp = ++factorisations_;
    try {
      factor(f.beam, shift, shift2, added);
    } catch (const SolverError& error) {
      factors_.pop_front();
      if (shift > 0.0) throw;
      throw SolverError(
          std::string("the beam's static stiffness cannot be factored: a support is missing, or there are so "
                      "many elements between supports (beam_elements_per_span) that rounding hides them; ") +
          error.what());
    }
  }
  stamp_ = factors_.front().stamp;
  return factors_.front().beam;
}

void BeamOperator::keep(base::Archive& archive, const std::function<const AddedSprings*(long)>& springs) {
  struct Key {
    double shift, shift2;
    long added, stamp;
  };
  std::vector<Key> keys;  // the oldest first
  for (auto f = factors_.rbegin(); f != factors_.rend(); ++f) keys.push_back({f->shift, f->shift2, f->added, f->stamp});
  long stamp = stamp_, factorisations = factorisations_, solved = solves;
  archive.cache(keys, stamp, factorisations, solved, static_error_);
  if (!archive.reads() || !archive.same_ranks()) return;
  delete_step_factors();
  for (const Key& key : keys) {
    const AddedSprings* added = key.added != 0 ? springs(key.added) : nullptr;
    if (key.added != 0 && added == nullptr) continue;
    (void)factored(key.shift, key.shift2, added);
    factors_.front().stamp = key.stamp;
  }
  stamp_ = stamp;
  factorisations_ = factorisations;
  solves = solved;
}

void BeamOperator::factor(BeamFactor& to, double shift, double shift2, const AddedSprings* added) {
  if (parts_) {
    for (std::size_t kind = 0; kind < shifted_.size(); ++kind)
      to.parts().factor(static_cast<int>(kind), shifted(kind, shift, shift2), fixed_);
    return;
  }
  solve::BlockTridiagonal all = shifted(0, shift, shift2);
  if (added != nullptr) {
    for (const AddedSprings::Term& t : *added->terms)
      if (t.place >= 0)
        (t.upper ? all.upper : all.diagonal)[t.place] += t.shape * (added->k[t.point] + shift * added->c[t.point]);
  }
  to.whole().factor(all, fixed_);
}

}  // namespace traverse::structure
