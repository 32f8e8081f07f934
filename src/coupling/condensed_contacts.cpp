// Newton's method for the condensed contact forces with a banded LU factorisation of P + A D, where D is the tangent of
// the contact laws. The bandwidth follows from the couplings that are not negligible. Along an inextensible chain all
// contacts are coupled, but weakly: the factorised matrix then has the strong couplings only, and the iteration
// corrects for the weak ones.
#include "coupling/condensed_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace traverse::coupling {
namespace {

constexpr double converged_deviation = 1e-12;  // remaining deviation from the law, relative to the weight
constexpr double renewal_deviation =
    1e-6;                            // deviation above which the tangent is computed again, relative to the weight
constexpr double negligible = 1e-9;  // coupling of two rows over their own responses, which A neglects
constexpr double weak = 1e-3;        // coupling that the factorised matrix may leave out
constexpr int narrower = 4;          // ratio of the bandwidths with and without weak couplings from which it does

// The force of the linearised law at the evaluated kinematics, minus the force at the kinematics stored in the contact.
double force_correction(const train::Contact& c, bool normal) {
  const double a = c.touch.kinematics.penetration - c.kinematics.penetration;
  const double r = c.touch.kinematics.penetration_rate - c.kinematics.penetration_rate;
  if (normal) return c.force.normal_by_penetration * a + c.force.normal_by_rate * r;
  const double s = c.touch.kinematics.sliding_speed - c.kinematics.sliding_speed;
  return c.force.tangential_by_penetration * a + c.force.tangential_by_rate * r + c.force.tangential_by_sliding * s;
}

double force_of(const train::ContactRow& row) {
  return row.normal ? row.contact->force.normal : row.contact->force.tangential;
}

const double* direction_on_beam(const train::ContactRow& row) {
  return (row.normal ? row.contact->touch.normal_on_beam : row.contact->touch.tangent_on_beam).data();
}

}  // namespace

Eigen::RowVector2d row_tangent(const train::ContactRow& row, double shift) {
  const contact::Force& f = row.contact->force;
  if (row.normal) return {0.0, f.normal_by_penetration + shift * f.normal_by_rate};
  return {f.tangential_by_penetration + shift * f.tangential_by_rate, shift * f.tangential_by_sliding};
}

void CondensedContacts::list(train::Fleet& fleet) {
  rows_.clear();
  const std::size_t vehicles = fleet.vehicles.size();
  for (std::vector<int>* of_vehicles : {&first_, &count_}) of_vehicles->resize(vehicles);
  compliances_.resize(vehicles);
  if (order_.size() != vehicles) {  // at the start, when all ranks know all places
    order_.resize(vehicles);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    const auto x = [&](std::size_t k) { return fleet.vehicles[k].state.q[0]; };
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return x(a) > x(b); });
  }
  for (const std::size_t k : order_) {
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    first_[k] = size();
    compliances_[k].list.begin();
    for (const int i : vehicle.touching) {
      if (!fleet.may_touch(i)) continue;
      compliances_[k].list.add(i);
      train::Contact& c = fleet.contact(i);
      rows_.push_back({&c, vehicle.scale, static_cast<int>(k), true, c.slot()});
      if (c.law.friction > 0.0) rows_.push_back({&c, vehicle.scale, static_cast<int>(k), false, c.slot()});
    }
    if (!compliances_[k].list.end()) compliances_[k].known = false;
    count_[k] = size() - first_[k];
  }
  for (Eigen::VectorXd* v : {&reference_, &delta_, &change_, &deviation_, &right_, &step_, &beam_}) v->resize(size());
  D_.resize(size(), 2);
}

bool CondensedContacts::moved() {
  bool any = false;
  for (train::ContactRow& row : rows_) {
    any = any || row.slot != row.contact->slot();
    row.slot = row.contact->slot();
  }
  return any;
}

// Computes W between all rows on elements that respond to each other.
template <int m>
void CondensedContacts::respond(const structure::ElementCompliance& compliance) {
  using Vector = Eigen::Matrix<double, m, 1>;
  int slots = 0;
  for (const train::ContactRow& row : rows_) slots = std::max(slots, row.slot + 1);
  slot_begin_.assign(static_cast<std::size_t>(slots) + 1, 0);
  for (const train::ContactRow& row : rows_)
    if (row.slot >= 0) ++slot_begin_[row.slot];
  for (int s = 0, end = 0; s <= slots; ++s) slot_begin_[s] = end += slot_begin_[s];
  on_slot_.resize(static_cast<std::size_t>(slot_begin_[slots]));
  for (int i = size() - 1; i >= 0; --i)
    if (rows_[i].slot >= 0) on_slot_[--slot_begin_[rows_[i].slot]] = i;

  for (int b = 0; b < size(); ++b) {
    if (rows_[b].slot < 0) continue;
    const structure::ElementCompliance::Response& reach = compliance.response(rows_[b].slot);
    const Eigen::Map<const Vector> from(direction_on_beam(rows_[b]));
    for (int s = reach.first; s < std::min(reach.last, slots); ++s) {
      if (slot_begin_[s] == slot_begin_[s + 1]) continue;
      const Eigen::Map<const Eigen::Matrix<double, m, m>> C(compliance.block(s, rows_[b].slot));
      const Vector moved = C * from;
      for (int k = slot_begin_[s]; k < slot_begin_[s + 1]; ++k) {
        const int a = on_slot_[k];
        responses_.push_back({a, b, Eigen::Map<const Vector>(direction_on_beam(rows_[a])).dot(moved)});
      }
    }
  }
}

void CondensedContacts::couple(const structure::ElementCompliance* compliance, int per_node) {
  responses_.clear();
  if (compliance != nullptr) per_node == 2 ? respond<4>(*compliance) : respond<6>(*compliance);
  find_band();
  fill_A();
  factored_ = false;
}

// The bandwidth of A where vehicles have P: a response couples all rows of its vehicle.
int CondensedContacts::band_of_blocks() const {
  int band = 0;
  for (const int rows_of_vehicle : count_) band = std::max(band, rows_of_vehicle);
  for (const Response& r : responses_) {
    const int k = rows_[r.a].vehicle;
    band = std::max({band, std::abs(first_[k] - r.b), std::abs(first_[k] + count_[k] - r.b)});
  }
  return std::clamp(band, 0, std::max(0, size() - 1));
}

// Sets the bandwidth from the couplings that are not negligible, and removes the responses outside it; or from the
// couplings that are not weak if that is much less.
void CondensedContacts::find_band() {
  has_weak_ = false;
  if (std::any_of(compliances_.begin(), compliances_.end(), [](const auto& y) { return y.P.size() > 0; })) {
    band_ = band_of_blocks();
    return;
  }
  right_.setZero();
  for (std::size_t k = 0; k < compliances_.size(); ++k)
    right_.segment(first_[k], rows(static_cast<int>(k))) = compliances_[k].H.diagonal();
  for (const Response& r : responses_)
    if (r.a == r.b) right_[r.a] += r.value;
  const bool friction =
      std::any_of(rows_.begin(), rows_.end(), [](const train::ContactRow& row) { return !row.normal; });
  const auto band_of = [&](double limit) {
    int band = 0;
    const auto widen = [&](int a, int b, double value) {
      if (std::abs(a - b) > band && value * value > limit * limit * std::abs(right_[a] * right_[b]))
        band = std::abs(a - b);
    };
    for (std::size_t k = 0; k < compliances_.size(); ++k)
      for (int j = 0; j < rows(static_cast<int>(k)); ++j)
        for (int i = 0; i < rows(static_cast<int>(k)); ++i)
          widen(first_[k] + i, first_[k] + j, compliances_[k].H(i, j));
    for (const Response& r : responses_) widen(r.a, r.b, r.value);
    // The tangent of a tangential row adds its column of A to the column of the normal row before it.
    return friction ? std::min(band + 1, size() - 1) : band;
  };
  const int strong = band_of(weak);
  band_ = band_of(negligible);
  has_weak_ = band_ > narrower * (strong + 1);
  if (has_weak_)
    band_ = strong;
  else
    std::erase_if(responses_, [this](const Response& r) { return std::abs(r.a - r.b) > band_; });
}

void CondensedContacts::fill_A() {
  A_.setZero(2 * band_ + 1, size());
  for (std::size_t k = 0; k < compliances_.size(); ++k) {
    const int from = first_[k], count = rows(static_cast<int>(k));
    for (int j = 0; j < count; ++j)
      for (int i = std::max(0, j - band_); i <= std::min(count - 1, j + band_); ++i)
        A(from + i, from + j) = compliances_[k].H(i, j);
  }
  for (const Response& r : responses_) {
    const int k = rows_[r.a].vehicle;
    const Eigen::MatrixXd& P = compliances_[k].P;
    if (P.size() == 0) {
      if (std::abs(r.a - r.b) <= band_) A(r.a, r.b) += r.value;
    } else {
      for (int i = 0; i < rows(k); ++i) A(first_[k] + i, r.b) += P(i, r.a - first_[k]) * r.value;
    }
  }
}

// Factorises P + A D at the forces stored in the contacts.
void CondensedContacts::factor(double shift) {
  for (int i = 0; i < size(); ++i) D_.row(i) = row_tangent(rows_[i], shift);
  lu_.set_zero(size(), band_);
  for (int j = 0; j < size(); ++j) {
    for (int i = top(j); i <= bottom(j); ++i) lu_.entry(i, j) = A(i, j) * D_(j, 1);
    if (j + 1 < size() && !rows_[j + 1].normal)
      for (int i = std::max(top(j), top(j + 1)); i <= bottom(j); ++i) lu_.entry(i, j) += A(i, j + 1) * D_(j + 1, 0);
    const train::ContactCompliance& y = compliances_[rows_[j].vehicle];
    if (y.P.size() == 0) {
      lu_.entry(j, j) += 1.0;
    } else {
      const int from = first_[rows_[j].vehicle];
      for (int i = 0; i < y.P.rows(); ++i) lu_.entry(from + i, j) += y.P(i, j - from);
    }
  }
  lu_.factor();
  factored_ = true;
}

void CondensedContacts::subtract_A_times(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  if (has_weak_)
    subtract_all_times(x, y);
  else
    add_band_times(-1.0, x, y);
}

// y += factor A x, with the couplings inside the band.
void CondensedContacts::add_band_times(double factor, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  for (int j = 0; j < size(); ++j) {
    const int from = top(j), count = bottom(j) - from + 1;
    y.segment(from, count) += factor * x[j] * A_.col(j).segment(band_ + from - j, count);
  }
}

// y -= A x, with all couplings; P is 1.
void CondensedContacts::subtract_all_times(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  for (std::size_t k = 0; k < compliances_.size(); ++k) {
    const int count = rows(static_cast<int>(k));
    y.segment(first_[k], count).noalias() -= compliances_[k].H * x.segment(first_[k], count);
  }
  for (const Response& r : responses_) y[r.a] -= r.value * x[r.b];
}

// Sets the contacts' kinematics and forces at delta. Returns the largest deviation from the forces of the tangent.
double CondensedContacts::update_contacts(double shift) {
  double largest = 0.0;
  for (int i = 0; i < size(); ++i) {
    train::Contact& c = *rows_[i].contact;
    if (rows_[i].normal) {
      c.kinematics.penetration = c.touch.kinematics.penetration + delta_[i];
      c.kinematics.penetration_rate = c.touch.kinematics.penetration_rate + shift * delta_[i];
      const bool has_friction = i + 1 < size() && !rows_[i + 1].normal;
      c.kinematics.sliding_speed = c.touch.kinematics.sliding_speed + (has_friction ? shift * delta_[i + 1] : 0.0);
      c.force = train::force_of(c);
    }
    deviation_[i] = force_of(rows_[i]) - reference_[i] - change_[i];
    largest = std::max(largest, std::abs(deviation_[i]) / rows_[i].scale);
  }
  return largest;
}

// A bound of the forces that the weak couplings of the last step have caused, over the vehicles' weights.
double CondensedContacts::largest_weak_change() const {
  double largest = 0.0;
  for (int i = 0; i < size(); ++i) largest = std::max(largest, std::abs(step_[i]) / rows_[i].scale);
  return weak * largest;
}

void CondensedContacts::set_beam_displacement(const Eigen::VectorXd& forces) {
  beam_.setZero();
  for (const Response& r : responses_) beam_[r.a] -= r.value * forces[r.b];
}

double CondensedContacts::solve(double shift, bool loaded, int most_iterations) {
  if (!factored_) factor(shift);
  for (int i = 0; i < size(); ++i) {
    reference_[i] = force_of(rows_[i]);
    change_[i] = force_correction(*rows_[i].contact, rows_[i].normal);
  }
  beam_.setZero();
  if (!loaded) set_beam_displacement(reference_);
  for (std::size_t k = 0; k < compliances_.size(); ++k) {
    const train::ContactCompliance& y = compliances_[k];
    const auto beam = beam_.segment(first_[k], rows(static_cast<int>(k)));
    auto right = right_.segment(first_[k], rows(static_cast<int>(k)));
    right = y.c;
    if (y.P.size() == 0)
      right += beam;
    else
      right += y.P * beam;
  }
  subtract_A_times(change_, right_);
  delta_.setZero();
  double remaining = 0.0;
  for (int i = 1;; ++i) {
    lu_.solve_in_place(right_.data());
    delta_ += right_;
    for (int j = 0; j < size(); ++j) {
      step_[j] = D_(j, 1) * right_[j];
      if (!rows_[j].normal) step_[j] += D_(j, 0) * right_[j - 1];
    }
    change_ += step_;
    remaining = update_contacts(shift);
    if (has_weak_) remaining = std::max(remaining, largest_weak_change());
    if (i == most_iterations || remaining <= converged_deviation || !std::isfinite(remaining)) break;
    if (remaining > renewal_deviation) factor(shift);
    right_.setZero();
    subtract_A_times(deviation_, right_);
    if (has_weak_) {  // what the factorised matrix has left out of the last step
      subtract_all_times(step_, right_);
      add_band_times(1.0, step_, right_);
    }
    change_ += deviation_;
  }
  if (!loaded) reference_ += change_;
  set_beam_displacement(loaded ? change_ : reference_);
  return remaining;
}

}  // namespace traverse::coupling
