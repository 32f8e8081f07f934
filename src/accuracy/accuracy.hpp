// `accuracy`: mesh and step that keep the errors of peaks below what the user wants, where the user left them open.
//
// Chosen by measuring: the beginning of the scene, until its first vehicle has crossed the first spans, is run with a
// few meshes and steps, each halved until what that changes tells the errors of deflection, acceleration, moment and
// wheel force and how fast they fall. A quantity that does not settle is named and not promised.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "run/peaks.hpp"
#include "traverse/options/entry.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What is said of one quantity's peak.
struct Promise {
  bool present = false;   // in this scene
  bool kept = false;      // promised: the expected error is not above the wanted one
  double expected = 0.0;  // relative to the peak
  std::string why_not;    // where it is not promised

  void keep(base::Bytes& bytes) { bytes(present, kept, expected, why_not); }
};

/// A row of -accuracy_report, printed or not. wanted, error: relative. Whether the promise is not broken.
bool report_row(const std::string& name, const Promise& promise, double wanted, double error, bool prints);
/// Its head. against: what the run is compared with; of: what the rows are.
void report_head(const std::string& against, const std::string& of);

/// Whether the scene's accuracy_of holds it, or is left out: then not the shear, and what is axial only where trains
/// push the beam along. Low-passed accelerations only where its runs have them.
bool asks_for(const Scene& scene, std::size_t quantity);
/// Whether it is promised where its error turns out to be small enough, but does not ask for mesh and step.
bool is_welcome(const Scene& scene, std::size_t quantity);
/// Whether wheel forces are asked for without the accelerations that show what too long steps do to both.
bool asks_for_forces_alone(const Scene& scene);

/// The note that a quantity's peak is not promised, and why.
std::string not_promised(Quantity quantity, const Promise& promise);
/// Why quantities are not promised.
/// Of one that is not asked for.
std::string why_not_asked(const Scene& scene, std::size_t quantity);
inline constexpr const char* no_sum =
    "without damping that grows with the frequency the accelerations of all modes have no sum";
/// Whether the scene asks for damping that grows with the frequency.
bool damps_high_modes(const Scene& scene);
/// Whether every mode of the bridge is damped, however it is described.
bool damps_all_modes(const Scene& scene);

/// What is promised where there is no bridge: largest errors at any instant, over the largest way from the start or the
/// largest force.
enum AloneQuantity : std::size_t { position, joint_force, contact_force, alone_quantities };
inline constexpr std::array<const char*, alone_quantities> alone_names = {"position", "joint force", "contact force"};

struct Accuracy {
  bool measured = false;  // false: nothing was open, or there is nothing to measure
  std::array<Promise, quantities> promises;
  std::array<Promise, alone_quantities> alone;  // where there is no bridge
  Promise frequencies;                          // of natural modes
  bool lost_contact = false;                    // wheels did in trial runs
  static constexpr double the_end = std::numeric_limits<double>::infinity();
  double seen_until = the_end;  // s of the run, until which trial runs went
  /// After the run, in which wheels lost contact at these times, s: where no trial run has seen some of them, nothing
  /// is promised any more. Says so, or "".
  std::string withdrawn(const std::vector<double>& losses);
  /// After the run, in which something touched or let go that trial runs have not seen, in words: nothing is promised
  /// any more. Says so, or "".
  std::string withdrawn_by_surprise(const std::string& what);
  /// After the run, in which curves bend within steps so many times as much as trial runs have seen: errors are larger,
  /// by the square of that, and what is above `wanted` then is not promised any more. Says so, or "".
  std::string withdrawn_by_bends(double times, double wanted);
  /// After a run to its end: the same of low-passed accelerations, where their peak is within the unsettled end of the
  /// run.
  std::string withdrawn_at_end(bool unsettled);
  void promise_nothing();
  bool promises_something() const;  // of a bridge
  /// Name in the results file and expected error of each quantity that is promised.
  std::vector<std::pair<std::string, double>> expected() const;
  double seconds = 0.0;  // wall time that choosing took

  void keep(base::Bytes& bytes) { bytes(measured, promises, alone, frequencies, lost_contact, seen_until, seconds); }
};

/// Whether there is something to choose, and something moves that it can be chosen by.
bool chooses(const Scene& scene);
/// The mesh that trial runs begin with, where it is open.
void set_first_mesh(Scene& scene);

/// Collective. Where the deck's accelerations are filtered, and the scene leaves open where: computes the frequency
/// that counts, by the elements that trial runs begin with, and fills it in. One for all runs that are compared, as it
/// differs a little from mesh to mesh.
void settle_low_pass(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes);

/// The option that makes the integrator choose its steps by a measure of its own, or treat contacts apart; null: none.
const options::Entry* own_measure();

/// Collective. Fills in the scene's mesh, step and tolerances as far as they are open and says so in `notes`.
/// InputError as the scene's own run would throw it.
Accuracy choose(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes);

/// The scene with twice the elements in every span (or sleeper bay) and half the step; where modes were chosen for it,
/// by its elements and mechanisms.
Scene refined(const Scene& scene);

}  // namespace traverse::app
