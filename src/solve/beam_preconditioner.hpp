// The beam's factorisation as a PETSc preconditioner, for any KSP, SNES or TS whose matrix is block tridiagonal.
#pragma once

#include <petscksp.h>

namespace traverse::solve {

/// Makes `pc` a shell around SubstructuredCholesky: it factors the KSP's second matrix (AIJ, symmetric positive
/// definite, rows in node-wise blocks of the matrix's block size, coupled to the neighbouring nodes only) each time it
/// has changed, as with a new shift of a TS, and solves with it exactly, so that KSPPREONLY is enough. The pc owns all
/// it needs. Errors come out of KSPSetUp or KSPSolve: traverse::SolverError when the matrix is not positive definite,
/// std::logic_error when it is not block tridiagonal.
void use_beam_factorisation(PC pc);

}  // namespace traverse::solve
