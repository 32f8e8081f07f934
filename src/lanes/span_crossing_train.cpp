// The vehicles of a crossing over spans: those with the same numbers side by side.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "lanes/span_crossing.hpp"

namespace traverse::lanes {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

void SpanCrossing::add_groups() {
  place_.resize(static_cast<std::size_t>(train_.coordinates));
  for (std::size_t k = 0; k < train_.kinds.size(); ++k) {
    Group& group = groups_.emplace_back();
    group.numbers = &train_.kinds[k];
    for (std::size_t v = 0; v < train_.vehicles.size(); ++v)
      if (train_.vehicles[v].kind == k) group.vehicle.push_back(static_cast<int>(v));
    group.count = static_cast<int>(group.vehicle.size());
    const auto f = static_cast<std::size_t>(group.numbers->freedom),
               w = static_cast<std::size_t>(group.numbers->wheels);
    const std::size_t n = group.vehicle.size();
    for (std::vector<double>* x :
         {&group.x, &group.w, &group.x_still, &group.w_still, &group.a_free, &group.rate, &group.bent})
      x->assign(f * n, 0.0);
    for (int j = 0; j < plan_.method.step.known; ++j) group.a[static_cast<std::size_t>(j)].assign(f * n, 0.0);
    group.most_bent.assign(n, 0.0);
    group.bend.assign(n, 0.0);
    group.inverse.resize(f * f);
    group.by_state.resize(2 * f * f);
    group.alone.resize(f);
    group.Y.resize(f * w);
    group.Y_along.resize(f * w);
    group.H.resize(w * w);
    const auto size = static_cast<Eigen::Index>(f);
    const ByRows M_inverse = Eigen::Map<const ByRows>(group.numbers->M.data(), size, size).inverse();
    group.M_inverse.assign(M_inverse.data(), M_inverse.data() + M_inverse.size());
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t i = 0; i < f; ++i) {
        const auto first = train_.vehicles[static_cast<std::size_t>(group.vehicle[v])].first_coordinate;
        place_[static_cast<std::size_t>(first) + i] = {k, i * n + v};
        group.w[i * n + v] = speed_ * train_.follow[static_cast<std::size_t>(first) + i];
      }
  }
}

void SpanCrossing::renew(Group& group) {
  const VehicleNumbers& of = *group.numbers;
  const auto f = static_cast<std::size_t>(of.freedom), w = static_cast<std::size_t>(of.wheels);
  for (std::size_t i = 0; i < f * f; ++i) group.inverse[i] = of.M[i] + rate_of_a_ * of.C[i] + d_ * of.K[i];
  const auto size = static_cast<Eigen::Index>(f);
  Eigen::Map<ByRows> J(group.inverse.data(), size, size);
  J = J.inverse().eval();
  for (std::size_t i = 0; i < f; ++i) {
    const double* row = &group.inverse[i * f];
    group.alone[i] = 0.0;
    for (std::size_t k = 0; k < f; ++k) group.alone[i] -= row[k] * of.r0[k];
    for (std::size_t j = 0; j < f; ++j) {
      double by_x = 0.0, by_rate = 0.0;
      for (std::size_t k = 0; k < f; ++k) {
        by_x += row[k] * of.K[k * f + j];
        by_rate += row[k] * of.C[k * f + j];
      }
      group.by_state[i * 2 * f + j] = by_x;
      group.by_state[i * 2 * f + f + j] = by_rate;
    }
    for (std::size_t j = 0; j < w; ++j) {
      double up = 0.0, along = 0.0;
      for (std::size_t k = 0; k < f; ++k) {
        up += row[k] * of.G[j * f + k];
        along += row[k] * of.G_along[j * f + k];
      }
      group.Y[i * w + j] = up;
      group.Y_along[i * w + j] = along;
    }
  }
  for (std::size_t i = 0; i < w; ++i)
    for (std::size_t j = 0; j < w; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < f; ++k) sum += of.G[i * f + k] * group.Y[k * w + j];
      group.H[i * w + j] = d_ * sum;
    }
}

// The vehicles without contact forces, but for what these push along the slopes, and how deep their wheels would be.
void SpanCrossing::free_vehicles(Group& group, const structure::StageRule& rule) {
  const VehicleNumbers& of = *group.numbers;
  const int n = group.count, f = of.freedom, w = of.wheels;
  double *x = group.x_still.data(), *rate = group.w_still.data(), *a = group.a_free.data();
  for (int i = 0; i < f * n; ++i) {
    x[i] = group.x[static_cast<std::size_t>(i)] + rule.w_in_v * group.w[static_cast<std::size_t>(i)];
    rate[i] = group.w[static_cast<std::size_t>(i)];
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(rule.known); ++j) {
    const double *b = group.a[j].data(), in_x = rule.a_in_v[j], in_rate = rule.a_in_w[j];
    for (int i = 0; i < f * n; ++i) {
      x[i] += in_x * b[i];
      rate[i] += in_rate * b[i];
    }
  }
  for (int i = 0; i < f; ++i) {
    double* to = a + i * n;
    for (int v = 0; v < n; ++v) to[v] = group.alone[static_cast<std::size_t>(i)];
    for (int k = 0; k < f; ++k) {
      const double by_x = group.by_state[static_cast<std::size_t>(2 * i * f + k)],
                   by_rate = group.by_state[static_cast<std::size_t>(2 * i * f + f + k)];
      for (int v = 0; v < n; ++v) to[v] -= by_x * x[k * n + v] + by_rate * rate[k * n + v];
    }
  }
  for (int v = 0; v < n; ++v) {
    const auto first = static_cast<std::size_t>(
        train_.vehicles[static_cast<std::size_t>(group.vehicle[static_cast<std::size_t>(v)])].first_wheel);
    for (int j = 0; j < w; ++j) {
      const Wheel& wheel = wheels_[first + static_cast<std::size_t>(j)];
      const double push = wheel.lean * wheel.force;
      if (push == 0.0) continue;
      for (int i = 0; i < f; ++i) a[i * n + v] -= group.Y_along[static_cast<std::size_t>(i * w + j)] * push;
    }
    lift_wheels(group, v, x, a, d_);
  }
}

// With the coordinates at x + d a: how deep the wheels of a vehicle would be without the bridge, and how far they move
// along the track.
void SpanCrossing::lift_wheels(const Group& group, int v, const double* x, const double* a, double d) {
  const VehicleNumbers& of = *group.numbers;
  const int n = group.count, f = of.freedom;
  const auto first = static_cast<std::size_t>(
      train_.vehicles[static_cast<std::size_t>(group.vehicle[static_cast<std::size_t>(v)])].first_wheel);
  for (int j = 0; j < of.wheels; ++j) {
    Wheel& wheel = wheels_[first + static_cast<std::size_t>(j)];
    double up = 0.0, along = 0.0;
    for (int k = 0; k < f; ++k) {
      const double there = x[k * n + v] + d * a[k * n + v];
      up += of.G[static_cast<std::size_t>(j * f + k)] * there;
      along += of.G_along[static_cast<std::size_t>(j * f + k)] * there;
    }
    wheel.free = wheel.offset - up;
    wheel.along = along;
  }
}

// Keeps the coordinates at which a mechanism is farthest from linear.
void SpanCrossing::note_bent(Group& group) {
  const int n = group.count, f = group.numbers->freedom;
  std::fill(group.bend.begin(), group.bend.end(), 0.0);
  for (int i = 0; i < f; ++i)
    for (int v = 0; v < n; ++v)
      group.bend[static_cast<std::size_t>(v)] +=
          group.numbers->bend[static_cast<std::size_t>(i)] * std::abs(group.x[static_cast<std::size_t>(i * n + v)]);
  for (int v = 0; v < n; ++v) {
    if (group.bend[static_cast<std::size_t>(v)] <= group.most_bent[static_cast<std::size_t>(v)]) continue;
    group.most_bent[static_cast<std::size_t>(v)] = group.bend[static_cast<std::size_t>(v)];
    for (int i = 0; i < f; ++i)
      group.bent[static_cast<std::size_t>(i * n + v)] = group.x[static_cast<std::size_t>(i * n + v)];
  }
}

std::vector<double> SpanCrossing::bent() const {
  std::vector<double> bent;
  for (const Place& place : place_) bent.push_back(groups_[place.group].bent[place.at]);
  return bent;
}

}  // namespace traverse::lanes
