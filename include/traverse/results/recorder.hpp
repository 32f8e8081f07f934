// The results file of a run: HDF5, written in blocks so that memory does not grow with time and what is written
// stays readable when the run dies.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "traverse/beam/recovery.hpp"
#include "traverse/modes/modes.hpp"
#include "traverse/results/place.hpp"

namespace traverse::results {

/// What the file will hold, fixed before the first sample.
struct Layout {
  struct VehicleNames {
    std::vector<std::string> bodies, wheels, joints, springs, torsion_springs;
  };
  double interval = 0.0;         // s between samples; 0: there is one instant only
  std::vector<double> probes;    // stations, m; empty without a beam
  std::vector<double> supports;  // stations of the span ends, m
  std::vector<VehicleNames> vehicles;
  /// A dataset that belongs to some scenes only: forces of the foundation, the response of a rail.
  struct Field {
    std::string name;       // its path in the file
    std::size_t width = 0;  // numbers in a sample
    std::string unit;
  };
  std::vector<Field> fields;
  /// What does not change with time: stations that fields belong to.
  struct Constant {
    std::string name;
    std::vector<double> values;
    std::string unit;
  };
  std::vector<Constant> constants;
};

/// One stored instant.
struct Sample {
  double time = 0.0;
  std::vector<beam::Response> probes;
  std::vector<std::array<double, 3>> supports;  // fx, fy, moment on the beam
  struct Body {
    std::array<double, 3> position, velocity, acceleration;
  };
  struct Wheel {
    double normal_force = 0.0, friction_force = 0.0, penetration = 0.0;
  };
  struct Vehicle {
    std::vector<Body> bodies;
    std::vector<Wheel> wheels;
    std::vector<std::array<double, 3>> joints;  // reaction on the second body
    std::vector<double> springs;                // tension, N
    std::vector<double> torsion_springs;        // moment on the second body, N m
  };
  std::vector<Vehicle> vehicles;
  std::vector<std::vector<double>> fields;  // as in the layout
  struct Energy {
    double kinetic = 0.0, strain = 0.0, potential = 0.0, dissipated = 0.0, work = 0.0, residual = 0.0;
  } energy;
};

/// The bridge's deflection at one instant, at its nodes and at points between them.
struct Shape {
  double time = 0.0;
  std::vector<double> x, deflection;  // m
};

/// From the loss of a contact to the impact that ends it.
struct Separation {
  std::string vehicle, contact;  // its number in the train, the wheel or contact
  double x = 0.0;                // m, of its body where they part
  double start = 0.0;            // s
  double duration = 0.0;         // s
  double approach_speed = 0.0;   // m/s; 0: still apart at the end
  double impact_force = 0.0;     // N, the greatest of the compression that follows
};

/// Extremes over the run, for the terminal and as attributes of /summary.
struct Extreme {
  double value = 0.0;  // signed, of the largest magnitude
  double time = 0.0;
  double place = 0.0;  // station, m
};
struct Summary {
  Extreme deflection, acceleration, moment;
  double static_deflection = 0.0;  // largest |static deflection| at the same station with the same loads; 0: unknown
  double amplification = 0.0;      // |deflection| over static; 0: unknown
  double least_wheel_force = 0.0, greatest_wheel_force = 0.0;
  double least_wheel_force_time = 0.0;
  std::string least_wheel;  // e.g. "vehicle 3, rear_wheel"
  int contact_losses = 0;
  double longest_loss = 0.0;      // s
  double energy_residual = 0.0;   // largest |residual|, J
  double structure_energy = 0.0;  // largest, kinetic and strain, J
  double linear_defect = 0.0;     // largest residual of linear vehicles' mechanisms, over their weights
  double energy_left = 0.0;       // put to rest outside the window of what is stepped, J
  /// The same relative to the structure's motion: the root of energy_left over structure_energy.
  double rest_error() const;
  double energy_scale = 0.0;    // largest term, J, less what was stored and a driven train's going forward at the start
  double largest_energy = 0.0;  // largest term that is stored, J
  double static_error = 0.0;    // relative, of static solutions, by rounding
  long steps = 0;
  long rejected_steps = 0;    // tried and taken again, shorter
  long solves = 0;            // beam solves
  long factorisations = 0;    // of the beam's matrices
  double end_time = 0.0;      // s, how far the run has come
  double wall_seconds = 0.0;  // of the time loop
  std::string ended;          // "reached its end", or why it stopped
  /// Name and expected relative error of each peak whose accuracy is promised.
  std::vector<std::pair<std::string, double>> expected_errors;
};

/// An attribute of a group or dataset.
struct Attribute {
  std::string name;
  std::variant<double, long, std::string> value;
};

/// The writer. Only rank 0 opens and writes the file; on the other ranks every call does nothing.
class Recorder {
 public:
  /// Creates the file at its place: FileError when it cannot be. attributes: name, text.
  Recorder(MPI_Comm comm, Place place, const Layout& layout,
           const std::vector<std::pair<std::string, std::string>>& attributes,
           const std::vector<std::pair<std::string, std::string>>& options);
  /// The same, but the place is claimed only now.
  Recorder(MPI_Comm comm, const std::string& file, const Layout& layout,
           const std::vector<std::pair<std::string, std::string>>& attributes,
           const std::vector<std::pair<std::string, std::string>>& options);
  ~Recorder();  // flushes what is there; never throws

  void add(const Sample& sample);
  /// The end of the run where it is no multiple of the interval: what `add` would append, apart under /end.
  void end(const Sample& sample);
  void modes(const modes::Modes& modes, double rayleigh_a, double rayleigh_b, double omega1, double omega2);
  void damped_modes(const modes::DampedModes& modes);
  /// The shape at the instant of the largest deflection: /shape/x, /shape/deflection, attribute time.
  void shape(const Shape& shape);
  /// /separations/contact ([m,2]: vehicle, name), x, start, duration, approach_speed, impact_force ([m]).
  void separations(const std::vector<Separation>& list);
  /// A dataset that is written at once, with its unit.
  struct Dataset {
    std::string name;  // its path in the file
    std::vector<std::size_t> shape;
    std::vector<double> values;
    std::string unit;
  };
  void datasets(const std::vector<Dataset>& sets);
  /// Adds an attribute to a group that is there.
  void attributes(const std::string& group, const std::vector<Attribute>& list);
  /// Writes everything still in memory, the summary as attributes, and closes the file. FileError when the disk fails.
  void finish(const Summary& summary);
  /// The same with a summary that is not one of a single run; those named in `at_root` become attributes of / too.
  void finish_with(const std::vector<Attribute>& summary, const std::vector<std::string>& at_root = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::results
