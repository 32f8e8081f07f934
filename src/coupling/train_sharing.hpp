// Ranks that share the trains on separate spans. Each rank has a System of its own for the whole scene and moves some
// of its trains, with the spans near them. Trains that reach the same spans within an epoch are moved by one rank, so
// that no stage of a step needs a message.
//
//   leader (rank 0)                                   others: System::serve
//     step: request, own trains                         own trains
//           receives the trains of the others           send their trains
//     accept: request, own spans, events                own spans
//     observe: receives what is observed                send it, and take the next step, which is taken back
//     evaluation                                          if the leader asks for something else
//     end of an epoch, restart, archive: recall         send their spans, and have none
//       then trains and spans are divided again
//
// After each step the leader knows all vehicles and contacts, as if it had moved them. Everything that looks at the
// motion, and every decision about steps, is on the leader alone.
#pragma once

#include <mpi.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "structure/ranges.hpp"

namespace traverse::coupling {

/// What a train occupies within an epoch: whole parts of the bridge.
struct TrainReach {
  std::size_t train = 0;
  structure::Range columns;
  double vehicles = 0.0;  // number
};

/// What a rank moves: trains, ascending, and columns, as structure::merge() returns them.
struct Portion {
  std::vector<std::size_t> trains;
  std::vector<structure::Range> columns;
};

/// Divides trains and moving columns among ranks with about equal work, of which the first rank has the evaluation of
/// all trains too. Trains with common columns have one rank; all columns of a train are those of its rank. `moving` as
/// structure::merge() returns it.
std::vector<Portion> divide(const std::vector<TrainReach>& trains, const std::vector<structure::Range>& moving,
                            int ranks);

/// A rank's share since the trains were divided: integrals and energy, J, and its number of solutions. Kinetic and
/// strain energy are those at the last instant at which energies were wanted.
struct SharedSums {
  double kinetic = 0.0, strain = 0.0, dissipated = 0.0, work = 0.0, energy_left = 0.0, solves = 0.0;

  std::array<double*, 6> numbers() { return {&kinetic, &strain, &dissipated, &work, &energy_left, &solves}; }
  SharedSums& operator+=(SharedSums more) {
    const std::array<double*, 6> to = numbers(), from = more.numbers();
    for (std::size_t i = 0; i < to.size(); ++i) *to[i] += *from[i];
    return *this;
  }
};

class TrainSharing {
 public:
  enum Request : int { divided, step, accept, probes, motion, energies, recall, reject, end };
  struct Command {
    double number = end, t = 0.0, h = 0.0;  // of the request; s
    Request what() const { return static_cast<Request>(number); }
    bool operator==(const Command&) const = default;
  };

  /// Collective. The ranks of comm share the trains; the first one leads.
  explicit TrainSharing(MPI_Comm comm);
  ~TrainSharing();
  TrainSharing(const TrainSharing&) = delete;
  TrainSharing& operator=(const TrainSharing&) = delete;

  MPI_Comm comm() const { return comm_; }
  bool leads() const { return rank_ == 0; }
  int ranks() const { return ranks_; }

  /// On the leader: a request to all others. They receive it by next().
  void request(Request what, double t = 0.0, double h = 0.0);
  Command next();

  /// The numbers of a message, which put() appends and get() reads in the same order.
  void clear() { message_.clear(); }
  void put(const double* numbers, std::size_t count) { message_.insert(message_.end(), numbers, numbers + count); }
  void put(double number) { message_.push_back(number); }
  void put(const std::vector<structure::Range>& ranges);
  void get(double* numbers, std::size_t count);
  double get();
  void get(std::vector<structure::Range>& ranges);
  void send(int rank);
  void receive(int rank);

  // On the leader:
  std::vector<Portion> portions;                        // of all ranks in this epoch
  std::vector<std::vector<structure::Range>> observed;  // columns of other ranks whose motion the leader has
  std::vector<SharedSums> sums;                         // of other ranks
  bool divided_now = false;                             // others move trains
  double epoch_end = 0.0;                               // s
  // On the others:
  std::optional<Command> ahead;       // the step that has been taken before the leader asked for it
  bool solved = false;                // the last step
  std::vector<double> trains_before;  // the own trains at its start

 private:
  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  bool ended_ = false;
  std::vector<double> message_;
  std::size_t read_ = 0;
};

}  // namespace traverse::coupling
