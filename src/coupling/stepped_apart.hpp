// A system whose steps somebody else takes as a whole, who knows more of it than System does: linear vehicles over
// modes, or over spans that do not touch. The system is told where it is when somebody looks, and when it has to go on
// by itself.
#pragma once

#include <optional>
#include <span>

#include "base/archive.hpp"
#include "recovery/recovery.hpp"
#include "structure/structure.hpp"

namespace traverse::coupling {

class SteppedApart {
 public:
  virtual ~SteppedApart() = default;
  /// The step from t to t + h; false where it cannot be taken, and all is as it was. SolverError where the motion is no
  /// number any more.
  virtual bool step(double t, double h) = 0;

  /// Writes v, w, p and p' of the whole system at the end of the last step, one behind the other: into what was told
  /// before, or, at first, into the start.
  virtual void tell(double* y) const = 0;
  /// The same of w and w', of the structure alone, under these loads of the contacts: into what was told before or, at
  /// first, into what System::rate gives of the start. False where that is not known.
  virtual bool tell_rate(const structure::ElementLoads& /*contacts*/, double* /*ydot*/) const { return false; }
  /// The structure's energies where it is told, J; null where these are not known.
  virtual std::optional<structure::StructureEnergy> energy() const { return std::nullopt; }
  /// Lost in dampers, and given by what holds the speed, since the start, J.
  virtual double dissipated() const = 0;
  virtual double worked() const = 0;
  /// m, N: of an entry of Fleet::wheels.
  struct Wheel {
    double x = 0.0, force = 0.0;
  };
  virtual Wheel wheel(std::size_t wheel) const = 0;
  /// Deflections, accelerations and moments of the probes, where moments lag their rates too; the rest is left as it
  /// is.
  virtual void see(std::span<beam::Response> probes) const = 0;
  /// s: by how much moments follow behind what makes them, as ViscousLag has it.
  virtual double moment_lag() const = 0;
  /// System::defect at the instant when the vehicles were farthest from linear.
  virtual double defect() = 0;

  /// The state between two steps.
  virtual void keep(base::Archive& archive) = 0;
};

}  // namespace traverse::coupling
