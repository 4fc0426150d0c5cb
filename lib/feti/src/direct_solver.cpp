#include "feti/direct_solver.hpp"

#include <Amesos2.hpp>
#include <Amesos2_SolverCore_def.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <map>
#include <memory>

#include "base/error.hpp"
#include "base/tpetra.hpp"
#include "cholmod_solver.hpp"
#include "columns.hpp"

namespace mortise::feti {

namespace {

using CrsMatrix = Tpetra::CrsMatrix<Scalar, Local, Global, Node>;
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
  lower_ = lower();
  factor_ = std::make_unique<Cholesky>(lower_, block_);
  return 0;
}

template <class Matrix, class Vector>
int CholmodSolver<Matrix, Vector>::numericFactorization_impl()
{
  if (!factor_->factorize(lower_))
    throw Error(ExitStatus::bad_input, "the stiffness matrix of a subdomain is not positive definite");
  if (tiled_ && most_rounded_) {
    const double rounding = factor_->prepare_in_single_precision(lower_, block_, *most_rounded_);
    if (factor_->in_single_precision()) rounding_ = rounding;
  } else if (tiled_) {
    factor_->prepare_for_many_solves();
  }
  SparseMatrix().swap(lower_);  // an assignment would keep its memory
  this->setNnzLU(factor_->factor_bytes() / sizeof(double));
  this->matrixA_ = Teuchos::null;
  return 0;
}

template <class Matrix, class Vector>
int CholmodSolver<Matrix, Vector>::solve_impl(Teuchos::Ptr<Amesos2::MultiVecAdapter<Vector>> x,
                                              Teuchos::Ptr<const Amesos2::MultiVecAdapter<Vector>> b) const
{
  for (std::size_t c = 0; c < x->columns.size(); ++c)
    if (x->columns[c] != b->columns[c]) std::copy_n(b->columns[c], this->globalNumCols_, x->columns[c]);
  factor_->solve(x->columns);
  return 0;
}

// An Amesos2 solver, whatever it takes for right-hand sides.
class Amesos2Factor {
 public:
  virtual ~Amesos2Factor() = default;
  virtual void factorize() = 0;
  virtual void solve(std::span<double* const> columns) = 0;
  virtual std::size_t bytes() const = 0;
  virtual double rounding() const { return 0; }
};

namespace {

Teuchos::RCP<const Map> local_map(std::size_t size)
{
  return Teuchos::rcp(new Map(size, 0, Teuchos::rcp(new Teuchos::SerialComm<int>), Tpetra::LocallyReplicated));
}

// Rows of the CRS matrix are columns of `columns`; with a lower triangle that is its transpose, the upper one.
Teuchos::RCP<const CrsMatrix> crs(const SparseMatrix& columns)
{
  const auto n = static_cast<std::size_t>(columns.cols());
  const auto map = local_map(n);
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

// Vector: Columns, which our solver takes where they are; MultiVector for those that Amesos2 brings, with copies of the columns.
template <class Vector>
class Factor : public Amesos2Factor {
 public:
  explicit Factor(Teuchos::RCP<Amesos2::Solver<CrsMatrix, Vector>> solver, std::size_t size)
      : solver_(std::move(solver)), size_(size)
  {
  }
  void factorize() override { solver_->symbolicFactorization().numericFactorization(); }
  void solve(std::span<double* const> columns) override;
  std::size_t bytes() const override { return solver_->getStatus().getNnzLU() * sizeof(double); }

 private:
  void solve(Vector& x) { solver_->solve(Teuchos::ptr(&x), Teuchos::ptr<const Vector>(&x)); }

  Teuchos::RCP<Amesos2::Solver<CrsMatrix, Vector>> solver_;
  std::size_t size_;
};

template <>
void Factor<Columns>::solve(std::span<double* const> columns)
{
  Columns x{columns};
  solve(x);
}

template <>
void Factor<MultiVector>::solve(std::span<double* const> columns)
{
  MultiVector x(local_map(size_), columns.size(), false);
  for (std::size_t c = 0; c < columns.size(); ++c) std::copy_n(columns[c], size_, x.getDataNonConst(c).begin());
  solve(x);
  for (std::size_t c = 0; c < columns.size(); ++c) std::copy_n(x.getData(c).begin(), size_, columns[c]);
}

class CholmodFactor : public Factor<Columns> {
 public:
  CholmodFactor(Teuchos::RCP<CholmodSolver<CrsMatrix, Columns>> solver, std::size_t size)
      : Factor<Columns>(solver, size), cholmod_(std::move(solver))
  {
  }
  double rounding() const override { return cholmod_->rounding(); }

 private:
  Teuchos::RCP<CholmodSolver<CrsMatrix, Columns>> cholmod_;
};

template <bool Tiled>
std::unique_ptr<Amesos2Factor> cholmod(const SparseMatrix& lower, int block, std::optional<double> most_rounded)
{
  const auto solver = Teuchos::rcp(new CholmodSolver<CrsMatrix, Columns>(crs(lower), block, Tiled, most_rounded));
  return std::make_unique<CholmodFactor>(solver, static_cast<std::size_t>(lower.cols()));
}

std::unique_ptr<Amesos2Factor> klu2(const SparseMatrix& lower, int, std::optional<double>)
{
  const auto solver = Amesos2::create<CrsMatrix, MultiVector>("KLU2", crs(lower.selfadjointView<Eigen::Lower>()));
  return std::make_unique<Factor<MultiVector>>(solver, static_cast<std::size_t>(lower.cols()));
}

// To add a factorization: a function here that makes an Amesos2 solver of a lower triangle, and a row in the table.
using Maker = std::unique_ptr<Amesos2Factor> (*)(const SparseMatrix& lower, int block, std::optional<double> most_rounded);
const std::map<std::string, Maker>& makers()
{
  static const std::map<std::string, Maker> table{{"cholmod", cholmod<true>}, {"cholmod_plain", cholmod<false>}, {"klu2", klu2}};
  return table;
}

}  // namespace

std::vector<std::string> DirectSolver::names()
{
  std::vector<std::string> result;
  for (const auto& [name, maker] : makers()) result.push_back(name);
  return result;
}

struct DirectSolver::Data {
  std::unique_ptr<Amesos2Factor> factor;
};

DirectSolver::DirectSolver(const std::string& name, const SparseMatrix& lower, int block, std::optional<double> most_rounded)
    : data_(std::make_unique<Data>())
{
  const auto maker = makers().find(name);
  if (maker == makers().end()) throw Error(ExitStatus::bad_input, "there is no factorization called \"" + name + "\"");
  try {
    data_->factor = maker->second(lower, block, most_rounded);
    data_->factor->factorize();
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
}

DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;
DirectSolver::~DirectSolver() = default;

void DirectSolver::solve(std::span<double* const> columns) const
{
  if (!columns.empty()) data_->factor->solve(columns);
}

double DirectSolver::rounding() const
{
  return data_->factor->rounding();
}

std::size_t DirectSolver::factor_bytes() const
{
  return data_->factor->bytes();
}

}  // namespace mortise::feti
