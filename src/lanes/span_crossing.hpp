// A train of linear vehicles over spans that do not touch each other, each by all the modes of its elements: what is
// computed is what the elements themselves give with the same method, but for rounding and the contacts' first power.
// A span that the train has left rings freely, which is known exactly whenever somebody looks; ahead of the train all
// rest. So a step is that of the vehicles and of the few spans under them:
//
//   vehicles   J a = G^T F - r0 - C w~ - K v~,   J = M + rate C + d K;   H = d G J^-1 G^T
//   modes      q = z - p,  S p = sum phi F,  S = (1 + rate c)/d + omega^2, span by span
//   contacts   F = F(delta),   delta = delta_free - H F - phi S^-1 phi^T F
//
// and the contacts' forces follow from Newton's method with one symmetric band matrix, as wide as the wheels of a
// vehicle or on a span.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "engine/train_task.hpp"
#include "lanes/span_forces.hpp"
#include "lanes/train_numbers.hpp"
#include "methods/one_step_methods.hpp"

namespace traverse::lanes {

using engine::most_kept;

/// Spans with the same modes, of unit modal masses and unit length of their coordinates.
struct SpanKind {
  int elements = 0;
  double length = 0.0;          // m, of an element
  std::vector<double> omega2;   // 1/s2
  std::vector<double> damping;  // 1/s, 2 sigma
  std::vector<double> shape;    // [node][deflection, rotation][mode], upward
  int modes() const { return static_cast<int>(omega2.size()); }
};

struct SpanPlan {
  struct Span {
    std::size_t kind = 0;
    double x = 0.0, end = 0.0;  // m
  };
  std::vector<SpanKind> kinds;
  std::vector<Span> spans;   // one behind the other, without gaps
  structure::Method method;  // for steps of 1 s
  bool all = false;          // every span is stepped, wherever the train is
};

/// In files of their own: the vehicles (span_crossing_train.cpp), the spans (span_crossing_spans.cpp), the contacts
/// (span_crossing_contacts.cpp), and what happens where wheels pass from one span to the next
/// (span_crossing_corners.cpp).
class SpanCrossing {
 public:
  /// q: of the spans' modes at t = 0, [span][stride()]; speed: m/s, above 0.
  SpanCrossing(SpanPlan plan, TrainNumbers train, std::vector<double> q, double speed);
  SpanCrossing(const SpanCrossing&) = delete;
  SpanCrossing& operator=(const SpanCrossing&) = delete;

  static int stride_of(const std::vector<SpanKind>& kinds);
  int stride() const { return stride_; }

  /// A step until t; from_kink, to_kink: a wheel may be at the end of a span where it begins or ends. Where there is
  /// trouble, all is as it was; but not_finite has no way back.
  Trouble step(double t, bool from_kink, bool to_kink);

  // After the last step.

  double time() const { return time_; }
  /// Spans that move: [first, past).
  std::pair<int, int> moving() const;
  /// Of a span's modes.
  void motion(int span, double* q, double* rate, double* acceleration) const;
  /// J, of a span: kinetic, strain.
  std::pair<double, double> energy_now(int span) const;
  /// m, m/s: coordinates of the vehicles from where they started.
  double coordinate(std::size_t i) const { return groups_[place_[i].group].x[place_[i].at]; }
  double coordinate_rate(std::size_t i) const { return groups_[place_[i].group].w[place_[i].at]; }
  std::vector<double> bent() const;  // coordinates of every vehicle where it was farthest from linear
  /// Of a wheel: N, and where it is: span (-1: none), element of that, 0..1 along it.
  struct Shown {
    double force = 0.0;
    int span = -1, element = 0;
    double xi = 0.0;
  };
  const Shown& wheel(std::size_t wheel) const { return shown_[wheel]; }
  double x(std::size_t wheel) const { return train_.x[wheel] + speed_ * time_; }
  /// J since the start: in dampers; by what holds the speed.
  double lost() const;
  double given() const { return given_total_; }

  /// The state between two steps.
  void keep(base::Bytes& bytes);

 private:
  struct Group {  // vehicles with the same numbers; arrays [coordinate][vehicle]
    const VehicleNumbers* numbers = nullptr;
    int count = 0;
    std::vector<int> vehicle;
    std::vector<double> x, w, x_still, w_still, a_free, rate, bent;
    std::vector<double> bend, most_bent;  // [vehicle]
    std::array<std::vector<double>, most_kept> a;
    // At this step length, by rows: J^-1; J^-1 [K C]; -J^-1 r0; J^-1 G^T; the same of forces along the track; H.
    std::vector<double> inverse, by_state, alone, Y, Y_along, H;
    std::vector<double> M_inverse;  // of all steps
    void keep(base::Bytes& bytes) { bytes(x, w, x_still, w_still, a_free, rate, bent, bend, most_bent, a); }
  };
  struct Place {
    std::size_t group = 0, at = 0;
  };
  struct Wheel {
    // m: penetration over a level surface with the vehicle at rest; at the end of the last step, and how it grew in
    // that; now, and with all at rest but for the vehicle and the bridge without contacts.
    double offset = 0.0, end = 0.0, slope = 0.0, delta = 0.0, free = 0.0;
    double along = 0.0;                       // m: how far it has moved along the track
    double force = 0.0, k = 0.0, lean = 0.0;  // N; N/m; the surface's slope
    int span = -1, element = 0;
    double xi = 0.0;
  };
  static constexpr double force_tolerance = 1e-9;     // of the force scale: what a contact's law may be missed by
  static constexpr double least_penetration = 1e-12;  // m: below, the contact counts as lost
  static constexpr double beside = 1e-9;              // m, of the end of a span: on the side that the step is on
  static constexpr int most_iterations = 20, fresh_after = 6, law_steps = 2;

  void add_groups();
  void start_wheels();
  void show(std::size_t wheel);
  void set_step(double h);
  void renew(Group& group);
  void find_range(double from, double to);
  void release(int first, int past);
  std::pair<double, double> energy(int span, const double* q, const double* rate) const;
  void step_free_spans();
  void rest();
  void place(double gone);
  void place_wheel(std::size_t wheel, double x);
  double surface(std::size_t wheel, const std::vector<double>& q) const;
  void lean_at(const std::vector<double>& q);
  void free_modes(const structure::StageRule& rule);
  void guess_forces(std::size_t stage);
  void free_vehicles(Group& group, const structure::StageRule& rule);
  void lift_wheels(const Group& group, int v, const double* x, const double* a, double d);
  void touch_ahead(const std::vector<double>& modes_at);
  void law(std::size_t wheel, double delta);
  bool take_force(std::size_t wheel, double force);
  void fill_forces();
  bool share_span(int first, int last) const;
  Trouble solve_contacts();
  void take_forces(std::size_t stage);
  double given_now(std::size_t stage) const;
  void note_powers(std::size_t stage);
  void finish_step();
  static void note_bent(Group& group);
  void pass_corners();
  void stand(double gone);
  void change_forces(Group& group, int v);
  void push_modes(const Wheel& wheel, const std::vector<double>& phi, std::size_t j, double force);
  const SpanKind& kind(int span) const { return plan_.kinds[plan_.spans[static_cast<std::size_t>(span)].kind]; }
  double* at(std::vector<double>& numbers, int span) const {
    return numbers.data() + static_cast<std::ptrdiff_t>(span) * stride_;
  }
  const double* at(const std::vector<double>& numbers, int span) const {
    return numbers.data() + static_cast<std::ptrdiff_t>(span) * stride_;
  }

  SpanPlan plan_;
  TrainNumbers train_;
  double speed_, time_ = 0.0;
  int stride_;

  std::vector<Group> groups_;
  std::vector<Place> place_;  // of every coordinate
  std::vector<Wheel> wheels_;
  std::vector<Shown> shown_;
  // Shapes under the wheels, upward, their slopes, and the shapes times S^-1: [wheel][mode].
  std::vector<double> phi_, phi_slope_, scaled_;
  std::vector<double> residual_, yield_;  // of the contacts' iteration, [wheel]
  SpanForces forces_;
  // Wheels and shapes on the near side of corners; what far sides change of the forces on a vehicle, what has been
  // missed of that, and what it makes of the rates.
  std::vector<Wheel> near_;
  std::vector<double> near_phi_;
  Eigen::VectorXd push_, missed_, kick_;

  // Spans: [first_, past_) are under the train, [ringing_, first_) ring; the state of those is that of `left_`, but
  // where all are stepped.
  int first_ = 0, past_ = 0, ringing_ = 0;
  std::vector<double> q_, rate_;                  // [span][mode]
  std::array<std::vector<double>, most_kept> b_;  // accelerations, of those under the train
  std::vector<double> q_still_, rate_still_, z_;  // of the stage
  std::vector<double> left_;                      // s, by span
  double left_energy_ = 0.0;                      // J: of all that the train has left, when it did
  std::vector<double> fades_;                     // 1/s, of every kind: its slowest mode
  std::vector<std::vector<double>> S_inverse_;    // [kind][mode]
  std::vector<std::vector<double>> goes_;  // [kind][mode][4]: q, q' from q, q' over a step, where all are stepped

  mutable std::vector<double> seen_;  // of a span that somebody looks at

  double h_ = 0.0, h_before_ = 0.0, rate_of_a_ = 0.0, d_ = 0.0;
  structure::Method method_;                        // for steps of h_
  std::array<double, most_kept> lost_{}, given_{};  // W, at the start of the step and at its stages
  double lost_total_ = 0.0, given_total_ = 0.0;
};

}  // namespace traverse::lanes
