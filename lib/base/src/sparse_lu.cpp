#include "base/sparse_lu.hpp"

#include <umfpack.h>

#include <array>
#include <utility>

#include "base/error.hpp"

namespace mortise {

struct SparseLu::Data {
  SparseMatrix a;
  std::array<double, UMFPACK_CONTROL> control{};
  void* numeric = nullptr;

  explicit Data(SparseMatrix matrix) : a(std::move(matrix))
  {
    a.makeCompressed();
    umfpack_di_defaults(control.data());
    control[UMFPACK_IRSTEP] = 0;  // refinement in double precision: callers have residuals of their own
  }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() { umfpack_di_free_numeric(&numeric); }

  // Whether it is regular.
  bool factorize()
  {
    const auto size = static_cast<int>(a.rows());
    void* symbolic = nullptr;
    int status =
        umfpack_di_symbolic(size, size, a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), &symbolic, control.data(), nullptr);
    check_memory(status);
    if (status == UMFPACK_OK) {
      status =
          umfpack_di_numeric(a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), symbolic, &numeric, control.data(), nullptr);
      umfpack_di_free_symbolic(&symbolic);
      check_memory(status);
    }
    return status == UMFPACK_OK;
  }
  static void check_memory(int status)
  {
    if (status == UMFPACK_ERROR_out_of_memory)
      throw Error(ExitStatus::machine, "out of memory in a sparse factorization; use smaller subdomains or more memory",
                  Error::Cause::memory);
  }
};

SparseLu::SparseLu(std::unique_ptr<Data> data) : data_(std::move(data)) {}
SparseLu::~SparseLu() = default;

std::unique_ptr<const SparseLu> SparseLu::factorized(SparseMatrix a)
{
  auto data = std::make_unique<Data>(std::move(a));
  if (!data->factorize()) return nullptr;
  return std::unique_ptr<const SparseLu>(new SparseLu(std::move(data)));
}

Eigen::VectorXd SparseLu::solve(const Eigen::VectorXd& b) const
{
  const auto& a = data_->a;
  Eigen::VectorXd x(b.size());
  Data::check_memory(umfpack_di_solve(UMFPACK_A, a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), x.data(), b.data(),
                                      data_->numeric, data_->control.data(), nullptr));
  return x;
}

}  // namespace mortise
