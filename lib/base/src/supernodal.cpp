#include "supernodal.hpp"

#include <algorithm>
#include <cstdint>

#include "along_rows.hpp"
#include "tiles.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define MORTISE_X86 1
#else
#define MORTISE_X86 0
#endif

namespace mortise {

using namespace supernodal;

namespace {

// A kernel solves with `width` right-hand sides interleaved.
struct Kernel {
  int width;
  void (*solve)(const SupernodalFactor&, double*);
};

void solve_4(const SupernodalFactor& factor, double* y)
{
  Tiles<4, 1, 8>::solve(factor, y);
}
void solve_8(const SupernodalFactor& factor, double* y)
{
  Tiles<4, 2, 4>::solve(factor, y);
}
#if MORTISE_X86
[[gnu::target("avx2,fma")]] void solve_8_avx2(const SupernodalFactor& factor, double* y)
{
  Tiles<4, 2, 4>::solve(factor, y);
}
[[gnu::target("avx2,fma")]] void solve_4_avx2(const SupernodalFactor& factor, double* y)
{
  Tiles<4, 1, 8>::solve(factor, y);
}
[[gnu::target("avx2,fma")]] void solve_2_avx2(const SupernodalFactor& factor, double* y)
{
  AlongRows<2, 4>::forwards(factor, y);
  AlongRows<2, 4>::backwards(factor, y);
}
[[gnu::target("avx2,fma")]] void solve_1_avx2(const SupernodalFactor& factor, double* y)
{
  AlongRows<1, 4>::forwards(factor, y);
  AlongRows<1, 4>::backwards(factor, y);
}
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_16_avx512(const SupernodalFactor& factor, double* y)
{
  Tiles<8, 2, 8>::solve(factor, y);
}
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_8_avx512(const SupernodalFactor& factor, double* y)
{
  Tiles<8, 1, 8>::solve(factor, y);
}
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_2_avx512(const SupernodalFactor& factor, double* y)
{
  AlongRows<2, 8>::forwards(factor, y);
  AlongRows<2, 8>::backwards(factor, y);
}
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_1_avx512(const SupernodalFactor& factor, double* y)
{
  AlongRows<1, 8>::forwards(factor, y);
  AlongRows<1, 8>::backwards(factor, y);
}
#endif

// From the widest on, for this processor.
std::span<const Kernel> kernels()
{
  static constexpr Kernel any[] = {{8, solve_8}, {4, solve_4}};
#if MORTISE_X86
  static constexpr Kernel avx512[] = {
      {16, solve_16_avx512}, {8, solve_8_avx512}, {4, solve_4_avx2}, {2, solve_2_avx512}, {1, solve_1_avx512}};
  static const bool has_avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  if (has_avx512) return avx512;
  static constexpr Kernel avx2[] = {{8, solve_8_avx2}, {4, solve_4_avx2}, {2, solve_2_avx2}, {1, solve_1_avx2}};
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has_avx2) return avx2;
#endif
  return any;
}

// The narrowest that takes all the columns, else the widest: a few idle lanes cost less than reading the factor again.
const Kernel& kernel_for(std::size_t columns)
{
  const auto all = kernels();
  for (auto kernel = all.rbegin(); kernel != all.rend(); ++kernel)
    if (static_cast<std::size_t>(kernel->width) >= columns) return *kernel;
  return all.front();
}

}  // namespace

SupernodalFactor::SupernodalFactor(const cholmod_factor& factor)
{
  const auto* super = static_cast<const int*>(factor.super);
  const auto* row_start = static_cast<const int*>(factor.pi);
  const auto* panel_start = static_cast<const int*>(factor.px);
  const auto* rows = static_cast<const int*>(factor.s);
  const auto* numbers = static_cast<const double*>(factor.x);
  const auto* permutation = static_cast<const int*>(factor.Perm);
  permutation_.assign(permutation, permutation + factor.n);
  for (std::size_t s = 0; s < factor.nsuper; ++s)
    for (int first = super[s]; first < super[s + 1]; first += widest) {
      const int width = std::min(widest, super[s + 1] - first);
      const int height = row_start[s + 1] - row_start[s] - (first - super[s]) - width;
      pieces_.push_back({first, width, blocks(height), 0, size_});
      size_ += triangle_values(width) + panel_values(pieces_.back());
    }
  values_ = std::make_unique_for_overwrite<double[]>(size_);
  auto piece = pieces_.begin();
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t height = row_start[s + 1] - row_start[s];
    for (int first = super[s]; first < super[s + 1]; first += widest, ++piece) {
      const std::ptrdiff_t above = first - super[s];
      const double* block = numbers + panel_start[s] + above * height + above;  // of the piece, its diagonal first
      double* value = values_.get() + piece->value;
      const auto copy = [&](std::ptrdiff_t row, std::ptrdiff_t end, int columns) {
        for (int j = 0; j < columns; ++j, value += tile)
          for (std::ptrdiff_t r = row; r < row + tile; ++r) value[r - row] = r < end ? block[j * height + r] : 0;
      };
      for (int b = 0; b < piece->width; b += tile) {
        copy(b, piece->width, b);
        for (int j = b; j < b + tile; ++j)
          for (int r = j; r < b + tile; ++r, ++value)
            *value = r == j ? (j < piece->width ? 1 / block[j * height + j] : 1) : (r < piece->width ? block[j * height + r] : 0);
      }
      for (int t = 0; t < piece->tiles; ++t) copy(piece->width + t * tile, height - above, piece->width);
      // Pieces of a supernode share its list of rows, each from further down.
      piece->row = rows_.size() + static_cast<std::size_t>(above + piece->width);
    }
    rows_.insert(rows_.end(), rows + row_start[s], rows + row_start[s + 1]);
    rows_.insert(rows_.end(), tile - 1, static_cast<int>(factor.n));
  }
}

void SupernodalFactor::solve(std::span<double* const> columns) const
{
  const std::size_t n = permutation_.size();
  while (!columns.empty()) {
    const Kernel& kernel = kernel_for(columns.size());
    const auto width = static_cast<std::size_t>(kernel.width), used = std::min(width, columns.size());
    constexpr std::size_t line = 64 / sizeof(double);
    work_.assign((n + tile) * width + line, 0);
    const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(work_.data()) / sizeof(double) % line;
    double* y = work_.data() + (line - misaligned) % line;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t c = 0; c < used; ++c) y[k * width + c] = columns[c][permutation_[k]];
    kernel.solve(*this, y);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t c = 0; c < used; ++c) columns[c][permutation_[k]] = y[k * width + c];
    columns = columns.subspan(used);
  }
}

}  // namespace mortise
