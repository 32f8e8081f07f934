// Exact solution of the modal equations between two breaks of the force: a cubic particular solution by comparison of
// coefficients plus the free oscillation; dissipated energy and work by Gauss quadrature.
#include "integrate/modal_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/gauss.hpp"

namespace traverse::integrate {
namespace {

/// c[0] + c[1] t + ..., and its derivatives.
double value(const std::array<double, 4>& c, double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
double first(const std::array<double, 4>& c, double t) { return c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]); }
double second(const std::array<double, 4>& c, double t) { return 2.0 * c[2] + 6.0 * t * c[3]; }

// Weights of the Gauss points of a part of a step; these points and its end, for a part of length 1.
constexpr std::array<double, 5> weights = base::gauss_rule<5>.weights;
constexpr double instant(std::size_t k) { return k < 5 ? 0.5 * (1.0 + base::gauss_rule<5>.points[k]) : 1.0; }
constexpr double energy_phase = 0.5;  // rad of the fastest mode in one integration interval of the energies

/// Zero instead of the rest of a decayed motion, whose square is a denormal number: with those processors are slow.
double flushed(double motion) { return std::abs(motion) < 1e-150 ? 0.0 : motion; }

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
    if (integrates_energy_) prepared_coupled_inside_ = coupled_inside(energy_part(dt));
    return;
  }
  prepared_.clear();
  prepared_inside_.clear();
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    prepared_.push_back(free_oscillation(bridge_.omega()[i], bridge_.sigma()[i], dt));
    if (integrates_energy_) prepared_inside_.push_back(inside(i, energy_part(dt)));
  }
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
  // Equal intervals between instants differ by the rounding of the times.
  const bool prepared = std::abs(dt - prepared_dt_) <= 4.0 * std::numeric_limits<double>::epsilon() * (time_ + dt);
  if (prepared) dt = prepared_dt_;
  if (integrates_energy_) return coupled_ ? move_coupled_with_energy(dt, prepared) : move_with_energy(dt, prepared);
  if (coupled_) {
    coupled_->move(prepared ? prepared_coupled_ : coupled_->propagator(dt));
    coupled_->evaluate(u_, w_);
    return record_free();
  }
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const FreeOscillation a = prepared ? prepared_[i] : free_oscillation(bridge_.omega()[i], bridge_.sigma()[i], dt);
    Mode& mode = modes_[i];
    const double u = mode.u;
    mode.u = flushed(a.uu * u + a.uw * mode.w);
    mode.w = flushed(a.wu * u + a.ww * mode.w);
  }
}

// The length of the parts of a step for the integration of the energies.
double ModalMotion::energy_part(double dt) const { return dt / std::ceil(highest_ * dt / energy_phase); }

ModalMotion::Inside<FreeOscillation> ModalMotion::inside(std::size_t mode, double part) const {
  Inside<FreeOscillation> factors;
  for (std::size_t k = 0; k < factors.size(); ++k)
    factors[k] = free_oscillation(bridge_.omega()[mode], bridge_.sigma()[mode], instant(k) * part);
  return factors;
}

ModalMotion::Inside<Eigen::VectorXcd> ModalMotion::coupled_inside(double part) const {
  Inside<Eigen::VectorXcd> factors;
  for (std::size_t k = 0; k < factors.size(); ++k) factors[k] = coupled_->propagator(instant(k) * part);
  return factors;
}

// Integrates the powers g q' and 2 sigma q'^2 by Gauss quadrature of the exact motion.
void ModalMotion::move_with_energy(double dt, bool prepared) {
  const double begin = since_event(), h = energy_part(dt);
  const auto parts = std::lround(dt / h);  // ModalStepper limits their number
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const double omega = bridge_.omega()[i], sigma = bridge_.sigma()[i];
    const auto& p = modes_[i].particular;
    std::array<double, 4> force{};  // coefficients like those of p
    for (std::size_t k = 0; k < 4; ++k) {
      const auto power = static_cast<double>(k);
      force[k] = omega * omega * p[k];
      if (k < 3) force[k] += 2.0 * sigma * (power + 1.0) * p[k + 1];
      if (k < 2) force[k] += (power + 1.0) * (power + 2.0) * p[k + 2];
    }
    const Inside<FreeOscillation> factors = prepared ? prepared_inside_[i] : inside(i, h);
    double lost = 0.0, supplied = 0.0;
    for (long part = 0; part < parts; ++part) {
      const double from = begin + static_cast<double>(part) * h;
      const double u = modes_[i].u, w = modes_[i].w;
      for (std::size_t k = 0; k < weights.size(); ++k) {
        const double t = from + instant(k) * h;
        const double rate = first(p, t) + factors[k].wu * u + factors[k].ww * w;
        lost += weights[k] * rate * rate;
        supplied += weights[k] * value(force, t) * rate;
      }
      const FreeOscillation& whole = factors.back();
      modes_[i].u = flushed(whole.uu * u + whole.uw * w);
      modes_[i].w = flushed(whole.wu * u + whole.ww * w);
    }
    dissipated_ += h * sigma * lost;
    work_ += 0.5 * h * supplied;
  }
}

void ModalMotion::move_coupled_with_energy(double dt, bool prepared) {
  const double begin = since_event(), h = energy_part(dt);
  const auto parts = std::lround(dt / h);
  const Inside<Eigen::VectorXcd> own = prepared ? Inside<Eigen::VectorXcd>() : coupled_inside(h);
  const Inside<Eigen::VectorXcd>& factors = prepared ? prepared_coupled_inside_ : own;
  const auto m = static_cast<Eigen::Index>(modes_.size());
  Eigen::VectorXd rate(m), lost(m);
  std::vector<double> force(modes_.size());
  for (long part = 0; part < parts; ++part) {
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double t = begin + (static_cast<double>(part) + instant(k)) * h;
      coupled_->evaluate_after(factors[k], u_, w_);
      force.assign(modes_.size(), 0.0);
      add_channels_at(speed_ * t, 0, modes_.size(), force.data());
      for (Eigen::Index i = 0; i < m; ++i) rate[i] = first(modes_[static_cast<std::size_t>(i)].particular, t) + w_[i];
      lost.noalias() = bridge_.cross_damping() * rate;
      for (Eigen::Index i = 0; i < m; ++i) {
        const auto mode = static_cast<std::size_t>(i);
        dissipated_ += 0.5 * h * weights[k] * rate[i] * (2.0 * bridge_.sigma()[mode] * rate[i] + lost[i]);
        work_ += 0.5 * h * weights[k] * force[mode] * rate[i];
      }
    }
    coupled_->move(factors.back());
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
