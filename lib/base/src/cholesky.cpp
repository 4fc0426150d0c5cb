#include "base/cholesky.hpp"

#include <cholmod.h>

#include <cstring>

#include "base/error.hpp"

namespace mortise {

struct Cholesky::Data {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* x = nullptr;  // solution and workspaces of cholmod_solve2
  cholmod_dense* y = nullptr;
  cholmod_dense* e = nullptr;

  Data()
  {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.print = 0;
    common.error_handler = nullptr;
  }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data()
  {
    cholmod_free_dense(&x, &common);
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  void check_memory() const
  {
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE)
      throw Error(ExitStatus::machine, "out of memory in a sparse factorization; use smaller subdomains or more memory");
  }
};

namespace {

// CHOLMOD's view of the same arrays; it does not change them.
cholmod_sparse wrap(const SparseMatrix& lower)
{
  cholmod_sparse a{};
  a.nrow = static_cast<std::size_t>(lower.rows());
  a.ncol = static_cast<std::size_t>(lower.cols());
  a.nzmax = static_cast<std::size_t>(lower.nonZeros());
  a.p = const_cast<int*>(lower.outerIndexPtr());
  a.i = const_cast<int*>(lower.innerIndexPtr());
  a.x = const_cast<double*>(lower.valuePtr());
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = 1;
  a.packed = 1;
  return a;
}

}  // namespace

Cholesky::Cholesky(const SparseMatrix& lower) : data_(std::make_unique<Data>())
{
  cholmod_sparse a = wrap(lower);
  data_->factor = cholmod_analyze(&a, &data_->common);
  data_->check_memory();
}

Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;
Cholesky::~Cholesky() = default;

bool Cholesky::factorize(const SparseMatrix& lower)
{
  cholmod_sparse a = wrap(lower);
  data_->common.status = CHOLMOD_OK;
  cholmod_factorize(&a, data_->factor, &data_->common);
  data_->check_memory();
  return data_->common.status == CHOLMOD_OK && data_->factor->minor == data_->factor->n;
}

void Cholesky::solve(const double* b, double* x, int columns, int stride) const
{
  Data& data = *data_;
  cholmod_dense rhs{};
  rhs.nrow = data.factor->n;
  rhs.ncol = static_cast<std::size_t>(columns);
  rhs.d = static_cast<std::size_t>(stride);
  rhs.nzmax = rhs.d * rhs.ncol;
  rhs.x = const_cast<double*>(b);
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, data.factor, &rhs, nullptr, &data.x, nullptr, &data.y, &data.e, &data.common);
  data.check_memory();
  const auto* solution = static_cast<const double*>(data.x->x);
  for (int c = 0; c < columns; ++c)
    std::memcpy(x + static_cast<std::ptrdiff_t>(c) * stride, solution + static_cast<std::ptrdiff_t>(c) * data.x->d,
                data.factor->n * sizeof(double));
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const
{
  Eigen::VectorXd x(b.size());
  if (b.size() > 0) solve(b.data(), x.data(), 1, static_cast<int>(b.size()));
  return x;
}

int Cholesky::size() const
{
  return static_cast<int>(data_->factor->n);
}

std::size_t Cholesky::factor_bytes() const
{
  return static_cast<std::size_t>(data_->common.lnz) * sizeof(double);
}

}  // namespace mortise
