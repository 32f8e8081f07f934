// What the program computes, in one table: the verb of the command line, the scenes that ask for it, and its function.
#pragma once

#include <mpi.h>

#include <optional>
#include <string_view>

#include "results/checkpoint_file.hpp"
#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// A scene that is to be computed.
struct Request {
  MPI_Comm comm;
  const scene::Scene& scene;
  results::Place place;                               // of its results file
  const std::optional<results::Checkpoint>& earlier;  // the run that it continues
};

struct Application {
  std::string_view verb;  // `traverse VERB SCENE.yml ...`
  const char* what;       // in words, with the options that ask for it
  bool (*is_asked)(const scene::Scene& scene);
  int (*run)(Request request);
  int (*describe)(MPI_Comm comm, const scene::Scene& scene);  // -describe
};

/// The application of a scene.
const Application& application_of(const scene::Scene& scene);
/// Whether a word is a verb: that of an application, or describe.
bool is_verb(std::string_view word);
/// InputError if the scene does not ask for the application of this verb.
void check_verb(std::string_view verb, const scene::Scene& scene);

}  // namespace traverse::app
