// The path of a rope as falls between neighbouring points. The gradient of its length and the curvature of this length
// are those of springs with a constant tension of 1 N along the falls.
#include "multibody/rope.hpp"

#include <algorithm>

#include "traverse/base/error.hpp"

namespace traverse::multibody {
namespace {

const Frame& frame(const std::vector<Frame>& frames, int body) { return frames[static_cast<std::size_t>(body + 1)]; }

/// x', y', phi' of a body.
Eigen::Vector3d velocity_of(const Frame& body) { return {body.velocity.x(), body.velocity.y(), body.omega}; }

}  // namespace

double path_length(const Rope& rope) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < rope.points.size(); ++i) length += (rope.points[i + 1] - rope.points[i]).norm();
  return length;
}

double unstretched_length(const Rope& rope) {
  const double length = path_length(rope);
  if (rope.free_length) return *rope.free_length;
  if (!rope.preload) return length;
  return rope.axial_rigidity > 0.0 ? length / (1.0 + *rope.preload / rope.axial_rigidity)
                                   : length - *rope.preload / rope.stiffness;
}

RopeGeometry::RopeGeometry(const Rope& rope, const std::vector<Frame>& frames)
    : stiffness_(rope.stiffness),
      axial_rigidity_(rope.axial_rigidity),
      damping_(rope.damping),
      drum_(rope.drum),
      carrier_(rope.bodies.back()),
      drum_radius_(rope.drum_radius),
      drum_angle_(frame(frames, drum_).angle - frame(frames, carrier_).angle) {
  std::vector<int> all = rope.bodies;
  all.push_back(rope.drum);
  for (const int body : all)
    if (body != ground && std::find(bodies_.begin(), bodies_.end(), body) == bodies_.end()) bodies_.push_back(body);
  for (std::size_t i = 0; i + 1 < rope.points.size(); ++i) {
    Spring fall;
    fall.bodies = {rope.bodies[i], rope.bodies[i + 1]};
    fall.from = rope.points[i];
    fall.to = rope.points[i + 1];
    fall.preload = 1.0;
    falls_.push_back(spring_geometry(fall, frame(frames, fall.bodies[0]), frame(frames, fall.bodies[1])));
  }
  free_length_ = unstretched_length(rope);
  if (rope.winding) winding_ = std::make_shared<base::TimeFunction>(*rope.winding);
}

int RopeGeometry::slot(int body) const {
  return 3 * static_cast<int>(std::find(bodies_.begin(), bodies_.end(), body) - bodies_.begin());
}

RopeState RopeGeometry::state(const std::vector<Frame>& frames, double t) const {
  const Eigen::Index size = 3 * static_cast<Eigen::Index>(bodies_.size());
  RopeState s;
  s.by_q = s.unstretched_by_q = RopeVector::Zero(size);
  for (const SpringGeometry& fall : falls_) {
    const Frame &first = frame(frames, fall.first), &second = frame(frames, fall.second);
    s.length += spring_length(fall, first, second);
    const PairForce force = spring_force(fall, first, second);
    if (fall.first != ground) s.by_q.segment<3>(slot(fall.first)) -= force.head<3>();
    if (fall.second != ground) s.by_q.segment<3>(slot(fall.second)) -= force.tail<3>();
  }
  s.unstretched = free_length_;
  if (winding_ != nullptr) {
    s.unstretched += winding_->value(t);
    s.winding_rate = winding_->rate(t);
  }
  if (drum_ != ground) {
    const Frame &drum = frame(frames, drum_), &carrier = frame(frames, carrier_);
    s.unstretched -= drum_radius_ * (drum.angle - carrier.angle - drum_angle_);
    s.unstretched_by_q[slot(drum_) + 2] = -drum_radius_;
    if (carrier_ != ground) s.unstretched_by_q[slot(carrier_) + 2] = drum_radius_;
  }
  if (!(s.unstretched > 0.0)) throw SolverError("a rope is wound up entirely at t = " + std::to_string(t) + " s");

  s.by_q -= s.unstretched_by_q;
  s.unstretched_rate = s.winding_rate;
  double rate = -s.winding_rate;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Eigen::Vector3d velocity = velocity_of(frame(frames, bodies_[i]));
    const auto at = 3 * static_cast<Eigen::Index>(i);
    rate += s.by_q.segment<3>(at).dot(velocity);
    s.unstretched_rate += s.unstretched_by_q.segment<3>(at).dot(velocity);
  }
  const double k = axial_rigidity_ > 0.0 ? axial_rigidity_ / s.unstretched : stiffness_;
  const double elongation = s.length - s.unstretched;
  if (elongation > 0.0) {
    s.elastic = k * elongation;
    s.tension = base::one_sided_tension(elongation, rate, {s.elastic, k}, {damping_ * rate, damping_});
  }
  return s;
}

RopeMatrix RopeGeometry::tangent(const std::vector<Frame>& frames, const RopeState& at, double by_q,
                                 double by_qd) const {
  // dT/dq: the stiffness EA/L0 grows as the unstretched length decreases.
  RopeVector tension_by_q = at.tension.by_elongation * at.by_q;
  if (axial_rigidity_ > 0.0 && at.tension.tension > 0.0)
    tension_by_q -= at.elastic / at.unstretched * at.unstretched_by_q;
  RopeMatrix curvature = no_tangent();  // d2L/dq2
  PairMatrix by_coordinates, by_velocities;
  for (const SpringGeometry& fall : falls_) {
    const Frame &first = frame(frames, fall.first), &second = frame(frames, fall.second);
    spring_derivatives(fall, first, second, by_coordinates, by_velocities);
    const std::array<int, 2> pair = {fall.first, fall.second};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        if (pair[i] != ground && pair[j] != ground)
          curvature.block<3, 3>(slot(pair[i]), slot(pair[j])) -=
              by_coordinates.block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(j));
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Eigen::Vector3d velocity = velocity_of(frame(frames, bodies_[i]));
    tension_by_q += at.tension.by_rate * curvature.middleCols<3>(3 * static_cast<Eigen::Index>(i)) * velocity;
  }
  RopeMatrix K = -by_q * at.tension.tension * curvature;
  K.noalias() -= at.by_q * (by_q * tension_by_q + by_qd * at.tension.by_rate * at.by_q).transpose();
  return K;
}

double RopeGeometry::strain_energy(const RopeState& at) const {
  return 0.5 * at.elastic * std::max(0.0, at.length - at.unstretched);
}

double RopeGeometry::work(const RopeState& at) const {
  double work = -at.tension.tension * at.winding_rate;
  if (axial_rigidity_ > 0.0) work -= 0.5 * at.elastic * at.elastic / axial_rigidity_ * at.unstretched_rate;
  return work;
}

}  // namespace traverse::multibody
