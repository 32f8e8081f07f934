// The results file of a run: HDF5, written in blocks so that memory does not grow with time and what is written
// stays readable when the run dies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "modes/modes.hpp"
#include "results/place.hpp"

namespace traverse::results {

/// What the file will hold, fixed before the first sample. The time of a sample needs no mention.
struct Layout {
  double interval = 0.0;  // s between samples; 0: there is one instant only
  std::size_t rows = 0;   // samples that are expected; 0: not known
  /// A dataset that gains a row with each sample.
  struct Field {
    std::string name;              // its path in the file
    std::vector<std::size_t> row;  // shape of a row; empty: one number
    std::string unit;              // where the numbers of a row differ it names each
    std::size_t width() const;     // numbers in a row
  };
  std::vector<Field> fields;
  /// What does not change with time: stations that fields belong to.
  struct Constant {
    std::string name;
    std::vector<double> values;
    std::string unit;
  };
  std::vector<Constant> constants;

  /// Numbers in a sample besides its time.
  std::size_t width() const;
};

/// One stored instant.
struct Sample {
  double time = 0.0;
  std::vector<double> values;  // a row of each field after another, in the order of the layout
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
/// The peak of a filtered quantity.
struct LowPassed {
  Extreme extreme;
  double frequency = 0.0, interval = 0.0;  // Hz of the filter, s between the instants that it was given
  std::string filter;                      // its name
};
/// The largest part of its force at the start that a wheel has lost.
struct Unloading {
  double value = 0.0, time = 0.0;  // s
  std::string wheel{};             // "vehicle 3, rear_wheel"
};
/// The same of low-passed forces, and how long one was unloaded.
struct FilteredUnloading {
  Unloading extreme;
  double frequency = 0.0, interval = 0.0;  // Hz of the filter, s between the instants that it was given
  std::string filter;                      // its name
  double level = 0.0;                      // from which on a wheel counts as unloaded
  double longest = 0.0;                    // s without a break
  double longest_from = 0.0;               // s
  std::string longest_wheel;
};
struct Summary {
  bool probes = false;  // whether there are any: without them there are no peaks
  bool moments = true;  // are known
  Extreme deflection, acceleration, moment;
  std::optional<Extreme> shear, axial_displacement, axial_force;  // where they are known
  std::optional<LowPassed> low_passed;                            // acceleration
  double static_deflection = 0.0;  // largest |static deflection| at the same station with the same loads; 0: unknown
  double amplification = 0.0;      // |deflection| over static; 0: unknown
  double least_wheel_force = 0.0, greatest_wheel_force = 0.0;
  double least_wheel_force_time = 0.0;
  std::string least_wheel;             // e.g. "vehicle 3, rear_wheel"
  std::optional<Unloading> unloading;  // of forces as they are, at the ends of steps; not where none is at rest first
  std::optional<FilteredUnloading> filtered_unloading;
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
  /// The results of a run that goes on.
  struct Earlier {
    std::string file;                    // empty: none
    std::size_t rows = 0;                // of its series
    std::vector<std::string> objects;    // all that the file held by then
    std::vector<std::uint64_t> digests;  // of the rows of /time and of each field
    std::string scene{};                 // digest of the scene, as it was given to of_scene()
    std::string beside{};                // a file that the results may have been moved with
  };
  /// Notes the digest of the scene, by which its run alone takes the results up.
  void of_scene(const std::string& digest);
  /// Takes up the results of an earlier run as they were then, under the same layout: a copy takes its place when it
  /// is complete. FileError where they cannot be those, or have been changed since.
  Recorder(MPI_Comm comm, Place place, const Layout& layout, const Earlier& earlier);
  Recorder(Recorder&& other) noexcept;
  ~Recorder();  // flushes what is there; never throws

  /// Whether this rank writes a file: samples of the others need no values.
  bool writes() const { return impl_ != nullptr; }
  void add(const Sample& sample);
  /// Writes what is in memory; on rank 0 what is needed to take the results up from here.
  Earlier secure();
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
  /// Texts in two columns, each with its path in the file.
  void tables(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& tables);
  /// New values of datasets that are there, in the order given: a kill leaves each value as it was or as it is now.
  void rewrite(const std::vector<Dataset>& sets);
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
