// Searches mesh and step by runs of the whole scene. Each run is a companion of the next finer one: the change of the
// peaks between two runs tells the error of the finer one, whatever happens during the run. The finest run is the
// answer.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "error_control/peak_errors.hpp"
#include "error_control/search_constants.hpp"

namespace traverse::error_control {

struct Discretisation {
  int elements = 0;   // in the longest span, or in a sleeper bay; 0: no mesh; or the number of modes
  double step = 0.0;  // s; 0: exact in time

  friend bool operator==(const Discretisation&, const Discretisation&) = default;
  void keep(base::Bytes& bytes) { bytes(elements, step); }
};

/// The runs of a search.
class Companions {
 public:
  virtual ~Companions() = default;
  /// Collective. Computes a run, unless it is known. False if it failed because its step is too long.
  virtual bool run(const Discretisation& model) = 0;
  /// The relative change of each quantity's peaks from one run to a finer one.
  virtual PeakErrors change(const Discretisation& coarse, const Discretisation& fine) = 0;
  /// Factor of the errors of a quantity that converges less regularly than others.
  virtual double weight(std::size_t /*q*/) const { return 1.0; }
  /// The estimated cost of a run, s. It is computed from counts, because decisions must not depend on the clock.
  virtual double seconds(const Discretisation& model) = 0;
  /// The next mesh of at least this number of elements.
  virtual int mesh_of_at_least(int elements) const { return elements; }
};

/// The task of a search.
struct SearchTask {
  double accuracy = 1e-3;                      // wanted relative error
  std::array<bool, run::quantities> wanted{};  // quantities whose error is to be within the accuracy
  Discretisation coarse, fine;                 // the first two runs; what is the same in both has no estimate
  bool open_mesh = true, open_step = true;     // what may be refined further
  int most_elements = 0;
  double affordable = search::cheap_seconds;  // s, cost of a run that is always allowed
  const char* unit = "elements a span";
};

class CompanionSearch {
 public:
  /// `runs` must outlive this object.
  CompanionSearch(Companions& runs, const SearchTask& task)
      : runs_(runs), task_(task), coarse_(task.coarse), fine_(task.fine) {}

  /// Collective. Refines until the errors of the quantities are within the accuracy; a quantity that does not come
  /// there is rejected. leaves_last: a run that is expected to be the last one is not computed, see `add`.
  void run(bool leaves_last = false);
  /// Whether the last run is still to be computed, with `model`.
  bool open() const { return open_; }
  /// After the last run was computed elsewhere, so that `runs` knows it: determines its errors. If they are not within
  /// the accuracy, the search is open again, with a finer model.
  void add_last(const Discretisation& last);
  /// Present run and companion.
  std::array<Discretisation, 2> latest() const { return {fine_, coarse_}; }
  /// The state of an open search.
  void keep(base::Bytes& bytes) {
    bytes(task_.wanted, task_.open_mesh, task_.open_step, coarse_, fine_, time_, space_, rungs_, answer_, open_,
          stalls_, why_not_);
  }
  /// The model of the answer.
  const Discretisation& model() const { return answer_.model; }
  /// The relative errors of the answer.
  const PeakErrors& errors() const { return answer_.errors; }
  /// The reason why a quantity was rejected; empty: it was not.
  const std::string& why_not(std::size_t q) const { return why_not_[q]; }

 private:
  /// The change of the peaks by shorter steps, or by shorter elements.
  struct Change {
    PeakErrors by{};
    double ratio = 1.0;  // of the lengths; 1: not measured

    double error(std::size_t q) const;
    void keep(base::Bytes& bytes) { bytes(by, ratio); }
  };
  struct Rung {
    Discretisation model;
    PeakErrors errors{};

    void keep(base::Bytes& bytes) { bytes(model, errors); }
  };
  bool start();
  void attribute();
  Discretisation finer() const;
  bool expected_last(const Discretisation& next) const;
  enum class Leave { none, last, any };  // runs that are left to the caller: none, the one expected to be the last, any
  void refine(Leave leave);
  bool add(Discretisation next);
  void record(const PeakErrors& least = {});
  double largest(const Change& change) const;
  bool sought(std::size_t q) const { return task_.wanted[q] && why_not_[q].empty(); }
  bool within_accuracy(const Rung& rung) const;
  std::string text_of_model() const;
  void reject_given();
  void reject_missed(const std::string& why);
  void reject_stalled(double refinement);
  void answer();

  Companions& runs_;
  SearchTask task_;
  Discretisation coarse_, fine_;  // the present run, and its companion
  Change time_, space_;           // from the companion to the present run
  std::vector<Rung> rungs_;       // runs with a companion, from the coarsest on
  Rung answer_;
  bool open_ = false;
  std::array<int, run::quantities> stalls_{};  // successive refinements with little change of the error
  std::array<std::string, run::quantities> why_not_{};
};

}  // namespace traverse::error_control
