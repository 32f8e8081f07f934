// The motion of several runs at once, one in each lane of the processor's vectors. All runs of a group take their steps
// by distance: wheels and forces are at the same stations in every lane, so that all meet bridge ends, probes and bumps
// in the same step, and shapes, influence lines and places are looked up once for all.
//
// A stage of a step has, with w = w~ + rate a, v = v~ + d a for coordinates of vehicles and modes alike:
//
//   vehicles   J a = G^T F - r0 - C w~ - K v~,   J = M + rate C + d K, inverted once a step length; H = d G J^-1 G^T
//   modes      S p = g^T F, S = (1 + rate c)/d + omega^2: what the contacts push the bridge down by, with g the modal
//              forces of unit forces at the wheels
//   contacts   F = F(delta),   delta = delta_free - H F - g p
//
// The contacts' Newton iteration puts everything into the modes: with D = 1/k + H of each vehicle by itself
//
//   (S + sum g^T D^-1 g) p = sum g^T D^-1 r,   F = D^-1 (r - g p),   r = delta_free - delta + F/k
//
// Methods of one solve a step need not step the modes at all: these move exactly under forces that are linear over the
// step, q = e11 q_0 + e12 q'_0 + u0 f_0 + u1 f_1, so that S = 1/u1. Only vehicles and contacts are left to the method.
//
// This file is compiled once for each kind of processor. Nothing in it may be seen by the linker, or code for one
// processor could be taken for another: no functions of the library, everything in an unnamed namespace.
#pragma once

#include "lanes/crossing_algebra.hpp"
#include "lanes/crossing_task.hpp"

namespace traverse::lanes {
namespace {

template <int W>
class Group : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using Own::any;
  using Own::factorise;
  using Own::fill;
  using Own::influence_at;
  using Own::invert;
  using Own::lanes;
  using Own::magnitude;
  using Own::multiply;
  using Own::oscillate;
  using Own::predict;
  using Own::root;
  using Own::solve;
  using Own::track_at;
  using typename Own::Lane;
  using typename Own::Mask;
  using typename Own::Oscillation;
  using typename Own::Rule;

 public:
  Group(const Task& task, double* work) : task_(task), modes_(task.modes) { lay_out(work); }
  long size() const { return used_ * W; }

  void run() {
    begin();
    double from = 0.0;
    for (int i = 0; i < task_.stretches; ++i) {
      const TaskStretch& stretch = task_.stretch[i];
      const double ds = (stretch.to - from) / static_cast<double>(stretch.steps);
      set_step(ds);
      for (long k = 0; k < stretch.steps; ++k) {
        place_vehicles(from + static_cast<double>(k) * ds);
        for (int stage = 0; stage < task_.method.stages; ++stage) solve_stage(stage);
        finish_step();
        distance_ = k + 1 < stretch.steps ? from + static_cast<double>(k + 1) * ds : stretch.to;
        look(true);
      }
      known_ = 1;  // moments may have a kink there
      if (!any(failed_ == fill(0.0))) break;
      from = stretch.to;
    }
    give();
  }

 private:
  static constexpr double force_tolerance = 1e-9;  // of the force scale: what a contact's law may be missed by
  static constexpr int few_iterations = 6, most_iterations = 20, fresh_after = 4;
  static constexpr double least_penetration = 1e-12;  // m: below, the contact counts as lost
  static constexpr double near = 0.9;   // of the largest magnitude so far: no parabola's vertex of less is larger
  static constexpr double alike = 4.0;  // see WheelExtremes

  // --- memory ------------------------------------------------------------------------------------------------------

  template <class T>
  T* take(double* work, long count) {
    return take_from<T>(work, used_, W, count);
  }

  struct KindWork {
    Lane *inverse, *by_state;  // J^-1; J^-1 [K C], freedom x 2 freedom
    Lane* alone;               // -J^-1 r0
    Lane *Y, *Y_along, *H;     // J^-1 G^T (freedom x wheels), the same for forces along the track, d G J^-1 G^T
  };

  void lay_out(double* work) {
    const long n = task_.coordinates, wheels = task_.wheels, modes = modes_, probes = 3L * task_.probes.count;
    kinds_ = take<KindWork>(work, task_.kinds);
    for (int k = 0; k < task_.kinds; ++k) {
      const long f = task_.kind[k].freedom, w = task_.kind[k].wheels;
      const KindWork own = {take<Lane>(work, f * f), take<Lane>(work, 2 * f * f), take<Lane>(work, f),
                            take<Lane>(work, f * w), take<Lane>(work, f * w),     take<Lane>(work, w * w)};
      if (work != nullptr) kinds_[k] = own;
    }
    Lane** const of_coordinates[] = {&x_, &w_, &a_free_, &bent_};
    for (Lane** own : of_coordinates) *own = take<Lane>(work, n);
    still_ = take<Lane>(work, 2 * n);
    most_bent_ = take<Lane>(work, task_.vehicles);
    Lane** const of_modes[] = {&q_, &r_, &q_still_, &r_still_, &z_, &p_, &omega2_, &load_, &rhs_, &scaled_};
    for (Lane** own : of_modes) *own = take<Lane>(work, modes);
    for (int j = 0; j < most_kept; ++j) {
      a_[j] = take<Lane>(work, j < task_.method.known ? n : 0);
      b_[j] = take<Lane>(work, j < task_.method.known ? modes : 0);
    }
    to_q_ = take<Lane>(work, task_.exact_modes ? 4 * modes : 0);
    to_r_ = take<Lane>(work, task_.exact_modes ? 4 * modes : 0);
    S_ = take<Lane>(work, modes * modes);
    S_inverse_ = take<Lane>(work, modes * (task_.coupled ? modes : 1));
    factor_ = take<Lane>(work, modes * modes);
    Lane** const of_wheels[] = {&offset_, &delta_,    &F_,     &k_,  &free_, &end_,        &slope_,
                                &yield_,  &residual_, &pivot_, &F0_, &F1_,   &track_slope_};
    for (Lane** own : of_wheels) *own = take<Lane>(work, wheels);
    D_begin_ = take<long>(work, task_.vehicles + 1);
    long entries = 0;
    for (int v = 0; v < task_.vehicles; ++v) {
      const long w = task_.kind[task_.vehicle[v].kind].wheels;
      if (work != nullptr) D_begin_[v] = entries;
      entries += w * w;
    }
    D_ = take<Lane>(work, entries);
    reduced_ = take<Lane>(work, wheels * modes);
    g_ = take<double>(work, wheels * task_.influence.channels);
    load_g_ = take<double>(work, static_cast<long>(task_.loads) * task_.influence.channels);
    piece_ = take<int>(work, wheels);
    load_piece_ = take<int>(work, task_.loads);
    on_ = take<char>(work, wheels);
    load_on_ = take<char>(work, task_.loads);
    awake_ = take<char>(work, task_.vehicles);
    touching_ = take<char>(work, task_.vehicles);
    for (Lane*& row : row_of_) row = take<Lane>(work, probes);
    peak_ = take<Lane>(work, probes);
    peak_time_ = take<Lane>(work, probes);
  }

  // --- places ------------------------------------------------------------------------------------------------------

  /// Wheels and forces when all have travelled s. Fills free_ with the penetration over a bridge at rest.
  void place(double s, int channels) {
    for (int v = 0; v < task_.vehicles; ++v) {
      if (awake_[v] == 0) continue;
      const TaskVehicle& vehicle = task_.vehicle[v];
      touching_[v] = 0;
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + task_.kind[vehicle.kind].wheels; ++j) {
        const double x = task_.x[j] + s;
        on_[j] =
            influence_at(task_.influence, x, &piece_[j], channels, g_ + static_cast<long>(j) * task_.influence.channels)
                ? 1
                : 0;
        touching_[v] = static_cast<char>(touching_[v] | on_[j]);
        Lane height;
        track_at(task_.heights, x, height, track_slope_[j]);
        free_[j] = offset_[j] + height;
      }
    }
    for (int j = 0; j < task_.loads; ++j) {
      double* g = load_g_ + static_cast<long>(j) * task_.influence.channels;
      load_on_[j] = influence_at(task_.influence, task_.load_x[j] + s, &load_piece_[j], channels, g) ? 1 : 0;
    }
    for (int i = 0; i < modes_; ++i) load_[i] = Lane{};
    for (int j = 0; j < task_.loads; ++j) {
      if (load_on_[j] == 0) continue;
      const double* g = load_g_ + static_cast<long>(j) * task_.influence.channels;
      const Lane force = lanes(task_.load)[j];
      for (int i = 0; i < modes_; ++i) load_[i] += g[i] * force;
    }
  }

  void place_vehicles(double s) {
    start_ = s;
    for (int v = 0; v < task_.vehicles; ++v) awake_[v] = s + 1e-9 >= task_.vehicle[v].rests_until ? 1 : 0;
  }

  // --- start -------------------------------------------------------------------------------------------------------

  void begin() {
    for (int i = 0; i < task_.coordinates; ++i) {
      x_[i] = w_[i] = bent_[i] = Lane{};
      for (int j = 0; j < task_.method.known; ++j) a_[j][i] = Lane{};
    }
    for (int i = 0; i < modes_; ++i) {
      q_[i] = lanes(task_.q)[i];
      r_[i] = p_[i] = Lane{};
      omega2_[i] = lanes(task_.omega2)[i];
      for (int j = 0; j < task_.method.known; ++j) b_[j][i] = Lane{};
    }
    for (int j = 0; j < task_.wheels; ++j) {
      piece_[j] = 0;
      offset_[j] = Lane{};
      delta_[j] = end_[j] = lanes(task_.penetration)[j];
      slope_[j] = Lane{};
      F_[j] = law(j, delta_[j], k_[j]);
      F0_[j] = F1_[j] = F_[j];
    }
    for (int j = 0; j < task_.loads; ++j) load_piece_[j] = 0;
    for (int v = 0; v < task_.vehicles; ++v) {
      awake_[v] = 1;
      most_bent_[v] = Lane{};
    }
    speed_ = *lanes(task_.speed);
    end_time_ = *lanes(task_.end_time);
    failed_ = Lane{};
    least_ = fill(1e300);
    greatest_ = fill(-1e300);
    for (int i = 0; i < 3 * task_.probes.count; ++i) peak_[i] = peak_time_[i] = Lane{};
    distance_ = start_ = 0.0;
    ds_ = ds_before_ = 0.0;
    known_ = looks_ = seen_ = 0;
    // The wheels' heights over the bridge as it stands.
    place(0.0, task_.influence.channels);
    for (int j = 0; j < task_.wheels; ++j) offset_[j] = delta_[j] - free_[j] - surface(j);
    look(false);
  }

  /// By how much the bridge lifts a wheel.
  Lane surface(int j) const {
    Lane height{};
    if (on_[j] == 0) return height;
    const double* g = g_ + static_cast<long>(j) * task_.influence.channels;
    for (int i = 0; i < modes_; ++i) height -= g[i] * q_[i];
    return height;
  }

  Lane law(int j, Lane delta, Lane& tangent) const {
    const Lane k = lanes(task_.stiffness)[j];
    delta = delta > least_penetration ? delta : fill(least_penetration);
    if (task_.hertz[j] == 0) {
      tangent = k;
      return k * delta;
    }
    const Lane steep = k * root(delta);
    tangent = 1.5 * steep;
    return steep * delta;
  }

  // --- a step's length ---------------------------------------------------------------------------------------------

  void set_step(double ds) {
    const double change = ds - ds_;
    if ((change < 0.0 ? -change : change) <= 1e-13 * ds) return;
    hard_ = Mask{};
    renew_step(ds);
    yield_to_force_ = fill(1.0);
    if (task_.coupled) return;
    Lane compliance{}, stiffest{};
    for (int i = 0; i < modes_; ++i)
      compliance += task_.influence.largest[i] * task_.influence.largest[i] * S_inverse_[i];
    for (int j = 0; j < task_.wheels; ++j) stiffest = k_[j] > stiffest ? k_[j] : stiffest;
    yield_to_force_ = 2.0 * compliance * stiffest;  // a tangent is not twice as steep under any force that holds
  }

  void renew_step(double ds) {
    ds_ = ds;
    h_ = ds / speed_;
    rate_ = task_.method.rate * h_;
    d_ = task_.method.displacement * h_ * h_;
    for (int k = 0; k < task_.kinds; ++k) renew(task_.kind[k], kinds_[k]);
    for (int i = 0; i < modes_; ++i)
      for (int j = 0; j < modes_; ++j) S_[i * modes_ + j] = Lane{};
    for (int i = 0; i < modes_; ++i) S_[i * modes_ + i] = 1.0 / d_ + omega2_[i];
    const Lane over = rate_ / d_;
    const Lane* c = lanes(task_.damping);
    if (task_.exact_modes) return set_exact_modes();
    if (!task_.coupled) {
      for (int i = 0; i < modes_; ++i) {
        S_[i * modes_ + i] += over * c[i];
        S_inverse_[i] = 1.0 / S_[i * modes_ + i];
      }
      return;
    }
    for (int i = 0; i < modes_ * modes_; ++i) {
      S_[i] += over * c[i];
      S_inverse_[i] = S_[i];
    }
    invert(S_inverse_, modes_);
  }

  void set_exact_modes() {
    const double* k = task_.omega2;
    const double* c = task_.damping;
    const double* h = reinterpret_cast<const double*>(&h_);
    for (int i = 0; i < modes_; ++i) {
      for (int from = 0; from < 4; ++from) {
        double* u = reinterpret_cast<double*>(&to_q_[4 * i + from]);
        double* w = reinterpret_cast<double*>(&to_r_[4 * i + from]);
        for (int l = 0; l < W; ++l) {
          const Oscillation end = oscillate(k[i * W + l], c[i * W + l], h[l], from == 0 ? 1.0 : 0.0,
                                            from == 1 ? 1.0 : 0.0, from == 2 ? 1.0 : 0.0, from == 3 ? 1.0 : 0.0);
          u[l] = end.u;
          w[l] = end.w;
        }
      }
      S_[i * modes_ + i] = 1.0 / to_q_[4 * i + 3];
      S_inverse_[i] = to_q_[4 * i + 3];
    }
  }

  void renew(const TaskKind& kind, const KindWork& own) {
    const int f = kind.freedom, w = kind.wheels;
    for (int i = 0; i < f * f; ++i)
      own.inverse[i] = lanes(kind.M)[i] + rate_ * lanes(kind.C)[i] + d_ * lanes(kind.K)[i];
    invert(own.inverse, f);
    for (int i = 0; i < f; ++i) {
      const Lane* row = own.inverse + i * f;
      Lane* to = own.by_state + 2 * i * f;
      own.alone[i] = Lane{};
      for (int j = 0; j < 2 * f; ++j) to[j] = Lane{};
      for (int k = 0; k < f; ++k) {
        own.alone[i] -= row[k] * lanes(kind.r0)[k];
        for (int j = 0; j < f; ++j) {
          to[j] += row[k] * lanes(kind.K)[k * f + j];
          to[f + j] += row[k] * lanes(kind.C)[k * f + j];
        }
      }
    }
    for (int i = 0; i < f; ++i)
      for (int j = 0; j < w; ++j) {
        Lane sum{};
        for (int e = kind.G_row[j]; e < kind.G_row[j + 1]; ++e) {
          const int k = kind.G_column[e];
          sum += own.inverse[i * f + k] * lanes(kind.G)[j * f + k];
        }
        own.Y[i * w + j] = sum;
        Lane along{};
        for (int k = 0; k < f; ++k) along += own.inverse[i * f + k] * lanes(kind.G_along)[j * f + k];
        own.Y_along[i * w + j] = along;
      }
    for (int i = 0; i < w; ++i)
      for (int j = 0; j < w; ++j) {
        Lane sum{};
        for (int e = kind.G_row[i]; e < kind.G_row[i + 1]; ++e) {
          const int k = kind.G_column[e];
          sum += lanes(kind.G)[i * f + k] * own.Y[k * w + j];
        }
        own.H[i * w + j] = d_ * sum;
      }
  }

  // --- a stage -----------------------------------------------------------------------------------------------------

  Rule rule_for(double w_in_v, const double* a_in_v, const double* a_in_w, int known) const {
    Rule rule;
    rule.w_in_v = w_in_v * h_;
    for (int j = 0; j < known; ++j) {
      rule.a_in_v[j] = a_in_v[j] * h_ * h_;
      rule.a_in_w[j] = a_in_w[j] * h_;
    }
    return rule;
  }

  void solve_stage(int stage) {
    const TaskMethod& method = task_.method;
    const double s = start_ + method.time[stage] * ds_;
    const bool last = stage + 1 == method.stages;
    place(s, last ? task_.influence.channels : modes_);
    const Rule rule = rule_for(method.w_in_v[stage], method.a_in_v[stage], method.a_in_w[stage], stage + 1);
    for (int v = 0; v < task_.vehicles; ++v)
      if (awake_[v] != 0) free_vehicle(v, stage + 1, rule);
    if (task_.exact_modes) {
      free_exact_modes();
    } else {
      predict(stage + 1, modes_, rule, q_, r_, b_, 0, q_still_, r_still_);
      free_modes();
    }
    const double ahead = ds_before_ > 0.0 ? method.time[stage] * ds_ / ds_before_ : 0.0;
    for (int v = 0; v < task_.vehicles; ++v) {
      if (awake_[v] == 0) continue;
      const TaskVehicle& vehicle = task_.vehicle[v];
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + task_.kind[vehicle.kind].wheels; ++j) {
        if (on_[j] != 0) {
          const double* g = g_ + static_cast<long>(j) * task_.influence.channels;
          Lane height{};
          for (int i = 0; i < modes_; ++i) height -= g[i] * z_[i];
          free_[j] += height;
        }
        const Lane guess = end_[j] + ahead * slope_[j];
        delta_[j] = guess > 0.5 * end_[j] ? guess : 0.5 * end_[j];
        F_[j] = law(j, delta_[j], k_[j]);
      }
    }
    solve_contacts();
    for (int v = 0; v < task_.vehicles; ++v)
      if (awake_[v] != 0) take_forces(v, stage + 1);
    if (task_.exact_modes) return move_exact_modes();
    const Lane per_d = 1.0 / d_;
    for (int i = 0; i < modes_; ++i) b_[stage + 1][i] = per_d * (z_[i] - q_still_[i] + p_[i]);
  }

  /// Without contact forces.
  void free_vehicle(int v, int known, const Rule& rule) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const TaskKind& kind = task_.kind[vehicle.kind];
    const KindWork& own = kinds_[vehicle.kind];
    const int f = kind.freedom, first = vehicle.first_coordinate;
    Lane *x = still_ + 2 * first, *w = x + f, *a = a_free_ + first;
    predict(known, f, rule, x_ + first, w_ + first, a_, first, x, w);
    for (int i = 0; i < f; ++i) a[i] = own.alone[i];
    multiply(-1.0, own.by_state, f, 2 * f, x, a);
    if (task_.heights.stations > 0)
      for (int j = 0; j < kind.wheels; ++j) {
        // The contact's force stands square on the track: it pushes along it by its slope, as it was last found.
        const Lane push = track_slope_[vehicle.first_wheel + j] * F_[vehicle.first_wheel + j];
        for (int i = 0; i < f; ++i) a[i] -= own.Y_along[i * kind.wheels + j] * push;
      }
    for (int j = 0; j < kind.wheels; ++j) {
      Lane up{};
      for (int e = kind.G_row[j]; e < kind.G_row[j + 1]; ++e) {
        const int k = kind.G_column[e];
        up += lanes(kind.G)[j * f + k] * (x[k] + d_ * a[k]);
      }
      free_[vehicle.first_wheel + j] -= up;
      if (task_.heights.stations == 0) continue;
      Lane along{};
      for (int k = 0; k < f; ++k) along += lanes(kind.G_along)[j * f + k] * (x[k] + d_ * a[k]);
      free_[vehicle.first_wheel + j] += track_slope_[vehicle.first_wheel + j] * along;
    }
  }

  /// z_: where the modes would be without the contacts.
  void free_modes() {
    const Lane* c = lanes(task_.damping);
    if (!task_.coupled) {
      for (int i = 0; i < modes_; ++i)
        z_[i] = q_still_[i] + S_inverse_[i] * (load_[i] - c[i] * r_still_[i] - omega2_[i] * q_still_[i]);
      return;
    }
    for (int i = 0; i < modes_; ++i) {
      rhs_[i] = load_[i] - omega2_[i] * q_still_[i];
      for (int j = 0; j < modes_; ++j) rhs_[i] -= c[i * modes_ + j] * r_still_[j];
    }
    for (int i = 0; i < modes_; ++i) {
      z_[i] = q_still_[i];
      for (int j = 0; j < modes_; ++j) z_[i] += S_inverse_[i * modes_ + j] * rhs_[j];
    }
  }

  void free_exact_modes() {
    const Lane* c = lanes(task_.damping);
    for (int i = 0; i < modes_; ++i) {
      const Lane* to = to_q_ + 4 * i;
      const Lane before = b_[0][i] + c[i] * r_[i] + omega2_[i] * q_[i];
      z_[i] = to[0] * q_[i] + to[1] * r_[i] + to[2] * before + to[3] * load_[i];
    }
  }

  void move_exact_modes() {
    const Lane* c = lanes(task_.damping);
    for (int i = 0; i < modes_; ++i) {
      const Lane* to = to_r_ + 4 * i;
      const Lane before = b_[0][i] + c[i] * r_[i] + omega2_[i] * q_[i];
      const Lane after = load_[i] + S_[i * modes_ + i] * p_[i];
      r_[i] = to[0] * q_[i] + to[1] * r_[i] + to[2] * before + to[3] * after;
      q_[i] = z_[i] + p_[i];
      b_[0][i] = after - c[i] * r_[i] - omega2_[i] * q_[i];
    }
  }

  /// In short steps masses hardly yield to a change of contact forces: each contact by itself, and all others as they
  /// were, converges fast. Where it does not, all together.
  void solve_contacts() {
    for (int i = 0; i < modes_; ++i) p_[i] = Lane{};
    const Mask running = failed_ == Lane{};
    const Mask left = one_by_one(running & ~hard_) | (running & hard_);
    if (!any(left)) return;
    hard_ |= left;
    all_together(left);
  }

  /// Returns the lanes in which that did not converge.
  Mask one_by_one(Mask open) {
    moved_ = fill(1e300);  // by how much forces have changed since the bridge was last pushed, N
    for (int iteration = 0; any(open); ++iteration) {
      if (iteration == few_iterations) return open;
      const Mask push = open & (yield_to_force_ * moved_ > force_tolerance * task_.force_scale);
      if (any(push)) push_bridge(push);
      Mask wrong{};
      for (int v = 0; v < task_.vehicles; ++v)
        if (awake_[v] != 0) wrong |= update_one_by_one(v, open);
      open &= wrong;
    }
    return open;
  }

  /// p_ under the contacts' forces.
  void push_bridge(Mask push) {
    for (int i = 0; i < modes_; ++i) rhs_[i] = Lane{};
    for (int v = 0; v < task_.vehicles; ++v) {
      if (awake_[v] == 0 || touching_[v] == 0) continue;
      const TaskVehicle& vehicle = task_.vehicle[v];
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + task_.kind[vehicle.kind].wheels; ++j) {
        if (on_[j] == 0) continue;
        const double* g = g_ + static_cast<long>(j) * task_.influence.channels;
        for (int i = 0; i < modes_; ++i) rhs_[i] += g[i] * F_[j];
      }
    }
    moved_ = push ? Lane{} : moved_;
    for (int i = 0; i < modes_; ++i) {
      Lane p{};
      if (task_.coupled) {
        for (int j = 0; j < modes_; ++j) p += S_inverse_[i * modes_ + j] * rhs_[j];
      } else {
        p = S_inverse_[i] * rhs_[i];
      }
      p_[i] = push ? p : p_[i];
    }
  }

  /// One step of Newton's for each contact; returns the lanes in which the penetrations were not yet right.
  Mask update_one_by_one(int v, Mask open) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const int w = task_.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    const Lane* H = kinds_[vehicle.kind].H;
    Lane* off = residual_ + first;
    for (int i = 0; i < w; ++i) {
      Lane c = free_[first + i] - delta_[first + i];
      for (int k = 0; k < w; ++k) c -= H[i * w + k] * F_[first + k];
      if (on_[first + i] != 0) {
        const double* g = g_ + static_cast<long>(first + i) * task_.influence.channels;
        Lane height{}, more{};
        int k = 0;
        for (; k + 2 <= modes_; k += 2) {
          height += g[k] * p_[k];
          more += g[k + 1] * p_[k + 1];
        }
        for (; k < modes_; ++k) height += g[k] * p_[k];
        c -= height + more;
      }
      off[i] = c;
    }
    Mask wrong{};
    for (int i = 0; i < w; ++i) {
      const int j = first + i;
      const Lane change = magnitude(off[i]) * k_[j];
      wrong |= change > force_tolerance * task_.force_scale;
      if (on_[j] != 0) moved_ += change;
      const Lane delta = delta_[j] + off[i] / (1.0 + H[i * w + i] * k_[j]);
      Lane tangent;
      const Lane force = law(j, delta, tangent);
      failed_ = (open & (delta <= fill(least_penetration))) ? fill(contact_lost) : failed_;
      delta_[j] = open ? delta : delta_[j];
      F_[j] = open ? force : F_[j];
      k_[j] = tangent;
    }
    return wrong;
  }

  void all_together(Mask open) {
    bool on_bridge = false;
    for (int v = 0; v < task_.vehicles; ++v) on_bridge |= awake_[v] != 0 && touching_[v] != 0;
    for (int iteration = 0; any(open); ++iteration) {
      if (iteration == most_iterations) {
        failed_ = open ? fill(not_converged) : failed_;
        return;
      }
      const bool fresh = iteration % fresh_after == 0;
      if (fresh && on_bridge)
        for (int i = 0; i < modes_ * modes_; ++i) factor_[i] = S_[i];
      for (int i = 0; i < modes_; ++i) rhs_[i] = Lane{};
      for (int v = 0; v < task_.vehicles; ++v)
        if (awake_[v] != 0) condense(v, fresh);
      if (on_bridge) {
        if (fresh) factorise(factor_, modes_, scaled_);
        solve(factor_, modes_, rhs_);
        for (int i = 0; i < modes_; ++i) p_[i] = open ? rhs_[i] : p_[i];
      }
      Mask wrong{};
      for (int v = 0; v < task_.vehicles; ++v)
        if (awake_[v] != 0) wrong |= update(v, open);
      open &= wrong;
    }
  }

  /// A vehicle's contacts into the modes' equations.
  void condense(int v, bool fresh) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const int w = task_.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    Lane* L = D_ + D_begin_[v];
    if (fresh) {
      const Lane* H = kinds_[vehicle.kind].H;
      for (int i = 0; i < w; ++i) pivot_[first + i] = 1.0 / k_[first + i];
      for (int j = 0; j < w; ++j) {
        // Symmetric, but for rounding: the lower half serves. yield_ holds 1/k from here on.
        Lane pivot = H[j * w + j] + pivot_[first + j];
        yield_[first + j] = pivot_[first + j];
        for (int k = 0; k < j; ++k) pivot -= L[j * w + k] * L[j * w + k] * L[k * w + k];
        L[j * w + j] = pivot;
        pivot_[first + j] = 1.0 / pivot;
        for (int i = j + 1; i < w; ++i) {
          Lane entry = H[i * w + j];
          for (int k = 0; k < j; ++k) entry -= L[i * w + k] * L[j * w + k] * L[k * w + k];
          L[i * w + j] = entry * pivot_[first + j];
        }
      }
    }
    for (int i = 0; i < w; ++i) {
      Lane r = free_[first + i] - delta_[first + i] + yield_[first + i] * F_[first + i];
      for (int k = 0; k < i; ++k) r -= L[i * w + k] * residual_[first + k];
      residual_[first + i] = r;
    }
    if (touching_[v] == 0) return;
    Lane* rows = reduced_ + static_cast<long>(first) * modes_;
    if (fresh) reduce(first, w, L, rows);
    for (int i = 0; i < w; ++i) {
      const Lane* row = rows + i * modes_;
      const Lane weighted = residual_[first + i] * pivot_[first + i];
      for (int k = 0; k < modes_; ++k) rhs_[k] += row[k] * weighted;
    }
  }

  /// The rows of L^-1 g, and their share of the modes' matrix.
  void reduce(int first, int w, const Lane* L, Lane* rows) {
    for (int i = 0; i < w; ++i) {
      Lane* row = rows + i * modes_;
      const double* g = g_ + static_cast<long>(first + i) * task_.influence.channels;
      for (int k = 0; k < modes_; ++k) row[k] = on_[first + i] != 0 ? fill(g[k]) : Lane{};
      for (int j = 0; j < i; ++j) {
        const Lane* before = rows + j * modes_;
        const Lane entry = L[i * w + j];
        for (int k = 0; k < modes_; ++k) row[k] -= entry * before[k];
      }
    }
    int i = 0;
    for (; i + 2 <= w; i += 2) {
      const Lane *a = rows + i * modes_, *b = a + modes_;
      for (int k = 0; k < modes_; ++k) {
        const Lane of_a = pivot_[first + i] * a[k], of_b = pivot_[first + i + 1] * b[k];
        Lane* to = factor_ + k * modes_;
        for (int l = 0; l <= k; ++l) to[l] += of_a * a[l] + of_b * b[l];
      }
    }
    for (; i < w; ++i) {
      const Lane* a = rows + i * modes_;
      for (int k = 0; k < modes_; ++k) {
        const Lane of_a = pivot_[first + i] * a[k];
        for (int l = 0; l <= k; ++l) factor_[k * modes_ + l] += of_a * a[l];
      }
    }
  }

  /// New forces and penetrations from the modes' p_; returns the lanes in which they miss the contacts' laws.
  Mask update(int v, Mask open) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const int w = task_.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    const Lane* L = D_ + D_begin_[v];
    if (touching_[v] != 0)
      multiply(-1.0, reduced_ + static_cast<long>(first) * modes_, w, modes_, p_, residual_ + first);
    Mask wrong{};
    for (int i = w - 1; i >= 0; --i) {
      Lane force = residual_[first + i] * pivot_[first + i];
      for (int k = i + 1; k < w; ++k) force -= L[k * w + i] * residual_[first + k];
      residual_[first + i] = force;
      const int j = first + i;
      const Lane delta = delta_[j] + yield_[j] * (force - F_[j]);
      Lane tangent;
      const Lane by_law = law(j, delta, tangent);
      wrong |= magnitude(by_law - force) > force_tolerance * task_.force_scale;
      failed_ = (open & (delta <= fill(least_penetration))) ? fill(contact_lost) : failed_;
      delta_[j] = open ? delta : delta_[j];
      F_[j] = open ? by_law : F_[j];
      k_[j] = tangent;
    }
    return wrong;
  }

  void take_forces(int v, int stage) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const TaskKind& kind = task_.kind[vehicle.kind];
    Lane* a = a_[stage] + vehicle.first_coordinate;
    for (int i = 0; i < kind.freedom; ++i) a[i] = a_free_[vehicle.first_coordinate + i];
    multiply(1.0, kinds_[vehicle.kind].Y, kind.freedom, kind.wheels, F_ + vehicle.first_wheel, a);
  }

  // --- the end of a step -------------------------------------------------------------------------------------------

  void finish_step() {
    const TaskMethod& method = task_.method;
    const Rule rule = rule_for(method.end_w_in_v, method.end_a_in_v, method.end_a_in_w, method.known);
    const auto end = [&](Lane* x, Lane* w, Lane* const* a, int i) {
      Lane next{}, position = x[i] + rule.w_in_v * w[i], rate = w[i];
      for (int j = 0; j < method.known; ++j) {
        position += rule.a_in_v[j] * a[j][i];
        rate += rule.a_in_w[j] * a[j][i];
        next += method.a_next[j] * a[j][i];
      }
      x[i] = position;
      w[i] = rate;
      a[0][i] = next;
    };
    for (int v = 0; v < task_.vehicles; ++v) {
      if (awake_[v] == 0) continue;
      const TaskVehicle& vehicle = task_.vehicle[v];
      const TaskKind& kind = task_.kind[vehicle.kind];
      for (int i = vehicle.first_coordinate; i < vehicle.first_coordinate + kind.freedom; ++i) end(x_, w_, a_, i);
      note_bent(v);
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + kind.wheels; ++j) {
        slope_[j] = delta_[j] - end_[j];
        end_[j] = delta_[j];
      }
    }
    if (!task_.exact_modes)
      for (int i = 0; i < modes_; ++i) end(q_, r_, b_, i);
    ds_before_ = ds_;
  }

  /// Keeps the coordinates at which the mechanism is farthest from linear.
  void note_bent(int v) {
    const TaskVehicle& vehicle = task_.vehicle[v];
    const TaskKind& kind = task_.kind[vehicle.kind];
    const Lane* x = x_ + vehicle.first_coordinate;
    Lane bent{};
    for (int i = 0; i < kind.freedom; ++i) bent += kind.bend[i] * magnitude(x[i]);
    const Mask more = bent > most_bent_[v];
    if (!any(more)) return;
    most_bent_[v] = more ? bent : most_bent_[v];
    Lane* kept = bent_ + vehicle.first_coordinate;
    for (int i = 0; i < kind.freedom; ++i) kept[i] = more ? x[i] : kept[i];
  }

  // --- what is seen ------------------------------------------------------------------------------------------------

  void look(bool moved) {
    const Lane time = distance_ / speed_;
    const Mask counts = time <= end_time_ * (1.0 + 1e-12);
    time_[0] = time_[1];
    time_[1] = time_[2];
    time_[2] = time;
    ++known_;
    ++looks_;
    look_at_probes(counts);
    if (moved) look_at_wheels(counts);
    Lane sum{};
    for (int i = 0; i < modes_; ++i) sum += q_[i];
    failed_ = sum - sum == Lane{} ? failed_ : fill(not_finite);
  }

  void look_at_probes(Mask counts) {
    const int n = task_.probes.count, count = 3 * n;
    Lane* const oldest = row_of_[0];
    row_of_[0] = row_of_[1];
    row_of_[1] = row_of_[2];
    row_of_[2] = oldest;
    Lane* seen = row_of_[2];
    for (int i = 0; i < count; ++i) seen[i] = Lane{};
    const auto add_corrections = [&](const double* g, Lane force) {
      for (int p = 0; p < n; ++p) {
        seen[p] += g[modes_ + p] * force;
        seen[2 * n + p] += g[modes_ + n + p] * force;
      }
    };
    for (int j = 0; j < task_.wheels; ++j)
      if (on_[j] != 0) add_corrections(g_ + static_cast<long>(j) * task_.influence.channels, F_[j]);
    for (int j = 0; j < task_.loads; ++j)
      if (load_on_[j] != 0)
        add_corrections(load_g_ + static_cast<long>(j) * task_.influence.channels, lanes(task_.load)[j]);
    for (int i = 0; i < modes_; ++i) {
      const Lane q = q_[i], r = r_[i], a = b_[0][i];
      const double *deflection = task_.probes.deflection + static_cast<long>(i) * n,
                   *moment = task_.probes.moment + static_cast<long>(i) * n,
                   *by_rate = task_.probes.moment_by_rate + static_cast<long>(i) * n,
                   *by_acceleration = task_.probes.moment_by_acceleration + static_cast<long>(i) * n;
      for (int p = 0; p < n; ++p) {
        seen[p] += deflection[p] * q;
        seen[n + p] += deflection[p] * a;
        seen[2 * n + p] += moment[p] * q + by_rate[p] * r + by_acceleration[p] * a;
      }
      if (task_.probes.deflection_by_rate == nullptr) continue;
      for (int p = 0; p < n; ++p) seen[p] += task_.probes.deflection_by_rate[static_cast<long>(i) * n + p] * r;
    }
    for (int i = 0; i < count; ++i) {
      const Lane value = magnitude(seen[i]);
      const Mask larger = counts & (value > peak_[i]);
      peak_[i] = larger ? value : peak_[i];
      peak_time_[i] = larger ? time_[2] : peak_time_[i];
      if ((i < 2 * n ? looks_ : known_) < 3) continue;
      const Lane middle = magnitude(row_of_[1][i]);
      const Mask turns = counts & (middle > near * peak_[i]) & (middle > value);
      if (any(turns)) look_between(i, turns);
    }
  }

  /// The vertex of the parabola through the last three instants, of whose magnitudes the middle one is the largest.
  void look_between(int i, Mask turns) {
    const Lane sign = row_of_[1][i] < Lane{} ? fill(-1.0) : fill(1.0);
    const Lane y0 = sign * row_of_[0][i], y1 = sign * row_of_[1][i], y2 = sign * row_of_[2][i];
    turns &= y1 >= y0;
    const Lane before = (y1 - y0) / (time_[1] - time_[0]), after = (y2 - y1) / (time_[2] - time_[1]);
    const Lane bend = (after - before) / (time_[2] - time_[0]);
    const Lane at = 0.5 * (time_[0] + time_[1]) - 0.5 * before / bend;
    const Lane top = y1 + (at - time_[1]) * (before + bend * (at - time_[0]));
    turns &= top > peak_[i];
    peak_[i] = turns ? top : peak_[i];
    peak_time_[i] = turns ? at : peak_time_[i];
  }

  void look_at_wheels(Mask counts) {
    ++seen_;
    const Lane before = time_[1] - time_[0], after = time_[2] - time_[1];
    const double step = distance_ - s_before_[1], step_before = s_before_[1] - s_before_[0];
    const bool comparable = seen_ >= 3 && step_before <= alike * step && step <= alike * step_before;
    for (int j = 0; j < task_.wheels; ++j) {
      const Lane force = F_[j];
      least_ = counts & (force < least_) ? force : least_;
      greatest_ = counts & (force > greatest_) ? force : greatest_;
      const Lane rise = F1_[j] - F0_[j], fall = force - F1_[j];
      const Mask turns = counts & (rise * fall <= Lane{}) & (F1_[j] != force);
      if (comparable && any(turns) && smooth(task_.x[j])) {
        const Lane up = rise / before, down = fall / after;
        const Lane slope = (up * after + down * before) / (before + after), bend = (down - up) / (before + after);
        const Lane top = F1_[j] - 0.25 * slope * slope / bend;
        least_ = turns & (top < least_) & (top > Lane{}) ? top : least_;
        greatest_ = turns & (top > greatest_) ? top : greatest_;
      }
      F0_[j] = F1_[j];
      F1_[j] = force;
    }
    s_before_[0] = s_before_[1];
    s_before_[1] = distance_;
  }

  /// Whether a wheel has met no corner of the surface within the last two steps.
  bool smooth(double x) const {
    const double from = x + s_before_[0], to = x + distance_;
    for (int i = 0; i < task_.kinks; ++i)
      if (task_.kink[i] >= from && task_.kink[i] <= to) return false;
    return true;
  }

  void give() {
    for (int i = 0; i < 3 * task_.probes.count; ++i) {
      lanes(task_.peak)[i] = peak_[i];
      lanes(task_.peak_time)[i] = peak_time_[i];
    }
    *lanes(task_.least_force) = least_;
    *lanes(task_.greatest_force) = greatest_;
    for (int i = 0; i < task_.coordinates; ++i) lanes(task_.bent)[i] = bent_[i];
    *lanes(task_.failed) = failed_;
  }

  const Task& task_;
  const int modes_;
  long used_ = 0;
  KindWork* kinds_ = nullptr;
  Lane speed_{}, end_time_{}, h_{}, rate_{}, d_{}, failed_{}, least_{}, greatest_{};
  double ds_ = 0.0, ds_before_ = 0.0, distance_ = 0.0, start_ = 0.0, s_before_[2] = {};
  long known_ = 0, looks_ = 0, seen_ = 0;  // instants since the last kink of moments, since the start; of wheels
  Lane time_[3] = {};
  Lane moved_{}, yield_to_force_{};  // of one_by_one; what pushing the bridge by a force changes another one by
  Mask hard_{};                      // lanes whose contacts are solved all together at this step length
  // Vehicles: coordinates, rates, the same at zero acceleration, accelerations without contacts.
  Lane *x_ = nullptr, *w_ = nullptr, *still_ = nullptr, *a_free_ = nullptr;
  Lane *bent_ = nullptr, *most_bent_ = nullptr;  // coordinates where a vehicle was farthest from linear; how far
  // Modes: coordinates, rates, the same at zero acceleration, without contacts, what contacts add.
  Lane *q_ = nullptr, *r_ = nullptr, *q_still_ = nullptr, *r_still_ = nullptr, *z_ = nullptr, *p_ = nullptr;
  Lane *omega2_ = nullptr, *load_ = nullptr, *rhs_ = nullptr, *scaled_ = nullptr;
  Lane* a_[most_kept] = {};
  Lane* b_[most_kept] = {};                 // accelerations at the start of the step and at its stages
  Lane *to_q_ = nullptr, *to_r_ = nullptr;  // of exact modes: [mode][q, q', force before, force after]
  Lane *S_ = nullptr, *S_inverse_ = nullptr, *factor_ = nullptr;
  // Wheels: penetration on a surface at height zero with the vehicle at rest; penetration; force, tangent; penetration
  // without contact forces; at the end of the last step, and how it has grown; 1/k of the factors; residuals.
  Lane *offset_ = nullptr, *delta_ = nullptr, *F_ = nullptr, *k_ = nullptr, *free_ = nullptr, *end_ = nullptr;
  Lane *slope_ = nullptr, *yield_ = nullptr, *residual_ = nullptr, *pivot_ = nullptr;
  Lane *F0_ = nullptr, *F1_ = nullptr, *track_slope_ = nullptr;  // forces at the two steps before
  long* D_begin_ = nullptr;
  Lane *D_ = nullptr, *reduced_ = nullptr;
  double *g_ = nullptr, *load_g_ = nullptr;
  int *piece_ = nullptr, *load_piece_ = nullptr;
  char *on_ = nullptr, *load_on_ = nullptr, *awake_ = nullptr, *touching_ = nullptr;
  Lane* row_of_[3] = {};  // responses of the last three instants
  Lane *peak_ = nullptr, *peak_time_ = nullptr;
};

}  // namespace
}  // namespace traverse::lanes
