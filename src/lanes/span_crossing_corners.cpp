// What changes where wheels pass the end of a span, as a step ends (crossing_corners.hpp says why, and does the same by
// modes of the whole bridge).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "lanes/span_crossing.hpp"

namespace traverse::lanes {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Coordinates = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>;

constexpr double least_corner = 1e-10;  // of slope

}  // namespace

// From the end of a step, where wheels may be at a corner, to the start of the next.
void SpanCrossing::pass_corners() {
  stand(speed_ * time_ - beside);
  std::copy(wheels_.begin(), wheels_.end(), near_.begin());
  std::copy(phi_.begin(), phi_.end(), near_phi_.begin());
  stand(speed_ * time_ + beside);
  for (Group& group : groups_)
    for (int v = 0; v < group.count; ++v) change_forces(group, v);
}

// The contacts' forces as vehicles and bridge are, with the wheels at this distance.
void SpanCrossing::stand(double gone) {
  place(gone);
  lean_at(q_);
  for (const Group& group : groups_)
    for (int v = 0; v < group.count; ++v) lift_wheels(group, v, group.x.data(), group.a[0].data(), 0.0);
  touch_ahead(q_);
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    wheels_[j].delta = wheels_[j].free;
    law(j, wheels_[j].delta);
  }
}

// The forces of a vehicle's wheels at a corner become those of the far side.
void SpanCrossing::change_forces(Group& group, int v) {
  const VehicleNumbers& of = *group.numbers;
  const Eigen::Index f = of.freedom;
  const auto first = static_cast<std::size_t>(
      train_.vehicles[static_cast<std::size_t>(group.vehicle[static_cast<std::size_t>(v)])].first_wheel);
  push_.setZero(f);
  missed_.setZero(f);
  bool at_corner = false;
  for (int k = 0; k < of.wheels; ++k) {
    const std::size_t j = first + static_cast<std::size_t>(k);
    const Wheel &near = near_[j], &far = wheels_[j];
    const double corner = far.lean - near.lean;
    if (std::abs(corner) <= least_corner) continue;
    at_corner = true;
    const double ahead = (far.free - near.free) / corner;
    const double late = std::abs(ahead) < train_.radius ? 0.5 * ahead / speed_ : 0.0;
    const double up = far.force - near.force, along = near.lean * near.force - far.lean * far.force;
    const Eigen::Map<const Eigen::VectorXd> G(of.G.data() + k * f, f), G_along(of.G_along.data() + k * f, f);
    push_ += up * G + along * G_along;
    missed_ += late * up * G;
    push_modes(near, near_phi_, j, -near.force);
    push_modes(far, phi_, j, far.force);
  }
  if (!at_corner) return;
  const Eigen::Map<const ByRows> M_inverse(group.M_inverse.data(), f, f), C(of.C.data(), f, f);
  const auto own = [&](std::vector<double>& numbers) {
    return Coordinates(numbers.data() + v, f, Eigen::InnerStride<>(group.count));
  };
  kick_.noalias() = M_inverse * missed_;
  push_.noalias() -= C * kick_;
  own(group.w) += kick_;
  own(group.a[0]).noalias() += M_inverse * push_;
}

// A force of a wheel on its span.
void SpanCrossing::push_modes(const Wheel& wheel, const std::vector<double>& phi, std::size_t j, double force) {
  if (wheel.span < 0) return;
  const double* shape = &phi[j * static_cast<std::size_t>(stride_)];
  double* b = at(b_[0], wheel.span);
  for (int i = 0; i < kind(wheel.span).modes(); ++i) b[i] -= force * shape[i];
}

}  // namespace traverse::lanes
