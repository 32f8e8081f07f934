#include "lanes/span_crossing.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "integrate/free_oscillation.hpp"

namespace traverse::lanes {
namespace {

using Numbers = Eigen::Map<const Eigen::VectorXd>;

constexpr double same_step = 1e-10;  // relative

}  // namespace

int SpanCrossing::stride_of(const std::vector<SpanKind>& kinds) {
  int most = 0;
  for (const SpanKind& kind : kinds) most = std::max(most, kind.modes());
  return most;
}

SpanCrossing::SpanCrossing(SpanPlan plan, TrainNumbers train, std::vector<double> q, double speed)
    : plan_(std::move(plan)),
      train_(std::move(train)),
      speed_(speed),
      stride_(stride_of(plan_.kinds)),
      wheels_(train_.x.size()),
      shown_(train_.x.size()),
      phi_(wheels_.size() * static_cast<std::size_t>(stride_)),
      phi_slope_(phi_.size()),
      scaled_(phi_.size()),
      residual_(wheels_.size()),
      yield_(wheels_.size()),
      near_(wheels_.size()),
      near_phi_(phi_.size()),
      q_(std::move(q)),
      left_(plan_.spans.size()),
      seen_(3 * static_cast<std::size_t>(stride_)) {
  for (std::vector<double>* x : {&rate_, &q_still_, &rate_still_, &z_}) x->assign(q_.size(), 0.0);
  for (int j = 0; j < plan_.method.step.known; ++j) b_[static_cast<std::size_t>(j)].assign(q_.size(), 0.0);
  for (const SpanKind& kind : plan_.kinds) {
    S_inverse_.emplace_back(kind.omega2.size());
    goes_.emplace_back(4 * kind.omega2.size());
    double slowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kind.omega2.size(); ++i) {
      const double sigma = 0.5 * kind.damping[i], square = sigma * sigma - kind.omega2[i];
      slowest = std::min(slowest, square > 0.0 ? kind.omega2[i] / (sigma + std::sqrt(square)) : sigma);
    }
    fades_.push_back(slowest);
  }
  forces_.reserve(static_cast<int>(wheels_.size()));
  add_groups();
  find_range(0.0, 0.0);
  start_wheels();
}

void SpanCrossing::set_step(double h) {
  if (std::abs(h - h_) <= same_step * h_) return;
  h_ = h;
  method_ = plan_.method;
  method_.scale_to(h);
  rate_of_a_ = method_.stages.front().rate;
  d_ = method_.stages.front().displacement;
  for (Group& group : groups_) renew(group);
  for (std::size_t k = 0; k < plan_.kinds.size(); ++k) {
    const SpanKind& kind = plan_.kinds[k];
    for (std::size_t i = 0; i < kind.omega2.size(); ++i) {
      S_inverse_[k][i] = d_ / (1.0 + rate_of_a_ * kind.damping[i] + d_ * kind.omega2[i]);
      if (!plan_.all) continue;
      const integrate::FreeOscillation a =
          integrate::free_oscillation(std::sqrt(kind.omega2[i]), 0.5 * kind.damping[i], h);
      std::ranges::copy(std::array{a.uu, a.uw, a.wu, a.ww}, &goes_[k][4 * i]);
    }
  }
}

Trouble SpanCrossing::step(double t, bool from_kink, bool to_kink) {
  set_step(t - time_);
  find_range(time_, t);
  if (from_kink) {
    place(speed_ * time_ + beside);
    lean_at(q_);
    given_[0] = given_now(0);
  }
  const std::size_t stages = method_.stages.size();
  for (std::size_t stage = 0; stage < stages; ++stage) {
    const structure::StageRule& rule = method_.stages[stage];
    const bool last = stage + 1 == stages;
    place(speed_ * (time_ + rule.time) - (last && to_kink ? beside : 0.0));
    free_modes(rule);
    guess_forces(stage);
    for (Group& group : groups_) free_vehicles(group, rule);
    touch_ahead(z_);
    const Trouble trouble = solve_contacts();
    if (trouble != none) return trouble;
    take_forces(stage);
    note_powers(stage + 1);
  }
  finish_step();
  if (plan_.all) step_free_spans();
  time_ = t;
  if (to_kink) pass_corners();
  rest();
  return none;
}

void SpanCrossing::finish_step() {
  const structure::StepRule& rule = method_.step;
  const auto known = static_cast<std::size_t>(rule.known);
  const auto end = [&](double* x, double* w, std::array<std::vector<double>, most_kept>& a, std::size_t from,
                       std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      double next = 0.0, position = x[i] + rule.w_in_v * w[i], rate = w[i];
      for (std::size_t j = 0; j < known; ++j) {
        position += rule.a_in_v[j] * a[j][i];
        rate += rule.a_in_w[j] * a[j][i];
        next += rule.a_next[j] * a[j][i];
      }
      x[i] = position;
      w[i] = rate;
      a[0][i] = next;
    }
  };
  for (Group& group : groups_) {
    end(group.x.data(), group.w.data(), group.a, 0, group.x.size());
    note_bent(group);
  }
  const auto stride = static_cast<std::size_t>(stride_);
  end(q_.data(), rate_.data(), b_, static_cast<std::size_t>(first_) * stride, static_cast<std::size_t>(past_) * stride);
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    wheels_[j].slope = wheels_[j].delta - wheels_[j].end;
    wheels_[j].end = wheels_[j].delta;
    show(j);
  }
  for (std::size_t j = 0; j < known; ++j) {
    lost_total_ += rule.power[j] * lost_[j];
    given_total_ += rule.power[j] * given_[j];
  }
  lost_[0] = lost_[known - 1];
  given_[0] = given_[known - 1];
  h_before_ = h_;
}

double SpanCrossing::given_now(std::size_t stage) const {
  double given = 0.0;
  for (const Group& group : groups_)
    for (std::size_t i = 0; i < group.x.size(); ++i)
      given += group.numbers->driven[i / static_cast<std::size_t>(group.count)] * group.a[stage][i];
  for (const Wheel& wheel : wheels_) given += speed_ * wheel.force * wheel.lean;
  return given;
}

// At a stage that is solved.
void SpanCrossing::note_powers(std::size_t stage) {
  double lost = 0.0;
  for (Group& group : groups_) {
    const int n = group.count, f = group.numbers->freedom;
    const double *a = group.a[stage].data(), *still = group.w_still.data();
    double* rate = group.rate.data();
    for (int i = 0; i < f * n; ++i) rate[i] = still[i] + rate_of_a_ * a[i];
    for (int i = 0; i < f; ++i)
      for (int j = 0; j < f; ++j) {
        const double c = group.numbers->C[static_cast<std::size_t>(i * f + j)];
        if (c == 0.0) continue;
        lost += c * Numbers(rate + i * n, n).dot(Numbers(rate + j * n, n));
      }
  }
  for (int s = first_; s < past_; ++s) {
    const double *still = at(rate_still_, s), *b = at(b_[stage], s), *c = kind(s).damping.data();
    for (int i = 0; i < kind(s).modes(); ++i) {
      const double rate = still[i] + rate_of_a_ * b[i];
      lost += c[i] * rate * rate;
    }
  }
  lost_[stage] = lost;
  lean_at(z_);
  given_[stage] = given_now(stage);
}

void SpanCrossing::keep(base::Bytes& bytes) {
  double h = h_;
  bytes(h);
  if (bytes.reads() && h > 0.0) set_step(h);
  bytes(groups_, wheels_, shown_, phi_, phi_slope_, scaled_, first_, past_, ringing_, q_, rate_, b_, left_,
        left_energy_, h_before_, lost_, given_, lost_total_, given_total_, time_);
}

}  // namespace traverse::lanes
