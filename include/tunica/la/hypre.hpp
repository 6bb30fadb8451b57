// SPDX-License-Identifier: MIT
// Conjugate gradients with BoomerAMG, by hypre. Needs the target tunica::hypre.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/la/vector_ops.hpp"

#define OMPI_SKIP_MPICXX
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <mpi.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

namespace tunica::la {

struct HypreOptions {
  double tolerance = 1e-8;  // on |b - A x| / |b|
  int max_iterations = 1000;
  int components = 1;    // unknowns of a node, interleaved
  double strong = 0.25;  // threshold of couplings
  int aggressive = 1;    // levels that are made coarser twice at once
};

/// For symmetric positive definite matrices, both triangles stored. One process owns all rows. MPI is started
/// by the first solver unless the program has done so, and then ended at exit.
class Hypre {
 public:
  static constexpr bool symmetric = true;

  Hypre() = default;
  explicit Hypre(HypreOptions options) : options_(options) {}

  void analyse(const SparseMatrix&) {}

  /// `diverged` for a matrix with a NaN, or one that BoomerAMG refuses.
  SolveReport factorise(const SparseMatrix& A) {
    TUNICA_EXPECT(A.isCompressed(), "a solver reads compressed matrices");
    start_session();
    handles_ = std::make_unique<Handles>();
    if (!std::isfinite(A.coeffs().sum())) return failed();
    A_ = Eigen::Map<const RowMatrix>(A.rows(), A.cols(), A.nonZeros(), A.outerIndexPtr(), A.innerIndexPtr(),
                                     A.valuePtr());
    auto& h = *handles_;
    const auto n = static_cast<HYPRE_BigInt>(A.rows());
    std::vector<HYPRE_Int> entries(static_cast<std::size_t>(n));
    rows_.resize(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i] = static_cast<HYPRE_BigInt>(i);
      entries[i] = A_.outerIndexPtr()[i + 1] - A_.outerIndexPtr()[i];
    }
    const std::vector<HYPRE_BigInt> columns(A_.innerIndexPtr(), A_.innerIndexPtr() + A_.nonZeros());
    HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, n - 1, 0, n - 1, &h.matrix);
    HYPRE_IJMatrixSetObjectType(h.matrix, HYPRE_PARCSR);
    HYPRE_IJMatrixInitialize(h.matrix);
    HYPRE_IJMatrixSetValues(h.matrix, static_cast<HYPRE_Int>(n), entries.data(), rows_.data(), columns.data(),
                            A_.valuePtr());
    HYPRE_IJMatrixAssemble(h.matrix);
    for (HYPRE_IJVector* v : {&h.b, &h.x}) {
      HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, n - 1, v);
      HYPRE_IJVectorSetObjectType(*v, HYPRE_PARCSR);
      HYPRE_IJVectorInitialize(*v);
      HYPRE_IJVectorAssemble(*v);
    }
    HYPRE_BoomerAMGCreate(&h.multigrid);
    HYPRE_BoomerAMGSetCoarsenType(h.multigrid, hmis);
    HYPRE_BoomerAMGSetInterpType(h.multigrid, extended_plus_i);
    HYPRE_BoomerAMGSetPMaxElmts(h.multigrid, 4);
    HYPRE_BoomerAMGSetAggNumLevels(h.multigrid, options_.aggressive);
    HYPRE_BoomerAMGSetStrongThreshold(h.multigrid, options_.strong);
    HYPRE_BoomerAMGSetNumFunctions(h.multigrid, options_.components);
    HYPRE_BoomerAMGSetTol(h.multigrid, 0);
    HYPRE_BoomerAMGSetMaxIter(h.multigrid, 1);
    HYPRE_ParCSRPCGCreate(MPI_COMM_SELF, &h.solver);
    HYPRE_PCGSetTwoNorm(h.solver, 1);
    HYPRE_PCGSetTol(h.solver, options_.tolerance);
    HYPRE_PCGSetMaxIter(h.solver, options_.max_iterations);
    HYPRE_ParCSRPCGSetPrecond(h.solver, HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup, h.multigrid);
    HYPRE_ParCSRPCGSetup(h.solver, object(h.matrix), object(h.b), object(h.x));
    return flawless() ? SolveReport{Status::converged, 0, 0} : failed();
  }

  /// x: the start if it has the size of b, zero otherwise.
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    const double size = b.norm();
    if (!handles_ || !handles_->solver || !std::isfinite(size)) return {Status::diverged, 0, size};
    if (x.size() != b.size()) x = Eigen::VectorXd::Zero(b.size());
    if (size == 0) {
      x.setZero();
      return {Status::converged, 0, 0};
    }
    auto& h = *handles_;
    const auto n = static_cast<HYPRE_Int>(b.size());
    HYPRE_IJVectorSetValues(h.b, n, rows_.data(), b.data());
    HYPRE_IJVectorSetValues(h.x, n, rows_.data(), x.data());
    HYPRE_ParCSRPCGSolve(h.solver, object(h.matrix), object(h.b), object(h.x));
    HYPRE_IJVectorGetValues(h.x, n, rows_.data(), x.data());
    HYPRE_Int iterations = 0;
    HYPRE_PCGGetNumIterations(h.solver, &iterations);
    static_cast<void>(flawless());  // an iteration that did not converge is also an error of hypre's
    const double residual = (b - A_ * x).norm() / size;
    const auto status = !std::isfinite(residual) || residual > 1e8 ? Status::diverged
                        : residual <= 1.01 * options_.tolerance    ? Status::converged
                        : iterations >= options_.max_iterations    ? Status::max_iterations
                                                                   : Status::stalled;
    return {status, static_cast<int>(iterations), residual};
  }

 private:
  static constexpr HYPRE_Int hmis = 10, extended_plus_i = 6;

  struct Handles {
    HYPRE_IJMatrix matrix = nullptr;
    HYPRE_IJVector b = nullptr, x = nullptr;
    HYPRE_Solver multigrid = nullptr, solver = nullptr;

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
      if (solver) HYPRE_ParCSRPCGDestroy(solver);
      if (multigrid) HYPRE_BoomerAMGDestroy(multigrid);
      for (const HYPRE_IJVector v : {b, x})
        if (v) HYPRE_IJVectorDestroy(v);
      if (matrix) HYPRE_IJMatrixDestroy(matrix);
    }
  };

  static void start_session() {
    [[maybe_unused]] static const bool started = [] {
      int running = 0;
      MPI_Initialized(&running);
      if (!running) {
        MPI_Init(nullptr, nullptr);
        std::atexit([] { MPI_Finalize(); });
      }
      HYPRE_Init();
      return true;
    }();
  }

  static HYPRE_ParCSRMatrix object(HYPRE_IJMatrix m) {
    void* p = nullptr;
    HYPRE_IJMatrixGetObject(m, &p);
    return static_cast<HYPRE_ParCSRMatrix>(p);
  }
  static HYPRE_ParVector object(HYPRE_IJVector v) {
    void* p = nullptr;
    HYPRE_IJVectorGetObject(v, &p);
    return static_cast<HYPRE_ParVector>(p);
  }

  /// No error since the last call.
  static bool flawless() {
    const bool good = HYPRE_GetError() == 0;
    HYPRE_ClearAllErrors();
    return good;
  }

  SolveReport failed() {
    handles_.reset();
    return {Status::diverged, 0, 0};
  }

  HypreOptions options_;
  RowMatrix A_;
  std::vector<HYPRE_BigInt> rows_;
  std::unique_ptr<Handles> handles_;
};

static_assert(LinearSolver<Hypre>);

}  // namespace tunica::la
