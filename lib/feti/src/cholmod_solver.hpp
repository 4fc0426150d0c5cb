// CHOLMOD as a concrete solver of Amesos2, which Debian's Amesos2 lacks, over mortise::Cholesky.
//
// The matrix is symmetric positive definite, on one rank, and only entries on and above its diagonal are read: a row of the CRS
// matrix is a column of CHOLMOD's lower triangle. It is let go once it is factorized: setA() comes before another factorization.
#pragma once

#include <Amesos2_SolverCore_decl.hpp>
#include <memory>
#include <optional>

#include "base/cholesky.hpp"

namespace mortise::feti {

template <class Matrix, class Vector>
class CholmodSolver : public Amesos2::SolverCore<CholmodSolver, Matrix, Vector> {
  friend class Amesos2::SolverCore<CholmodSolver, Matrix, Vector>;

 public:
  static const char* name;

  /// `block`: unknowns a node, see Cholesky. `tiled`: solutions by the sweep of Cholesky::prepare_for_many_solves(), else by
  /// CHOLMOD's own. `most_rounded`: see DirectSolver.
  CholmodSolver(Teuchos::RCP<const Matrix> a, int block, bool tiled, std::optional<double> most_rounded)
      : Amesos2::SolverCore<CholmodSolver, Matrix, Vector>(a, Teuchos::null, Teuchos::null),
        block_(block),
        tiled_(tiled),
        most_rounded_(most_rounded)
  {
  }
  double rounding() const { return rounding_; }

 private:
  int preOrdering_impl() { return 0; }
  int symbolicFactorization_impl();
  int numericFactorization_impl();
  bool matrixShapeOK_impl() const
  {
    return this->matrixA_->getGlobalNumRows() == this->matrixA_->getGlobalNumCols() && this->matrixA_->getComm()->getSize() == 1;
  }
  void setParameters_impl(const Teuchos::RCP<Teuchos::ParameterList>&) {}
  Teuchos::RCP<const Teuchos::ParameterList> getValidParameters_impl() const
  {
    return Teuchos::rcp(new Teuchos::ParameterList("CholmodSolver"));
  }
  bool loadA_impl(Amesos2::EPhase) { return true; }

  // In place: b is copied into x unless it is x.
  int solve_impl(Teuchos::Ptr<Amesos2::MultiVecAdapter<Vector>> x, Teuchos::Ptr<const Amesos2::MultiVecAdapter<Vector>> b) const;
  // The arrays of the CRS matrix, read as the compressed columns of its transpose.
  SparseMatrix lower() const;

  SparseMatrix lower_;  // from the symbolic to the numeric factorization
  int block_;
  bool tiled_;
  std::optional<double> most_rounded_;
  double rounding_ = 0;
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace mortise::feti
