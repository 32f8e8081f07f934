// The beam's factorisation as a PETSc preconditioner, for any KSP, SNES or TS whose matrix is block tridiagonal.
#pragma once

#include <petscksp.h>

namespace traverse::solve {

/// Makes `pc` a shell around SubstructuredCholesky. It factorises the KSP's second matrix (AIJ, symmetric positive
/// definite, rows in node-wise blocks of the matrix's block size, coupled to neighbouring nodes only) each time it has
/// changed, as with a new shift of a TS, and solves with it exactly, so that KSPPREONLY is sufficient. The pc owns all
/// its data. KSPSetUp and KSPSolve report errors: traverse::SolverError if the matrix is not positive definite,
/// std::logic_error if it is not block tridiagonal.
void use_beam_factorisation(PC pc);

}  // namespace traverse::solve
