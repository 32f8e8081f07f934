// How a vehicle moves under the forces at its contacts: the seam between a train and what it runs on. The coupling asks
// for these functions alone; whether a mechanism with joints or a linear model answers is the kind's affair.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "multibody/mechanism.hpp"

namespace traverse::train {

class LinearDynamics;
struct Contact;
struct MovingVehicle;

/// An implicit stage: with a change x of p, p' changes by rate*x and p'' by acceleration*x. Both 0: statics.
struct StageShifts {
  double rate = 0.0;          // 1/s
  double acceleration = 0.0;  // 1/s2: rate*rate for Runge-Kutta types
  bool statics() const { return acceleration == 0.0; }
  /// The same within what a Newton matrix notices.
  bool like(const StageShifts& other) const {
    const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * b; };
    return same(rate, other.rate) && same(acceleration, other.acceleration);
  }
};

/// A direction of a contact in the contacts' Newton iteration: its normal, or behind that its tangent.
struct ContactRow {
  Contact* contact = nullptr;
  double scale = 0.0;  // N: its vehicle's
  int vehicle = 0;
  bool normal = true;
  int slot = -1;  // of the element that carries it, -1: none
};
using ContactRows = std::span<const ContactRow>;

/// A law's tangent, one line a row: the derivative of its force by the displacement along the row before (of a
/// tangential row), and by that along its own, N/m.
using RowTangent = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Numbers listed anew, to be compared with those listed before.
class NumberList {
 public:
  void begin() {
    count_ = 0;
    same_ = true;
  }
  void add(int number) {
    if (count_ == numbers_.size()) numbers_.push_back(number - 1);
    same_ = same_ && numbers_[count_] == number;
    numbers_[count_++] = number;
  }
  /// Whether they are the same as before.
  bool end() {
    same_ = same_ && count_ == numbers_.size();
    numbers_.resize(count_);
    return same_;
  }
  void keep(base::Bytes& bytes) { bytes(numbers_); }

 private:
  std::vector<int> numbers_;
  std::size_t count_ = 0;
  bool same_ = true;
};

/// What a vehicle makes of its contact rows, r of them: a unit force on row j moves row i by -H(i, j), by itself the
/// vehicle moves row i by c(i).
struct ContactCompliance {
  Eigen::MatrixXd H;      // r x r
  Eigen::MatrixXd P;      // r x r: 1 - H D, of size 0 where D is 0
  RowTangent D;           // the tangent that H includes; of size 0 where it includes none, as in a step
  Eigen::VectorXd c;      // r
  double residual = 0.0;  // largest entry of the equations of motion's residual over the vehicle's scale
  NumberList list;        // of the contacts with rows
  bool known = false;     // H, for these rows
  void keep(base::Bytes& bytes) { bytes(H, P, D, c, residual, list, known); }
};

/// One vehicle's equations of motion. All forces at its contacts are in MovingVehicle::Q as generalized forces.
class VehicleDynamics {
 public:
  virtual ~VehicleDynamics() = default;
  virtual std::unique_ptr<VehicleDynamics> clone() const = 0;
  /// Itself where it has constant matrices, else null.
  virtual const LinearDynamics* linear() const { return nullptr; }

  /// Positions, velocities and forces but for Q, from the independent coordinates and their rates (freedom values
  /// each). False where the vehicle cannot be assembled there.
  virtual bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) = 0;
  /// Moves on by a small change of p, and `rate` times it of p'.
  virtual void shift(MovingVehicle& vehicle, const double* change, double rate) = 0;
  /// p'' under Q. Throws SolverError where friction leaves it undetermined.
  virtual void accelerations(MovingVehicle& vehicle, double* pdd) = 0;
  /// What powers need, from p'' as a stage has found it, under Q.
  virtual void recover(MovingVehicle& vehicle, const double* pdd) = 0;
  /// After accelerations or recover.
  virtual multibody::MechanismPowers powers(const MovingVehicle& vehicle) const = 0;
  /// Of the state last observed, J.
  virtual multibody::MechanismEnergy energy(const MovingVehicle& vehicle) const = 0;
  /// The state of all bodies, springs and joints as observers see it, at what it was last set to with a given p'',
  /// under Q.
  virtual bool observe(MovingVehicle& vehicle, const double* pdd) = 0;
  /// How far the mechanism itself has been from equilibrium in the states observed: the largest of its equations of
  /// motion's residuals over the vehicle's scale.
  virtual double defect() const { return 0.0; }

  /// Whether the independent coordinates may have worn out.
  virtual bool worn(const MovingVehicle& vehicle) const = 0;
  /// Notes the state, just evaluated, as accepted. True where others take the place of worn coordinates.
  virtual bool accept(MovingVehicle& vehicle) = 0;

  // An iteration of a stage's Newton method, with J the derivative of the residual by p:

  /// The residual of the equations of motion under Q with a given p'', to yield.residual. False where friction jams.
  virtual bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) = 0;
  /// Whether J and what follows from it, as they are kept, belong to such a stage. `curved`: with the constraints'
  /// curvature.
  virtual bool serves(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const = 0;
  /// Computes them anew at the state it is in, and yield.H with the contacts' tangent yield.D in J.
  virtual void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
                     ContactCompliance& compliance) = 0;
  /// yield.c from the last residual.
  virtual void go_by_itself(ContactCompliance& compliance) = 0;
  /// No residual: the vehicle stays where the last iteration has put it.
  virtual void rest() = 0;
  /// The change of p (freedom values) by itself and under changes of the rows' forces.
  virtual const Eigen::VectorXd& take(const Eigen::VectorXd& forces) = 0;

  /// What changes with time.
  virtual void keep(base::Bytes& bytes) = 0;
};

/// A kind of dynamics as a value: a copy of a vehicle has its own.
class AnyDynamics {
 public:
  AnyDynamics(std::unique_ptr<VehicleDynamics> kind) : kind_(std::move(kind)) {}  // NOLINT: a kind is one of any
  AnyDynamics(const AnyDynamics& other) : kind_(other.kind_->clone()) {}
  AnyDynamics(AnyDynamics&&) = default;
  AnyDynamics& operator=(AnyDynamics other) {
    kind_ = std::move(other.kind_);
    return *this;
  }
  ~AnyDynamics() = default;
  VehicleDynamics* operator->() { return kind_.get(); }
  const VehicleDynamics* operator->() const { return kind_.get(); }

 private:
  std::unique_ptr<VehicleDynamics> kind_;
};

}  // namespace traverse::train
