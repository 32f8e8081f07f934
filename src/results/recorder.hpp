// The results file of a run: HDF5, written in blocks, so that memory does not grow with time and written data remain
// readable if the run is killed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/passage_peaks.hpp"
#include "modes/modes.hpp"
#include "results/place.hpp"

namespace traverse::results {

/// The datasets of the file, defined before the first sample, except for the time of the samples.
struct Layout {
  double interval = 0.0;  // s between samples; 0: a single instant
  std::size_t rows = 0;   // expected number of samples; 0: unknown
  /// A dataset that gets a row at each sample.
  struct Field {
    std::string name;              // its path in the file
    std::vector<std::size_t> row;  // shape of a row; empty: one number
    std::string unit;              // a list of units if the numbers of a row differ
    std::size_t width() const;     // numbers in a row
  };
  std::vector<Field> fields;
  /// Data that do not change with time: stations of the fields.
  struct Constant {
    std::string name;
    std::vector<double> values;
    std::string unit;
  };
  std::vector<Constant> constants;

  /// Numbers in a sample without its time.
  std::size_t width() const;
};

/// One stored instant.
struct Sample {
  double time = 0.0;
  std::vector<double> values;  // the rows of all fields in the order of the layout
};

/// The bridge's deflection at one instant, at its nodes and at points between them.
struct Shape {
  double time = 0.0;
  std::vector<double> x, deflection;  // m
};

/// A loss of contact until the following impact.
struct Separation {
  std::string vehicle, contact;  // its number in the train, the wheel or contact
  double x = 0.0;                // position of its body at the separation, m
  double start = 0.0;            // s
  double duration = 0.0;         // s
  double approach_speed = 0.0;   // m/s; 0: no impact until the end
  double impact_force = 0.0;     // N, greatest force of the following compression
};

/// Extremes over the run, for the terminal and as attributes of /summary.
struct Extreme {
  double value = 0.0;  // value of the largest magnitude, with its sign
  double time = 0.0;
  double place = 0.0;  // station, m
};
/// The peak of a filtered quantity.
struct LowPassed {
  Extreme extreme;
  double frequency = 0.0, interval = 0.0;  // frequency of the filter, Hz; interval of its input instants, s
  std::string filter;                      // its name
};
/// The largest unloading of a wheel, relative to its initial force.
struct Unloading {
  double value = 0.0, time = 0.0;  // s
  std::string wheel{};             // "vehicle 3, rear_wheel"
};
/// The largest unloading of a wheel by low-passed forces, with the longest time of unloading.
struct FilteredUnloading {
  Unloading extreme;
  double frequency = 0.0, interval = 0.0;  // frequency of the filter, Hz; interval of its input instants, s
  std::string filter;                      // its name
  double level = 0.0;                      // unloading from which a wheel is considered unloaded
  double longest = 0.0;                    // longest time without interruption, s
  double longest_from = 0.0;               // s
  std::string longest_wheel;
};
struct Summary {
  bool probes = false;  // false without probes: then there are no peaks
  bool moments = true;  // moments are known
  Extreme deflection, acceleration, moment;
  bool relative_to_supports = false;  // the deflection is relative to supports that are not where they were built
  std::optional<Extreme> shear, axial_displacement, axial_force;  // if known
  std::optional<LowPassed> low_passed;                            // peak of the filtered acceleration
  double static_deflection = 0.0;  // largest |static deflection| at the same station with the same loads; 0: unknown
  double amplification = 0.0;      // |deflection| over static; 0: unknown
  double least_wheel_force = 0.0, greatest_wheel_force = 0.0;
  double least_wheel_force_time = 0.0;
  std::string least_wheel;  // e.g. "vehicle 3, rear_wheel"
  std::optional<Unloading>
      unloading;  // for unfiltered forces at the ends of steps; empty if the initial state is not an equilibrium
  std::optional<FilteredUnloading> filtered_unloading;
  std::vector<base::DamperPeaks> dampers;
  int contact_losses = 0;
  double longest_loss = 0.0;            // s
  double energy_residual = 0.0;         // largest |residual|, J
  double structure_energy = 0.0;        // largest kinetic and strain energy, J
  double linearisation_residual = 0.0;  // largest residual of linear vehicles' mechanisms, over their weights
  double energy_left = 0.0;             // removed outside the active window, J
  /// The removed energy relative to the structure's motion: the square root of energy_left over structure_energy.
  double rest_error() const;
  double energy_scale =
      0.0;  // largest term, J, without initially stored energy and the forward motion of a driven train
  double largest_energy = 0.0;  // largest stored energy, or work of loads that do not cancel, J
  double static_error = 0.0;    // relative rounding error of static solutions
  long steps = 0;
  long rejected_steps = 0;    // repeated with a shorter step
  long solves = 0;            // beam solves
  long factorisations = 0;    // factorisations of the beam's matrices
  double end_time = 0.0;      // s, reached by the run
  double wall_seconds = 0.0;  // duration of the time loop
  std::string ended;          // "reached its end", or why it stopped
  /// Name and expected relative error of each peak with an error estimate.
  std::vector<std::pair<std::string, double>> expected_errors;
};

/// An attribute of a group or dataset.
struct Attribute {
  std::string name;
  std::variant<double, long, std::string> value;
};

/// The writer. Only rank 0 opens and writes the file; on other ranks every call does nothing. The file replaces an
/// older one at its place when it is published or finished, or has its first sample; until then it is beside its place.
class Recorder {
 public:
  /// Creates the file at its place; FileError on failure. attributes: name, text.
  Recorder(MPI_Comm comm, Place place, const Layout& layout,
           const std::vector<std::pair<std::string, std::string>>& attributes,
           const std::vector<std::pair<std::string, std::string>>& options);
  /// Like the constructor above, but claims the place of the file itself.
  Recorder(MPI_Comm comm, const std::string& file, const Layout& layout,
           const std::vector<std::pair<std::string, std::string>>& attributes,
           const std::vector<std::pair<std::string, std::string>>& options);
  /// The results of a run that is continued.
  struct Earlier {
    std::string file;                    // empty: none
    std::size_t rows = 0;                // rows of its series
    std::vector<std::string> objects;    // all objects of the file at that time
    std::vector<std::uint64_t> digests;  // digests of the rows of /time and of each field
    std::string scene{};                 // digest of the scene, as given to of_scene()
    std::string moved_with{};            // a file together with which the results may have been moved
  };
  /// Stores the digest of the scene, so that only a run of the same scene can continue the results.
  void of_scene(const std::string& digest);
  /// Continues the results of an earlier run in the state of its checkpoint, with the same layout: a copy replaces the
  /// file when it is complete. FileError if the results do not belong to the run, or have been changed.
  Recorder(MPI_Comm comm, Place place, const Layout& layout, const Earlier& earlier);
  Recorder(Recorder&& other) noexcept;
  ~Recorder();  // writes remaining data; never throws

  /// Moves the file to its place: it can be continued from here on.
  void publish();
  /// What follows until finish() is written to a copy beside the file, so that a kill leaves the published tables and
  /// the samples readable. No samples follow.
  void change_beside();
  /// Whether this rank writes a file: samples on other ranks need no values.
  bool writes() const { return impl_ != nullptr; }
  void add(const Sample& sample);
  /// Writes all buffered data; returns on rank 0 the data for a continuation from here.
  Earlier secure();
  /// Writes the end of the run under /end, if it is no multiple of the interval.
  void end(const Sample& sample);
  void modes(const modes::Modes& modes, double rayleigh_a, double rayleigh_b, double omega1, double omega2);
  void damped_modes(const modes::DampedModes& modes);
  /// The shape at the instant of the largest deflection: /shape/x, /shape/deflection, attribute time.
  void shape(const Shape& shape);
  /// /separations/contact ([m,2]: vehicle, name), x, start, duration, approach_speed, impact_force ([m]).
  void separations(const std::vector<Separation>& list);
  /// A dataset with its unit that is written at once.
  struct Dataset {
    std::string name;  // its path in the file
    std::vector<std::size_t> shape;
    std::vector<double> values;
    std::string unit;
  };
  void datasets(const std::vector<Dataset>& sets);
  /// Texts in two columns, each with its path in the file.
  void tables(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& tables);
  /// Coordinates of a dimension in words, such as the quantity of each limit; nothing if they are there already.
  void names(const std::string& dimension, const std::vector<std::string>& names);
  /// Overwrites existing datasets in the given order; after a kill each value is either the old or the new one.
  void rewrite(const std::vector<Dataset>& sets);
  /// Datasets of unknown numbers (NaN) for put_row(); their values are not used.
  void empty_rows(const std::vector<Dataset>& sets);
  /// Overwrites a row along the first dimension of each of these datasets, in the given order.
  void put_row(std::size_t row, const std::vector<std::pair<std::string, std::vector<double>>>& values);
  /// Adds an attribute to an existing group.
  void attributes(const std::string& group, const std::vector<Attribute>& list);
  /// Writes all buffered data and the summary as attributes, and closes the file. FileError if the disk fails.
  void finish(const Summary& summary);
  /// Like finish(), with the summary of a study. The attributes named in `at_root` are stored at / too.
  void finish_with(const std::vector<Attribute>& summary, const std::vector<std::string>& at_root = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::results
