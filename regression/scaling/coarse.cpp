// What the coarse problem of a cube of n x n x n cubic subdomains costs each rank: the Cholesky factor of G G', 6 kernels a
// subdomain.
//
//     coarse N... | regression/page_tables.py regression/scaling/README.md coarse
//
// G G' is that of unit gluing: subdomains that share a face, an edge or a corner are joined. Its pattern is the real one; the
// values are some positive definite matrix of it, for costs depend on the pattern alone.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "base/cholesky.hpp"

namespace {

using namespace mortise;

constexpr int kernels = 6;

// Lower triangle.
SparseMatrix coarse_matrix(int n)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto number = [n](int i, int j, int k) { return (i * n + j) * n + k; };
  const auto join = [&](int row, int column) {
    for (int a = 0; a < kernels; ++a)
      for (int b = 0; b < (row == column ? a + 1 : kernels); ++b)
        entries.emplace_back(row * kernels + a, column * kernels + b, row == column && a == b ? 27.0 * kernels : -0.5);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, n - 1); ++a)
          for (int b = std::max(j - 1, 0); b <= std::min(j + 1, n - 1); ++b)
            for (int c = std::max(k - 1, 0); c <= std::min(k + 1, n - 1); ++c)
              if (number(a, b, c) >= number(i, j, k)) join(number(a, b, c), number(i, j, k));
  const int size = kernels * n * n * n;
  SparseMatrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

double seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv)
{
  std::printf(
      "| subdomains | entries of the factor | MB | analysis s | factorization s | solution ms |\n|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) {
    const int n = std::atoi(argv[i]);
    if (n < 1 || n > 100) {
      std::fprintf(stderr, "coarse: \"%s\" is not a number of subdomains along an edge from 1 to 100\n", argv[i]);
      return 1;
    }
    const SparseMatrix matrix = coarse_matrix(n);
    const double start = seconds();
    Cholesky factor(matrix);
    const double analysed = seconds();
    if (!factor.factorize(matrix)) return 1;
    const double factorized = seconds();
    constexpr int solutions = 5;
    Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.rows());
    for (int s = 0; s < solutions; ++s) x = factor.solve(x);
    const double solved = seconds();
    std::printf("| %d | %.1e | %.0f | %.2f | %.2f | %.1f |\n", n * n * n,
                static_cast<double>(factor.factor_bytes()) / sizeof(double), static_cast<double>(factor.factor_bytes()) / 1e6,
                analysed - start, factorized - analysed, 1e3 * (solved - factorized) / solutions);
    std::fflush(stdout);
  }
}
