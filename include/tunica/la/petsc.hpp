// SPDX-License-Identifier: MIT
// Any Krylov solver and preconditioner of PETSc, by its KSP. Needs the target tunica::petsc.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/la/vector_ops.hpp"

#define OMPI_SKIP_MPICXX
#include <petscksp.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace tunica::la {

struct PetscOptions {
  std::string solver = KSPGMRES;       // "cg" "minres" "bcgs" ...
  std::string preconditioner = PCILU;  // "gamg" "icc" "hypre" "lu" ...
  std::string prefix = "tunica_";  // of options in PETSc's data base, which come last: -tunica_ksp_type cg
  double tolerance = 1e-8;         // on |b - A x| / |b|
  int max_iterations = 1000;
  int block = 1;  // unknowns of a node, interleaved
};

/// One process owns all rows. PETSc is started by the first solver unless the program has done so, and then
/// ended at exit.
class Petsc {
 public:
  static constexpr bool symmetric = false;

  Petsc() = default;
  explicit Petsc(PetscOptions options) : options_(std::move(options)) {}

  void analyse(const SparseMatrix&) { handles_.reset(); }

  /// `diverged` for a matrix with a NaN, or one that the preconditioner refuses.
  SolveReport factorise(const SparseMatrix& A) {
    static_assert(std::is_same_v<PetscScalar, double> && sizeof(PetscInt) == sizeof(int),
                  "tunica::petsc wants a PETSc of double numbers and 32-bit indices");
    start_session();
    handles_ = std::make_unique<Handles>();
    if (!std::isfinite(A.coeffs().sum())) return failed();
    A_ = A;
    auto& h = *handles_;
    const auto n = static_cast<PetscInt>(A_.rows());
    bool good = MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, A_.outerIndexPtr(), A_.innerIndexPtr(),
                                          A_.valuePtr(), &h.matrix) == 0 &&
                MatSetBlockSize(h.matrix, options_.block) == 0 &&
                KSPCreate(PETSC_COMM_SELF, &h.solver) == 0 &&
                KSPSetOptionsPrefix(h.solver, options_.prefix.c_str()) == 0 &&
                KSPSetOperators(h.solver, h.matrix, h.matrix) == 0 &&
                KSPSetType(h.solver, options_.solver.c_str()) == 0;
    PC preconditioner = nullptr;
    good = good && KSPGetPC(h.solver, &preconditioner) == 0 &&
           PCSetType(preconditioner, options_.preconditioner.c_str()) == 0 &&
           KSPSetTolerances(h.solver, options_.tolerance, PETSC_DEFAULT, PETSC_DEFAULT,
                            options_.max_iterations) == 0 &&
           KSPSetInitialGuessNonzero(h.solver, options_.solver == KSPPREONLY ? PETSC_FALSE : PETSC_TRUE) == 0;
    if (good && options_.solver == KSPGMRES) good = KSPSetPCSide(h.solver, PC_RIGHT) == 0;
    if (good && options_.solver == KSPCG) good = KSPSetNormType(h.solver, KSP_NORM_UNPRECONDITIONED) == 0;
    good = good && KSPSetFromOptions(h.solver) == 0 && KSPSetUp(h.solver) == 0;
    PCFailedReason reason = PC_NOERROR;
    good = good && PCGetFailedReason(preconditioner, &reason) == 0 && reason == PC_NOERROR;
    return good ? SolveReport{Status::converged, 0, 0} : failed();
  }

  /// x: the start if it has the size of b, zero otherwise.
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    const double size = b.norm();
    if (!handles_ || !std::isfinite(size)) return {Status::diverged, 0, size};
    if (x.size() != b.size()) x = Eigen::VectorXd::Zero(b.size());
    if (size == 0) {
      x.setZero();
      return {Status::converged, 0, 0};
    }
    const auto n = static_cast<PetscInt>(b.size());
    Vec right = nullptr, left = nullptr;
    const bool good = VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, b.data(), &right) == 0 &&
                      VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), &left) == 0 &&
                      KSPSolve(handles_->solver, right, left) == 0;
    VecDestroy(&right);
    VecDestroy(&left);
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_DIVERGED_BREAKDOWN;
    if (good) {
      KSPGetIterationNumber(handles_->solver, &iterations);
      KSPGetConvergedReason(handles_->solver, &reason);
    }
    const double residual = (b - A_ * x).norm() / size;
    return {status(reason, residual), static_cast<int>(iterations), residual};
  }

 private:
  struct Handles {
    Mat matrix = nullptr;
    KSP solver = nullptr;

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
      KSPDestroy(&solver);
      MatDestroy(&matrix);
    }
  };

  /// What was measured decides what is a solution; PETSc says why there is none.
  [[nodiscard]] Status status(KSPConvergedReason reason, double residual) const {
    if (!std::isfinite(residual)) return Status::diverged;
    if (residual <= 1.01 * options_.tolerance) return Status::converged;
    if (reason == KSP_DIVERGED_ITS) return Status::max_iterations;
    return reason > 0 ? Status::stalled : Status::diverged;
  }

  static void start_session() {
    [[maybe_unused]] static const bool started = [] {
      PetscBool running = PETSC_FALSE;
      PetscInitialized(&running);
      if (!running) {
        PetscInitializeNoArguments();
        std::atexit([] { PetscFinalize(); });
      }
      return true;
    }();
  }

  SolveReport failed() {
    handles_.reset();
    return {Status::diverged, 0, 0};
  }

  PetscOptions options_;
  RowMatrix A_;
  std::unique_ptr<Handles> handles_;
};

static_assert(LinearSolver<Petsc>);

}  // namespace tunica::la
