// Exact solution of the modal equations between two breaks of the force: a cubic particular solution by comparison of
// coefficients plus the free oscillation; dissipated energy and work by Gauss quadrature.
#include "integrate/modal_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::integrate {
namespace {

/// c[0] + c[1] t + ..., and its derivatives.
double value(const std::array<double, 4>& c, double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
double first(const std::array<double, 4>& c, double t) { return c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]); }
double second(const std::array<double, 4>& c, double t) { return 2.0 * c[2] + 6.0 * t * c[3]; }

// Gauss points and weights on (0, 1), exact to the power 9.
constexpr std::array<double, 5> points = {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155,
                                          0.953089922969332};
constexpr std::array<double, 5> weights = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                           0.23931433524968324, 0.11846344252809454};
constexpr double energy_phase = 0.5;  // rad of the fastest mode in one integration interval of the energies

}  // namespace

ModalMotion::ModalMotion(const structure::ModalBridge& bridge, const ForceHistory& history, double speed,
                         bool equilibrium)
    : bridge_(bridge), history_(history), speed_(speed), modes_(bridge.modes()) {
  q_.assign(modes_.size(), 0.0);
  rate_ = acceleration_ = q_;
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    highest_ = std::max(highest_, bridge_.omega()[i]);
    modes_[i].omega2 = bridge_.omega()[i] * bridge_.omega()[i];
    modes_[i].damping = 2.0 * bridge_.sigma()[i];
    if (equilibrium) q_[i] = history_.interval(0)[i] / modes_[i].omega2;
  }
  if (bridge.coupled()) coupled_.emplace(bridge);
  enter(0);
  update_state();
}

// Computes the propagators of all modes for steps of this length.
void ModalMotion::prepare(double dt) {
  prepared_dt_ = dt;
  if (coupled_) {
    prepared_coupled_ = coupled_->propagator(dt);
    return;
  }
  prepared_.clear();
  for (std::size_t i = 0; i < modes_.size(); ++i)
    prepared_.push_back(free_oscillation(bridge_.omega()[i], bridge_.sigma()[i], dt));
}

// Sets the polynomial that solves the equation of motion with the interval's force; the difference oscillates freely.
void ModalMotion::enter(std::size_t interval) {
  interval_ = interval;
  const std::size_t n = history_.channels;
  const double* g = history_.interval(interval);
  if (coupled_) return enter_coupled();
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const double square = modes_[i].omega2, c = modes_[i].damping;
    auto& p = modes_[i].particular;
    p[3] = g[3 * n + i] * speed_ * speed_ * speed_ / square;
    p[2] = (g[2 * n + i] * speed_ * speed_ - 3.0 * c * p[3]) / square;
    p[1] = (g[n + i] * speed_ - 2.0 * c * p[2] - 6.0 * p[3]) / square;
    p[0] = (g[i] - c * p[1] - 2.0 * p[2]) / square;
    modes_[i].u = q_[i] - p[0];
    modes_[i].w = rate_[i] - p[1];
  }
}

// Like the function above, for coupled modes. The damping forces between modes are part of the force; the coefficients
// are computed from the highest power down.
void ModalMotion::enter_coupled() {
  const std::size_t n = history_.channels;
  const double* g = history_.interval(interval_);
  const auto m = static_cast<Eigen::Index>(modes_.size());
  const std::array<double, 4> scale = {1.0, speed_, speed_ * speed_, speed_ * speed_ * speed_};
  std::array<Eigen::VectorXd, 6> p;  // by powers; the last two are zero
  p[4] = p[5] = Eigen::VectorXd::Zero(m);
  for (std::size_t k = 4; k-- > 0;) {
    const auto power = static_cast<double>(k);
    const Eigen::VectorXd rate = (power + 1.0) * p[k + 1];  // coefficients of q'
    p[k] = -bridge_.cross_damping() * rate - (power + 1.0) * (power + 2.0) * p[k + 2];
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto mode = static_cast<std::size_t>(i);
      const double omega = bridge_.omega()[mode];
      p[k][i] = (p[k][i] + g[k * n + mode] * scale[k] - 2.0 * bridge_.sigma()[mode] * rate[i]) / (omega * omega);
      modes_[mode].particular[k] = p[k][i];
    }
  }
  u_ = Eigen::Map<const Eigen::VectorXd>(q_.data(), m) - p[0];
  w_ = Eigen::Map<const Eigen::VectorXd>(rate_.data(), m) - p[1];
  coupled_->start(u_, w_);
  record_free();
}

void ModalMotion::record_free() {
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    modes_[i].u = u_[static_cast<Eigen::Index>(i)];
    modes_[i].w = w_[static_cast<Eigen::Index>(i)];
  }
}

double ModalMotion::next_event() const {
  if (speed_ <= 0.0 || interval_ + 1 >= history_.start.size()) return std::numeric_limits<double>::infinity();
  return history_.start[interval_ + 1] / speed_;
}

void ModalMotion::advance(double t) {
  move_to(t);
  update_state();
}

void ModalMotion::advance_acceleration(double t) {
  move_to(t);
  update_acceleration();
}

void ModalMotion::move_to(double t) {
  for (double event = next_event(); event < t; event = next_event()) {
    move(event - time_);
    time_ = event;
    update_state();
    pass_event();
  }
  move(t - time_);
  time_ = t;
}

void ModalMotion::pass_event() {
  if (time_ >= next_event()) enter(interval_ + 1);
}

void ModalMotion::move(double dt) {
  if (dt <= 0.0) return;
  if (integrates_energy_) return coupled_ ? move_coupled_with_energy(dt) : move_with_energy(dt);
  // Equal intervals between instants differ by the rounding of the times.
  const bool prepared = std::abs(dt - prepared_dt_) <= 4.0 * std::numeric_limits<double>::epsilon() * (time_ + dt);
  if (coupled_) {
    coupled_->move(prepared ? prepared_coupled_ : coupled_->propagator(dt));
    coupled_->evaluate(u_, w_);
    return record_free();
  }
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const FreeOscillation a = prepared ? prepared_[i] : free_oscillation(bridge_.omega()[i], bridge_.sigma()[i], dt);
    Mode& mode = modes_[i];
    const double u = mode.u;
    mode.u = a.uu * u + a.uw * mode.w;
    mode.w = a.wu * u + a.ww * mode.w;
  }
}

// Integrates the powers g q' and 2 sigma q'^2 by Gauss quadrature of the exact motion.
void ModalMotion::move_with_energy(double dt) {
  const double begin = speed_ > 0.0 ? history_.start[interval_] / speed_ : 0.0;
  const auto parts =
      static_cast<long>(std::ceil(highest_ * dt / energy_phase));  // ModalStepper limits the number of parts
  const double h = dt / static_cast<double>(parts);
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const double omega = bridge_.omega()[i], sigma = bridge_.sigma()[i];
    const auto& p = modes_[i].particular;
    std::array<FreeOscillation, points.size()> inner{};
    for (std::size_t k = 0; k < points.size(); ++k) inner[k] = free_oscillation(omega, sigma, points[k] * h);
    const FreeOscillation step = free_oscillation(omega, sigma, h);
    for (long part = 0; part < parts; ++part) {
      const double from = time_ - begin + static_cast<double>(part) * h;
      const double u = modes_[i].u, w = modes_[i].w;
      for (std::size_t k = 0; k < points.size(); ++k) {
        const double t = from + points[k] * h;
        const double rate = first(p, t) + inner[k].wu * u + inner[k].ww * w;
        const double force = second(p, t) + 2.0 * sigma * first(p, t) + omega * omega * value(p, t);
        dissipated_ += h * weights[k] * 2.0 * sigma * rate * rate;
        work_ += h * weights[k] * force * rate;
      }
      modes_[i].u = step.uu * u + step.uw * w;
      modes_[i].w = step.wu * u + step.ww * w;
    }
  }
}

void ModalMotion::move_coupled_with_energy(double dt) {
  const double begin = speed_ > 0.0 ? history_.start[interval_] / speed_ : 0.0;
  const auto parts = static_cast<long>(std::ceil(highest_ * dt / energy_phase));
  const double h = dt / static_cast<double>(parts);
  std::array<Eigen::VectorXcd, points.size()> inner;
  for (std::size_t k = 0; k < points.size(); ++k) inner[k] = coupled_->propagator(points[k] * h);
  const Eigen::VectorXcd step = coupled_->propagator(h);
  const auto m = static_cast<Eigen::Index>(modes_.size());
  Eigen::VectorXd rate(m), lost(m);
  std::vector<double> force(modes_.size());
  for (long part = 0; part < parts; ++part) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double t = time_ - begin + (static_cast<double>(part) + points[k]) * h;
      coupled_->evaluate_after(inner[k], u_, w_);
      force.assign(modes_.size(), 0.0);
      add_channels_at(speed_ * t, 0, modes_.size(), force.data());
      for (Eigen::Index i = 0; i < m; ++i) rate[i] = first(modes_[static_cast<std::size_t>(i)].particular, t) + w_[i];
      lost.noalias() = bridge_.cross_damping() * rate;
      for (Eigen::Index i = 0; i < m; ++i) {
        const auto mode = static_cast<std::size_t>(i);
        dissipated_ += h * weights[k] * rate[i] * (2.0 * bridge_.sigma()[mode] * rate[i] + lost[i]);
        work_ += h * weights[k] * force[mode] * rate[i];
      }
    }
    coupled_->move(step);
  }
  coupled_->evaluate(u_, w_);
  record_free();
}

void ModalMotion::update_state() {
  const double t = since_event();
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    q_[i] = value(modes_[i].particular, t) + modes_[i].u;
    rate_[i] = first(modes_[i].particular, t) + modes_[i].w;
  }
  update_acceleration();
}

void ModalMotion::update_acceleration() {
  const double t = since_event();
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const Mode& mode = modes_[i];
    acceleration_[i] = second(mode.particular, t) - mode.damping * mode.w - mode.omega2 * mode.u;
  }
  if (coupled_) Eigen::Map<Eigen::VectorXd>(acceleration_.data(), w_.size()).noalias() -= bridge_.cross_damping() * w_;
}

void ModalMotion::add_channels(std::size_t first, std::size_t count, double* sum) const {
  add_channels_at(speed_ > 0.0 ? speed_ * time_ - history_.start[interval_] : 0.0, first, count, sum);
}

// Adds the channels at a distance s from the interval's start.
void ModalMotion::add_channels_at(double s, std::size_t first, std::size_t count, double* sum) const {
  const std::size_t n = history_.channels;
  const double* c = history_.interval(interval_) + first;
  for (std::size_t i = 0; i < count; ++i) sum[i] += c[i] + s * (c[n + i] + s * (c[2 * n + i] + s * c[3 * n + i]));
}

}  // namespace traverse::integrate
