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
template <class Stored>
struct Kernel {
  int width;
  void (*solve)(const SupernodalFactor<Stored>&, double*);
};

template <class Stored, class Sweep>
void solve_any(const SupernodalFactor<Stored>& factor, double* y)
{
  Sweep::solve(factor, y);
}
#if MORTISE_X86
template <class Stored, class Sweep>
[[gnu::target("avx2,fma")]] void solve_avx2(const SupernodalFactor<Stored>& factor, double* y)
{
  Sweep::solve(factor, y);
}
template <class Stored, class Sweep>
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_avx512(const SupernodalFactor<Stored>& factor, double* y)
{
  Sweep::solve(factor, y);
}
#endif

// From the widest on, for this processor.
template <class Stored>
std::span<const Kernel<Stored>> kernels()
{
  static constexpr Kernel<Stored> any[] = {{8, solve_any<Stored, Tiles<4, 2, 4>>}, {4, solve_any<Stored, Tiles<4, 1, 8>>}};
#if MORTISE_X86
  static constexpr Kernel<Stored> avx512[] = {{16, solve_avx512<Stored, Tiles<8, 2, 8>>},
                                              {8, solve_avx512<Stored, Tiles<8, 1, 8>>},
                                              {4, solve_avx2<Stored, Tiles<4, 1, 8>>},
                                              {2, solve_avx512<Stored, AlongRows<2, 8>>},
                                              {1, solve_avx512<Stored, AlongRows<1, 8>>}};
  static const bool has_avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  if (has_avx512) return avx512;
  static constexpr Kernel<Stored> avx2[] = {{8, solve_avx2<Stored, Tiles<4, 2, 4>>},
                                            {4, solve_avx2<Stored, Tiles<4, 1, 8>>},
                                            {2, solve_avx2<Stored, AlongRows<2, 4>>},
                                            {1, solve_avx2<Stored, AlongRows<1, 4>>}};
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has_avx2) return avx2;
#endif
  return any;
}

// The narrowest that takes all the columns, else the widest: a few idle lanes cost less than reading the factor again.
template <class Stored>
const Kernel<Stored>& kernel_for(std::size_t columns)
{
  const auto all = kernels<Stored>();
  for (auto kernel = all.rbegin(); kernel != all.rend(); ++kernel)
    if (static_cast<std::size_t>(kernel->width) >= columns) return *kernel;
  return all.front();
}

}  // namespace

template <class Stored>
SupernodalFactor<Stored>::SupernodalFactor(const cholmod_factor& factor)
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
  values_ = std::make_unique_for_overwrite<Stored[]>(size_);
  auto piece = pieces_.begin();
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t height = row_start[s + 1] - row_start[s];
    for (int first = super[s]; first < super[s + 1]; first += widest, ++piece) {
      const std::ptrdiff_t above = first - super[s];
      const double* block = numbers + panel_start[s] + above * height + above;  // of the piece, its diagonal first
      Stored* value = values_.get() + piece->value;
      const auto copy = [&](std::ptrdiff_t row, std::ptrdiff_t end, int columns) {
        for (int j = 0; j < columns; ++j, value += tile)
          for (std::ptrdiff_t r = row; r < row + tile; ++r)
            value[r - row] = static_cast<Stored>(r < end ? block[j * height + r] : 0);
      };
      for (int b = 0; b < piece->width; b += tile) {
        copy(b, piece->width, b);
        for (int j = b; j < b + tile; ++j)
          for (int r = j; r < b + tile; ++r, ++value)
            *value = static_cast<Stored>(r == j ? (j < piece->width ? 1 / block[j * height + j] : 1)
                                                : (r < piece->width ? block[j * height + r] : 0));
      }
      for (int t = 0; t < piece->tiles; ++t) copy(piece->width + t * tile, height - above, piece->width);
      // Pieces of a supernode share its list of rows, each from further down.
      piece->row = rows_.size() + static_cast<std::size_t>(above + piece->width);
    }
    rows_.insert(rows_.end(), rows + row_start[s], rows + row_start[s + 1]);
    rows_.insert(rows_.end(), tile - 1, static_cast<int>(factor.n));
  }
}

template <class Stored>
void SupernodalFactor<Stored>::solve(std::span<double* const> columns) const
{
  const std::size_t n = permutation_.size();
  while (!columns.empty()) {
    const auto& kernel = kernel_for<Stored>(columns.size());
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

template class SupernodalFactor<double>;
template class SupernodalFactor<float>;

}  // namespace mortise
