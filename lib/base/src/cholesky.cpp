#include "base/cholesky.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "base/submatrix.hpp"
#include "supernodal.hpp"

namespace mortise {

struct Cholesky::Data {
  // The lower triangle of a matrix in the order of a factor, and where its numbers stand in the one that is given: factorizations
  // after the first need not permute it again, which takes as long as the numbers of a small factor.
  struct Ordered {
    SparseMatrix lower;
    std::vector<int> source;
    std::vector<int> start, rows;  // the pattern that is given

    Ordered(const SparseMatrix& matrix, const int* order)
        : lower(matrix.rows(), matrix.cols()),
          start(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1),
          rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros())
    {
      std::vector<int> place(static_cast<std::size_t>(matrix.cols()));
      for (int k = 0; k < matrix.cols(); ++k) place[static_cast<std::size_t>(order[k])] = k;
      const auto for_each = [&](const auto& visit) {
        for (int j = 0; j < matrix.cols(); ++j)
          for (int k = matrix.outerIndexPtr()[j]; k < matrix.outerIndexPtr()[j + 1]; ++k) {
            const int i = rows[static_cast<std::size_t>(k)];
            if (i < j) continue;
            const int a = place[static_cast<std::size_t>(i)], b = place[static_cast<std::size_t>(j)];
            visit(std::max(a, b), std::min(a, b), k);
          }
      };
      int* const first = lower.outerIndexPtr();
      for_each([&](int, int column, int) { ++first[column + 1]; });
      std::partial_sum(first, first + matrix.cols() + 1, first);
      lower.resizeNonZeros(first[matrix.cols()]);
      source.resize(static_cast<std::size_t>(lower.nonZeros()));
      std::vector<int> next(first, first + matrix.cols());
      for_each([&](int row, int column, int from) {
        const int at = next[static_cast<std::size_t>(column)]++;
        lower.innerIndexPtr()[at] = row;
        source[static_cast<std::size_t>(at)] = from;
      });
    }
    bool fits(const SparseMatrix& matrix) const
    {
      return std::equal(start.begin(), start.end(), matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1) &&
             std::equal(rows.begin(), rows.end(), matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    }
    void take(const SparseMatrix& matrix)
    {
      for (std::size_t k = 0; k < source.size(); ++k) lower.valuePtr()[k] = matrix.valuePtr()[source[k]];
    }
  };

  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* x = nullptr;  // solution and workspaces of cholmod_solve2
  cholmod_dense* y = nullptr;
  cholmod_dense* e = nullptr;
  std::variant<std::monostate, SupernodalFactor<double>, SupernodalFactor<float>> prepared;
  std::optional<Ordered> ordered;
  bool again = false;  // it has been factorized before

  Data()
  {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    // Nested dissection; the default tries minimum degree first, whose factors of solids are half as large again.
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NESDIS;
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
  // What takes the place of CHOLMOD's solve; the numbers are still there.
  template <class Stored>
  void lay_out()
  {
    try {
      prepared.emplace<SupernodalFactor<Stored>>(*factor);
    } catch (const std::bad_alloc&) {
      common.status = CHOLMOD_OUT_OF_MEMORY;
      check_memory();
    }
  }
  void check_memory() const
  {
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE)
      throw Error(ExitStatus::machine, "out of memory in a sparse factorization; use smaller subdomains or more memory",
                  Error::Cause::memory);
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

// The pattern of the nodes, lower triangle.
SparseMatrix of_nodes(const SparseMatrix& lower, int block)
{
  std::vector<Eigen::Triplet<double>> pairs;
  for (int column = 0; column < lower.outerSize(); column += block)
    for (int c = column; c < column + block; ++c)
      for (SparseMatrix::InnerIterator it(lower, c); it; ++it)
        if (pairs.empty() || pairs.back().col() != column / block || pairs.back().row() != it.row() / block)
          pairs.emplace_back(static_cast<int>(it.row()) / block, column / block, 1.0);
  SparseMatrix result(lower.rows() / block, lower.cols() / block);
  result.setFromTriplets(pairs.begin(), pairs.end());
  return result;
}

}  // namespace

Cholesky::Cholesky(const SparseMatrix& lower, int block) : data_(std::make_unique<Data>())
{
  auto& common = data_->common;
  cholmod_sparse a = wrap(lower);
  if (block == 1 || lower.cols() % block != 0) {
    data_->factor = cholmod_analyze(&a, &common);
  } else {
    const SparseMatrix nodes = of_nodes(lower, block);
    cholmod_sparse graph = wrap(nodes);
    const auto count = static_cast<std::size_t>(nodes.cols()), times = static_cast<std::size_t>(block);
    std::vector<int> order(count), parent(count), member(count), permutation(count * times);
    cholmod_nested_dissection(&graph, nullptr, 0, order.data(), parent.data(), member.data(), &common);
    data_->check_memory();
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < times; ++c) permutation[k * times + c] = order[k] * block + static_cast<int>(c);
    common.method[0].ordering = CHOLMOD_GIVEN;
    data_->factor = cholmod_analyze_p(&a, permutation.data(), nullptr, 0, &common);
  }
  data_->check_memory();
}

Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;
Cholesky::~Cholesky() = default;

bool Cholesky::factorize(const SparseMatrix& lower)
{
  cholmod_sparse a = wrap(lower);
  data_->common.status = CHOLMOD_OK;
  data_->prepared = std::monostate{};
  auto& ordered = data_->ordered;
  if (std::exchange(data_->again, true) && data_->factor->is_super && lower.isCompressed()) {
    if (!ordered || !ordered->fits(lower)) ordered.emplace(lower, static_cast<const int*>(data_->factor->Perm));
    ordered->take(lower);
    a = wrap(ordered->lower);
    a.sorted = 0;
    double nothing[2] = {0, 0};
    cholmod_super_numeric(&a, nullptr, nothing, data_->factor, &data_->common);
  } else {
    cholmod_factorize(&a, data_->factor, &data_->common);
  }
  data_->check_memory();
  return data_->common.status == CHOLMOD_OK && data_->factor->minor == data_->factor->n;
}

void Cholesky::prepare_for_many_solves()
{
  data_->lay_out<double>();
  let_numbers_go();
}

double Cholesky::prepare_in_single_precision(const SparseMatrix& lower, int block, double most)
{
  constexpr int samples = 2;  // that go through the factor together
  constexpr int steps = 2;    // of the power method: one may see a tenth of what thin cells bring
  data_->lay_out<float>();
  const int column_block = has_column_blocks(lower, block) ? block : 1;
  std::minstd_rand random(1);
  Eigen::MatrixXd x(size(), samples);
  for (double& force : x.reshaped()) force = random() % 2 == 0 ? 1 : -1;
  solve(x.data(), x.data(), samples, size());
  const auto times = [&](const Eigen::MatrixXd& u) {
    Eigen::MatrixXd result(size(), samples);
    for (int c = 0; c < samples; ++c) result.col(c) = symmetric_product(lower, column_block, u.col(c));
    return result;
  };
  const auto energy = [](const Eigen::MatrixXd& u, const Eigen::MatrixXd& f) { return u.cwiseProduct(f).colwise().sum().eval(); };
  double largest = 0;
  Eigen::MatrixXd forces = times(x);
  for (int step = 0; step < steps; ++step) {
    const auto before = energy(x, forces);
    solve(forces.data(), forces.data(), samples, size());
    x -= forces;
    forces = times(x);
    const double ratio = std::sqrt((energy(x, forces).array() / before.array()).maxCoeff<Eigen::PropagateNaN>());
    if (!(ratio <= largest)) largest = ratio;  // also what is no number
  }
  if (!(largest <= most)) data_->lay_out<double>();
  let_numbers_go();
  return largest;
}

bool Cholesky::in_single_precision() const
{
  return std::holds_alternative<SupernodalFactor<float>>(data_->prepared);
}

void Cholesky::let_numbers_go()
{
  cholmod_change_factor(CHOLMOD_PATTERN, 1, 1, 1, 1, data_->factor, &data_->common);
  cholmod_free_work(&data_->common);
}

void Cholesky::solve(const double* b, double* x, int columns, int stride) const
{
  if (data_->prepared.index() > 0) {
    std::vector<double*> pointers;
    for (int c = 0; c < columns; ++c) {
      pointers.push_back(x + static_cast<std::ptrdiff_t>(c) * stride);
      if (x != b) std::memcpy(pointers.back(), b + static_cast<std::ptrdiff_t>(c) * stride, data_->factor->n * sizeof(double));
    }
    return solve(pointers);
  }
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

void Cholesky::solve(std::span<double* const> columns) const
{
  if (const auto* tiles = std::get_if<SupernodalFactor<double>>(&data_->prepared)) return tiles->solve(columns);
  if (const auto* tiles = std::get_if<SupernodalFactor<float>>(&data_->prepared)) return tiles->solve(columns);
  for (double* column : columns) solve(column, column, 1, size());
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
  if (const auto* tiles = std::get_if<SupernodalFactor<double>>(&data_->prepared)) return tiles->bytes_in_double();
  if (const auto* tiles = std::get_if<SupernodalFactor<float>>(&data_->prepared)) return tiles->bytes_in_double();
  return data_->factor->xsize * sizeof(double);
}

}  // namespace mortise
