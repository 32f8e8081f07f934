/* Traverse step by step, in plain C: for digital twins and co-simulation. Link with libtraverse.so.
 *
 *   const char* words[] = {"-options_file", "options/scenes/three_span_half_car.yml", "-output_interval", "0.01"};
 *   traverse_passage* passage = NULL;
 *   if (traverse_open(4, words, &passage) != 0) return puts(traverse_error()), 1;
 *   while (traverse_time(passage) < 1.0) {
 *     traverse_advance(passage, traverse_time(passage) + 0.01);
 *     traverse_read(passage, "/vehicles/0/car/position", position, 3);
 *     traverse_set_body_force(passage, 0, "car", 0.0, -1.0e3 * position[1], 0.0);
 *   }
 *   traverse_close(passage);
 *
 * A passage advances from sample to sample: steps end exactly at the multiples of -output_interval, at which values are
 * read and forces change. Only the given words are used: neither .petscrc nor PETSC_OPTIONS is read. Vehicles are
 * mechanisms (-model_vehicles full), unless the words select another model. Without set forces, the values are bit for
 * bit those that the program stores for the same words with -model_vehicles full.
 *
 * Several passages may be open at once. All calls must be in one thread; each process has separate passages, also under
 * mpirun. Units are SI; x is along the track, y upward, angles are counter-clockwise. Functions that return int return
 * 0, or the exit status of the program for the same error: 2 for invalid input, 3 if the equations cannot be solved, 4
 * for a file, 5 for memory, 70 for an internal error; traverse_error then returns the reason in one line. */
#ifndef TRAVERSE_TRAVERSE_H
#define TRAVERSE_TRAVERSE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TRAVERSE_API __attribute__((visibility("default")))

/* NOLINTBEGIN(modernize-use-using): C has no using */
typedef struct traverse_passage traverse_passage;

/* A dataset of the results file (doc/results_file.md) without its dimension of time, which traverse_read can read. */
typedef struct {
  const char* name; /* its path, "/probes/deflection"; valid while the passage is open */
  const char* unit; /* different units of the numbers of a row are all listed: "N, N, N m" */
  size_t dimensions;
  size_t shape[2];   /* one entry per dimension; their product is the number of values */
  int varies;        /* 1: with time; 0: stations of other quantities */
  const char* names; /* the names of the dimensions, separated by blanks: "x", "supports_x component" */
} traverse_quantity;
/* NOLINTEND(modernize-use-using) */

/* Opens the scene of these words of the command line (without the program's name) at t = 0. *passage is NULL on
 * failure. */
TRAVERSE_API int traverse_open(int argc, const char* const* argv, traverse_passage** passage);
/* Frees the scene. NULL and a closed passage are allowed. The handle of a closed passage (16 bytes) exists until the
 * process ends; every other call rejects it, and NULL, with status 2. */
TRAVERSE_API void traverse_close(traverse_passage* passage);
/* The version of the library: "1.0.0". */
TRAVERSE_API const char* traverse_version(void);
/* One line on the last call that failed; empty before the first failure. Valid until the next failure. */
TRAVERSE_API const char* traverse_error(void);

/* The time of the present sample, the end of the scene, and the interval of samples, s; NaN for a passage that is not
 * open. */
TRAVERSE_API double traverse_time(const traverse_passage* passage);
TRAVERSE_API double traverse_end(const traverse_passage* passage);
TRAVERSE_API double traverse_interval(const traverse_passage* passage);

/* Advances to the first sample that is not before t (s), or to the end if it is earlier; does nothing if that sample
 * was reached before. Status 2 for a time after the end. After status 3 the passage cannot be advanced. */
TRAVERSE_API int traverse_advance(traverse_passage* passage, double t);

/* The number of quantities, and the description of quantity i. Status 2 if i is too large. */
TRAVERSE_API size_t traverse_quantities(const traverse_passage* passage);
TRAVERSE_API int traverse_describe(const traverse_passage* passage, size_t i, traverse_quantity* quantity);
/* The values of a quantity at the present sample, row by row; count: number of all values. Status 2 for another count.
 */
TRAVERSE_API int traverse_read(const traverse_passage* passage, const char* name, double* values, size_t count);

/* Applies, from the present sample on, a constant force at the centre of mass of a body (N) and a moment (N m), or a
 * vertical force (N, upward) at a station x (m) of the beam (with a layered track: of its rail), in addition to all
 * loads of the scene. Each call replaces the previous one for this body or station: 0 removes the force. Status 2 for
 * an unknown body or station, and for a model that accepts no such forces. */
TRAVERSE_API int traverse_set_body_force(traverse_passage* passage, int vehicle, const char* body, double fx, double fy,
                                         double moment);
TRAVERSE_API int traverse_set_beam_force(traverse_passage* passage, double x, double force);

/* Problems and their results, without a file or a process (include/traverse/simulate.hpp has the same in C++). */

/* NOLINTBEGIN(modernize-use-using) */
typedef struct traverse_problem traverse_problem;
typedef struct traverse_results traverse_results;
/* NOLINTEND(modernize-use-using) */

/* A problem of the options of a text in YAML or JSON, or of a scene file; text: NULL for no options. *problem is NULL
 * on failure. Most errors in options are found by traverse_simulate and traverse_open_problem. */
TRAVERSE_API int traverse_problem_new(const char* text, traverse_problem** problem);
TRAVERSE_API int traverse_problem_read(const char* file, traverse_problem** problem);
/* Sets an option (its name without a dash, its value as text), or replaces its value; NULL removes the option. */
TRAVERSE_API int traverse_problem_set(traverse_problem* problem, const char* name, const char* value);
/* A table, row by row, in place of a file: an option that names the file `name`, such as "wave.csv", reads it. */
TRAVERSE_API int traverse_problem_table(traverse_problem* problem, const char* name, size_t rows, size_t columns,
                                        const double* values);
TRAVERSE_API void traverse_problem_free(traverse_problem* problem);
/* Like traverse_open, for a problem. */
TRAVERSE_API int traverse_open_problem(const traverse_problem* problem, traverse_passage** passage);

/* Runs all problems; those that differ in values of options only are computed together. all_ranks: 1: all processes of
 * mpirun make this call and share the runs, 0: this process computes alone. go_on, which may be NULL, is called about
 * twenty times a second with the share of the work that is done, 0 to 1; if it returns 0 the runs end with status 130.
 * *results: the results of all problems, or, if a run failed, of those computed before (the others are NaN); NULL for
 * invalid input. */
TRAVERSE_API int traverse_simulate(size_t count, const traverse_problem* const* problems, int all_ranks,
                                   int (*go_on)(void* context, double done), void* context, traverse_results** results);
/* The results of a passage up to its present sample, once. */
TRAVERSE_API int traverse_finish(traverse_passage* passage, traverse_results** results);

/* The number of results, such as peak_deflection [run, probe], the description of result i, and its values, row by row;
 * NaN: unknown. What no run knows, such as wheel forces without wheels, is not among them. */
TRAVERSE_API size_t traverse_results_count(const traverse_results* results);
TRAVERSE_API int traverse_results_describe(const traverse_results* results, size_t i, traverse_quantity* quantity);
TRAVERSE_API int traverse_results_read(const traverse_results* results, const char* name, double* values, size_t count);
/* A text: what = "model": how run i was computed; "criterion": the name of limit i; "unusual": line i on input
 * that is probably not intended. NULL if there is none; valid until traverse_results_free. */
TRAVERSE_API const char* traverse_results_text(const traverse_results* results, const char* what, size_t i);
TRAVERSE_API void traverse_results_free(traverse_results* results);

#ifdef __cplusplus
}
#endif

#endif
