#include "feti/direct_solver.hpp"

#include <Amesos2.hpp>
#include <Amesos2_SolverCore_def.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/tpetra.hpp"
#include "cholmod_solver.hpp"

namespace mortise::feti {

namespace {

using CrsMatrix = Tpetra::CrsMatrix<Scalar, Local, Global, Node>;
using Amesos2Solver = Amesos2::Solver<CrsMatrix, MultiVector>;
using OrdinalView = Kokkos::View<Local*, Kokkos::DefaultHostExecutionSpace>;
using ScalarView = Kokkos::View<Scalar*, Kokkos::DefaultHostExecutionSpace>;

}  // namespace

template <class Matrix, class Vector>
const char* CholmodSolver<Matrix, Vector>::name = "CHOLMOD";

template <class Matrix, class Vector>
SparseMatrix CholmodSolver<Matrix, Vector>::lower() const
{
  OrdinalView offsets, indices;  // copies or views, as Amesos2 sees fit: they live until the matrix is made
  ScalarView values;
  this->matrixA_->returnRowPtr_kokkos_view(offsets);
  this->matrixA_->returnColInd_kokkos_view(indices);
  this->matrixA_->returnValues_kokkos_view(values);
  const auto n = static_cast<Eigen::Index>(this->globalNumCols_);
  return Eigen::Map<const SparseMatrix>(n, n, static_cast<Eigen::Index>(this->globalNumNonZeros_), offsets.data(), indices.data(),
                                        values.data());
}

template <class Matrix, class Vector>
int CholmodSolver<Matrix, Vector>::symbolicFactorization_impl()
{
  factor_ = std::make_unique<Cholesky>(lower(), block_);
  return 0;
}

template <class Matrix, class Vector>
int CholmodSolver<Matrix, Vector>::numericFactorization_impl()
{
  if (!factor_->factorize(lower()))
    throw Error(ExitStatus::bad_input, "the stiffness matrix of a subdomain is not positive definite");
  factor_->prepare_for_many_solves();
  this->setNnzLU(factor_->factor_bytes() / sizeof(double));
  return 0;
}

template <class Matrix, class Vector>
int CholmodSolver<Matrix, Vector>::solve_impl(Teuchos::Ptr<Amesos2::MultiVecAdapter<Vector>> x,
                                              Teuchos::Ptr<const Amesos2::MultiVecAdapter<Vector>> b) const
{
  using SolveView = Kokkos::View<Scalar**, Kokkos::LayoutLeft, Kokkos::DefaultHostExecutionSpace>;
  using Copy = Amesos2::Util::get_1d_copy_helper_kokkos_view<Amesos2::MultiVecAdapter<Vector>, SolveView>;
  const auto rows = static_cast<std::size_t>(this->globalNumCols_);
  SolveView right, left;
  Copy::do_get(true, b, right, rows, Amesos2::ROOTED, this->rowIndexBase_);
  Copy::do_get(false, Teuchos::ptr_const_cast<const Amesos2::MultiVecAdapter<Vector>>(x), left, rows, Amesos2::ROOTED,
               this->rowIndexBase_);
  SolveView result("solution", rows, x->getGlobalNumVectors());
  factor_->solve(right.data(), result.data(), static_cast<int>(x->getGlobalNumVectors()), static_cast<int>(rows));
  Amesos2::Util::put_1d_data_helper_kokkos_view<Amesos2::MultiVecAdapter<Vector>, SolveView>::do_put(
      x, result, rows, Amesos2::ROOTED, this->rowIndexBase_);
  return 0;
}

namespace {

// Rows of the CRS matrix are columns of `columns`; with a lower triangle that is its transpose, the upper one.
Teuchos::RCP<const CrsMatrix> crs(const SparseMatrix& columns)
{
  const auto n = static_cast<std::size_t>(columns.cols());
  const auto map = Teuchos::rcp(new Map(n, 0, Teuchos::rcp(new Teuchos::SerialComm<int>), Tpetra::LocallyReplicated));
  Teuchos::ArrayRCP<std::size_t> offsets(static_cast<Teuchos::Ordinal>(n + 1));
  Teuchos::ArrayRCP<Local> indices(columns.nonZeros());
  Teuchos::ArrayRCP<Scalar> values(columns.nonZeros());
  std::copy_n(columns.outerIndexPtr(), n + 1, offsets.begin());
  std::copy_n(columns.innerIndexPtr(), columns.nonZeros(), indices.begin());
  std::copy_n(columns.valuePtr(), columns.nonZeros(), values.begin());
  const auto matrix = Teuchos::rcp(new CrsMatrix(map, map, offsets, indices, values));
  matrix->expertStaticFillComplete(map, map);
  return matrix;
}

Teuchos::RCP<Amesos2Solver> cholmod(const SparseMatrix& lower, int block)
{
  return Teuchos::rcp(new CholmodSolver<CrsMatrix, MultiVector>(crs(lower), block));
}

Teuchos::RCP<Amesos2Solver> klu2(const SparseMatrix& lower, int)
{
  return Amesos2::create<CrsMatrix, MultiVector>("KLU2", crs(lower.selfadjointView<Eigen::Lower>()));
}

// To add a factorization: a function here that makes an Amesos2 solver from a lower triangle, and its name in feti::Options.
using Maker = Teuchos::RCP<Amesos2Solver> (*)(const SparseMatrix& lower, int block);
const std::map<std::string, Maker>& makers()
{
  static const std::map<std::string, Maker> table{{"cholmod", cholmod}, {"klu2", klu2}};
  return table;
}

}  // namespace

struct DirectSolver::Data {
  Teuchos::RCP<Amesos2Solver> solver;
  std::unique_ptr<Cholesky> cholesky;  // in place of `solver`, where it is ours
  int size = 0;
};

DirectSolver::DirectSolver(const std::string& name, const SparseMatrix& lower, int block) : data_(std::make_unique<Data>())
{
  const auto maker = makers().find(name);
  if (maker == makers().end()) throw Error(ExitStatus::bad_input, "there is no factorization called \"" + name + "\"");
  data_->size = static_cast<int>(lower.cols());
  try {
    data_->solver = maker->second(lower, block);
    data_->solver->symbolicFactorization().numericFactorization();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ExitStatus::machine,
                "not enough memory for the factor of a subdomain; smaller ones need less (decomposition.unknowns_per_subdomain)",
                Error::Cause::memory);
  } catch (const std::exception& error) {
    throw Error(ExitStatus::bad_input, "the stiffness matrix of a subdomain cannot be factorized (" + std::string(error.what()) +
                                           "); look for cells without volume and for extreme material data");
  }
  if (auto* ours = dynamic_cast<CholmodSolver<CrsMatrix, MultiVector>*>(data_->solver.get())) {
    data_->cholesky = ours->release();
    data_->solver = Teuchos::null;  // and with it the matrix
  }
}

DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;
DirectSolver::~DirectSolver() = default;

void DirectSolver::solve(std::span<double* const> columns) const
{
  if (data_->cholesky) return data_->cholesky->solve(columns);
  const auto map = Teuchos::rcp(
      new Map(static_cast<std::size_t>(data_->size), 0, Teuchos::rcp(new Teuchos::SerialComm<int>), Tpetra::LocallyReplicated));
  MultiVector right(map, columns.size()), left(map, columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) std::copy_n(columns[c], data_->size, right.getDataNonConst(c).begin());
  data_->solver->solve(Teuchos::ptr(&left), Teuchos::ptr<const MultiVector>(&right));
  for (std::size_t c = 0; c < columns.size(); ++c) std::copy_n(left.getData(c).begin(), data_->size, columns[c]);
}

std::size_t DirectSolver::factor_bytes() const
{
  return data_->cholesky ? data_->cholesky->factor_bytes() : 0;
}

}  // namespace mortise::feti
