#include "feti/dense_subdomain.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <numeric>

#include "base/dense.hpp"
#include "base/error.hpp"

// BLAS by its name: Teuchos' interface leaves this one out.
extern "C" void dsymv_(const char* triangle, const int* n, const double* alpha, const double* a, const int* leading,
                       const double* x, const int* step_x, const double* beta, double* y, const int* step_y);

namespace mortise::feti {

namespace {

constexpr Eigen::Index most_columns = 64;
constexpr int most_alone = 3;

// y = A x, A symmetric with leading dimension n, one triangle of which is read. For few columns it is read once for each, at the
// rate of memory: OpenBLAS' dsymm first copies it, which takes as long as four of these
// (lib/feti/test/direct_solver_benchmark.cpp).
void multiply(char triangle, const double* a, const Eigen::MatrixXd& x, Eigen::MatrixXd& y)
{
  const auto n = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  y.resize(n, columns);
  const double one = 1, zero = 0;
  const int step = 1;
  if (columns <= most_alone)
    for (Eigen::Index c = 0; c < columns; ++c)
      dsymv_(&triangle, &n, &one, a, &n, x.col(c).data(), &step, &zero, y.col(c).data(), &step);
  else
    Teuchos::BLAS<int, double>().SYMM(Teuchos::LEFT_SIDE, triangle == 'L' ? Teuchos::LOWER_TRI : Teuchos::UPPER_TRI, n, columns,
                                      one, a, n, x.data(), n, zero, y.data(), n);
}

// On some unknowns of a dense subdomain: K_bb, or, where W = K_ii^-1 K_ib is given, K_bb - K_bi W.
class DenseInterface : public InterfaceStiffness {
 public:
  DenseInterface(const DenseSubdomain& subdomain, std::vector<int> unknowns, bool condensed)
      : subdomain_(subdomain), unknowns_(std::move(unknowns))
  {
    std::vector<int> all(static_cast<std::size_t>(subdomain.size()));
    std::iota(all.begin(), all.end(), 0);
    std::set_difference(all.begin(), all.end(), unknowns_.begin(), unknowns_.end(), std::back_inserter(inside_));
    if (!condensed || inside_.empty()) {
      inside_.clear();
      return;
    }
    const auto count = static_cast<Eigen::Index>(inside_.size());
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(subdomain.size(), count);
    for (Eigen::Index i = 0; i < count; ++i) unit(inside_[static_cast<std::size_t>(i)], i) = 1;
    const Eigen::MatrixXd columns = subdomain.apply_to_columns(unit);
    const Eigen::MatrixXd own = columns(inside_, Eigen::all), coupling = columns(unknowns_, Eigen::all).transpose();
    relaxed_ = dense::solve_positive(own, coupling);
  }

  Eigen::MatrixXd apply(const Eigen::MatrixXd& u) const override
  {
    Eigen::MatrixXd result(u.rows(), u.cols());
    for (Eigen::Index first = 0; first < u.cols(); first += most_columns) {
      const auto count = std::min(most_columns, u.cols() - first);
      Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(subdomain_.size(), count);
      whole(unknowns_, Eigen::all) = u.middleCols(first, count);
      if (!inside_.empty()) whole(inside_, Eigen::all) = -relaxed_ * u.middleCols(first, count);
      const Eigen::MatrixXd force = subdomain_.apply_to_columns(whole);
      result.middleCols(first, count) = force(unknowns_, Eigen::all);
    }
    return result;
  }

 private:
  const DenseSubdomain& subdomain_;
  std::vector<int> unknowns_, inside_;
  Eigen::MatrixXd relaxed_;  // W
};

}  // namespace

DenseSubdomain::DenseSubdomain(const Eigen::MatrixXd& matrix, Eigen::MatrixXd kernel, std::span<const Point> points,
                               int dimension)
    : matrices_(matrix.rows(), matrix.rows() + 1), kernel_(std::move(kernel))
{
  const auto n = static_cast<int>(matrix.rows());
  fixing_ = fixing_term(matrix.diagonal(), kernel_, points, dimension);
  auto upper = matrices_.rightCols(n);
  upper.triangularView<Eigen::Upper>() = matrix.transpose();
  for (int c = 0; c < n; ++c)
    for (SparseMatrix::InnerIterator entry(fixing_, c); entry; ++entry) upper(c, entry.row()) += entry.value();
  int info = 0;
  Teuchos::LAPACK<int, double> lapack;
  lapack.POTRF('U', n, upper.data(), n, &info);
  if (info == 0) lapack.POTRI('U', n, upper.data(), n, &info);
  if (info != 0) throw Error(ExitStatus::bad_input, "the matrix of a subdomain is not positive definite");
  matrices_.leftCols(n).triangularView<Eigen::Lower>() = matrix;
}

void DenseSubdomain::apply_inverse(std::span<double* const> columns) const
{
  Eigen::MatrixXd x, y;
  for (std::size_t first = 0; first < columns.size(); first += most_columns) {
    const auto count = std::min<std::size_t>(most_columns, columns.size() - first);
    x.resize(size(), static_cast<Eigen::Index>(count));
    for (std::size_t c = 0; c < count; ++c)
      x.col(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::VectorXd>(columns[first + c], size());
    multiply('U', matrices_.col(1).data(), x, y);
    for (std::size_t c = 0; c < count; ++c)
      Eigen::Map<Eigen::VectorXd>(columns[first + c], size()) = y.col(static_cast<Eigen::Index>(c));
  }
}

Eigen::MatrixXd DenseSubdomain::apply_to_columns(const Eigen::MatrixXd& u) const
{
  Eigen::MatrixXd result;
  multiply('L', matrices_.data(), u, result);
  return result;
}

Eigen::VectorXd DenseSubdomain::apply(const Eigen::VectorXd& u) const
{
  return apply_to_columns(u);
}

SparseMatrix DenseSubdomain::lower() const
{
  const Eigen::MatrixXd lower = matrices_.leftCols(size()).triangularView<Eigen::Lower>();
  return lower.sparseView();
}

std::unique_ptr<const InterfaceStiffness> DenseSubdomain::interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                              const std::string&) const
{
  return std::make_unique<DenseInterface>(*this, unknowns, condensed);
}

}  // namespace mortise::feti
