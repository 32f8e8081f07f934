// The motion of a vehicle under the forces at its contacts. The coupling calls only these functions, for mechanisms
// with joints and for linear models.
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

/// The shifts of an implicit stage: a change x of p changes p' by rate*x and p'' by acceleration*x. Both are 0 in
/// statics.
struct StageShifts {
  double rate = 0.0;          // 1/s
  double acceleration = 0.0;  // 1/s2: rate*rate for Runge-Kutta types
  bool statics() const { return acceleration == 0.0; }
  /// Whether both stages are equal within the accuracy that a Newton matrix needs.
  bool like(const StageShifts& other) const {
    const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * b; };
    return same(rate, other.rate) && same(acceleration, other.acceleration);
  }
};

/// A direction of a contact in the contacts' Newton iteration: its normal, or in the next row its tangent.
struct ContactRow {
  Contact* contact = nullptr;
  double scale = 0.0;  // N: scale of its vehicle
  int vehicle = 0;
  bool normal = true;
  int slot = -1;  // slot of its element; -1: none
};
using ContactRows = std::span<const ContactRow>;

/// A law's tangent with a line for each contact row: the derivative of its force by the displacement along the previous
/// contact row (for a tangential row), and by the displacement along the row itself, N/m.
using RowTangent = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// A list of numbers that detects differences from the previous list.
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
  /// Whether the list is the same as before.
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

/// The response of a vehicle at its contact rows, r of them: a unit force on row j moves row i by -H(i, j); without a
/// change of contact forces row i moves by c(i).
struct ContactCompliance {
  Eigen::MatrixXd H;      // r x r
  Eigen::MatrixXd P;      // r x r: 1 - H D, of size 0 where D is 0
  RowTangent D;           // the tangent that H includes; its size is 0 without a tangent, as in a time step
  Eigen::VectorXd c;      // r
  double residual = 0.0;  // largest entry of the equations of motion's residual over the vehicle's scale
  NumberList list;        // numbers of the contacts with rows
  bool known = false;     // H is valid for these rows
  void keep(base::Bytes& bytes) { bytes(H, P, D, c, residual, list, known); }
};

/// The equations of motion of one vehicle. The forces at its contacts are in MovingVehicle::Q as generalized forces.
class VehicleDynamics {
 public:
  virtual ~VehicleDynamics() = default;
  virtual std::unique_ptr<VehicleDynamics> clone() const = 0;
  /// This object if it has constant matrices, otherwise null.
  virtual const LinearDynamics* linear() const { return nullptr; }

  /// Positions, velocities and all forces except Q, from the independent coordinates and their rates (freedom values
  /// each). False if the vehicle cannot be assembled.
  virtual bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) = 0;
  /// Adds a small change to p, and `rate` times it to p'.
  virtual void shift(MovingVehicle& vehicle, const double* change, double rate) = 0;
  /// p'' under Q. Throws SolverError if it is undetermined because of friction.
  virtual void accelerations(MovingVehicle& vehicle, double* pdd) = 0;
  /// Computes the quantities for the powers from p'' of a stage, under Q.
  virtual void recover(MovingVehicle& vehicle, const double* pdd) = 0;
  /// The powers of the vehicle. Call after accelerations or recover.
  virtual base::Powers powers(const MovingVehicle& vehicle) const = 0;
  /// The energies in the state that was observed last, J.
  virtual multibody::MechanismEnergy energy(const MovingVehicle& vehicle) const = 0;
  /// Computes the observed state of all bodies, springs and joints at the state last set, with a given p'', under Q.
  virtual bool observe(MovingVehicle& vehicle, const double* pdd) = 0;

  // One iteration of a stage's Newton method, with J the derivative of the residual by p:

  /// Computes the residual of the equations of motion under Q with a given p'', in compliance.residual. False if
  /// friction jams.
  virtual bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) = 0;
  /// Whether the stored J and the matrices derived from it are valid for such a stage. `curved`: J with the
  /// constraints' curvature.
  virtual bool matrix_is_valid(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const = 0;
  /// Computes J and these matrices at the present state, and compliance.H with the contacts' tangent compliance.D in J.
  virtual void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
                     ContactCompliance& compliance) = 0;
  /// Computes compliance.c from the last residual.
  virtual void compute_free_displacement(ContactCompliance& compliance) = 0;
  /// Sets the residual to zero: the last iteration has moved the vehicle to its solution.
  void clear_residual() { R_.setZero(); }
  /// The change of p (freedom values) from the residual and from changes of the rows' forces.
  virtual const Eigen::VectorXd& coordinate_change(const Eigen::VectorXd& forces) = 0;

  /// Writes or reads the time-dependent state.
  virtual void keep(base::Bytes& bytes) = 0;

 protected:
  Eigen::VectorXd R_;  // f: the residual
};

/// A kind of dynamics with value semantics: each copy of a vehicle has its own object.
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
