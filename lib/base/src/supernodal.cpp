#include "supernodal.hpp"

#include <algorithm>
#include <cstdint>

#if defined(__x86_64__) && defined(__GNUC__)
#define MORTISE_AVX512 1
#else
#define MORTISE_AVX512 0
#endif

namespace mortise {

namespace {

constexpr int widest = 32;
constexpr int tile = SupernodalFactor::tile;
using Piece = SupernodalFactor::Piece;

// Of the triangle's block of rows number b: b tiles of 8 columns, then the diagonal one, packed by columns.
constexpr int diagonal_values = tile * (tile + 1) / 2;

int blocks(int width)
{
  return (width + tile - 1) / tile;
}

std::size_t triangle_values(int width)
{
  std::size_t size = 0;
  for (int b = 0; b < blocks(width); ++b) size += static_cast<std::size_t>(b * tile * tile + diagonal_values);
  return size;
}

std::size_t panel_values(const Piece& piece)
{
  return static_cast<std::size_t>(piece.tiles) * static_cast<std::size_t>(piece.width * tile);
}

// Vectors of doubles at any address: a reference to such a vector forgets, with some compilers, that it need not be aligned.
template <int Lanes>
struct Loose {
  typedef double Lane __attribute__((vector_size(Lanes * sizeof(double))));
  struct [[gnu::packed, gnu::may_alias]] Unaligned { Lane lane; };
  [[gnu::always_inline]] static void load(Lane& lane, const double* from)
  {
    lane = reinterpret_cast<const Unaligned*>(from)->lane;
  }
  [[gnu::always_inline]] static void store(const Lane& lane, double* to) { reinterpret_cast<Unaligned*>(to)->lane = lane; }
  [[gnu::always_inline]] static void subtract_at(double* at, const Lane& lane)
  {
    Lane value;
    load(value, at);
    value -= lane;
    store(value, at);
  }
};

// Arithmetic on tiles for Registers x Lanes right-hand sides, whose row i starts at y + i * count. Group rows of a tile at a
// time: their sums, Group * Registers, must fit in registers. Everything is inlined into functions for one processor.
template <int Lanes, int Registers, int Group>
struct Tiles {
  static constexpr int count = Lanes * Registers;
  using Memory = Loose<Lanes>;
  using Lane = typename Memory::Lane;

  [[gnu::always_inline]] static double* at(double* y, std::ptrdiff_t row, int n) { return y + row * count + n * Lanes; }

  // y[target(r)] -= sum_j values[j][r] x[j] for the 8 rows r.
  template <class Target>
  [[gnu::always_inline]] static void subtract(const double* values, int columns, double* x, double* y, const Target& target)
  {
#pragma GCC unroll 2
    for (int g = 0; g < tile; g += Group) {
      Lane sum[Group][Registers];
#pragma GCC unroll 8
      for (int r = 0; r < Group; ++r)
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) sum[r][n] = Lane{};
      const double* value = values + g;
      for (int j = 0; j < columns; ++j, value += tile) {
        Lane xj[Registers];
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) Memory::load(xj[n], at(x, j, n));
#pragma GCC unroll 8
        for (int r = 0; r < Group; ++r)
#pragma GCC unroll 2
          for (int n = 0; n < Registers; ++n) sum[r][n] += value[r] * xj[n];
      }
#pragma GCC unroll 8
      for (int r = 0; r < Group; ++r)
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) Memory::subtract_at(at(y, target(g + r), n), sum[r][n]);
    }
  }

  // x[j] -= sum_r values[j][r] y[source(r)].
  template <class Source>
  [[gnu::always_inline]] static void subtract_transpose(const double* values, int columns, double* x, double* y,
                                                        const Source& source)
  {
#pragma GCC unroll 2
    for (int g = 0; g < tile; g += Group) {
      Lane z[Group][Registers];
#pragma GCC unroll 8
      for (int r = 0; r < Group; ++r)
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) Memory::load(z[r][n], at(y, source(g + r), n));
      const double* value = values + g;
      for (int j = 0; j < columns; ++j, value += tile) {
        Lane xj[Registers];
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) Memory::load(xj[n], at(x, j, n));
#pragma GCC unroll 8
        for (int r = 0; r < Group; ++r)
#pragma GCC unroll 2
          for (int n = 0; n < Registers; ++n) xj[n] -= value[r] * z[r][n];
#pragma GCC unroll 2
        for (int n = 0; n < Registers; ++n) Memory::store(xj[n], at(x, j, n));
      }
    }
  }

  [[gnu::always_inline]] static void forwards(const double* values, double* x)
  {
    for (int j = 0; j < tile; ++j) {
      Lane xj[Registers];
      for (int n = 0; n < Registers; ++n) {
        Memory::load(xj[n], at(x, j, n));
        xj[n] *= *values;
        Memory::store(xj[n], at(x, j, n));
      }
      ++values;
      for (int i = j + 1; i < tile; ++i, ++values)
        for (int n = 0; n < Registers; ++n) {
          const Lane part = *values * xj[n];
          Memory::subtract_at(at(x, i, n), part);
        }
    }
  }

  [[gnu::always_inline]] static void backwards(const double* values, double* x)
  {
    values += diagonal_values;
    for (int j = tile - 1; j >= 0; --j) {
      values -= tile - j;
      Lane xj[Registers];
      for (int n = 0; n < Registers; ++n) Memory::load(xj[n], at(x, j, n));
      for (int i = j + 1; i < tile; ++i)
        for (int n = 0; n < Registers; ++n) {
          Lane xi;
          Memory::load(xi, at(x, i, n));
          xj[n] -= values[i - j] * xi;
        }
      for (int n = 0; n < Registers; ++n) {
        xj[n] *= *values;
        Memory::store(xj[n], at(x, j, n));
      }
    }
  }

  [[gnu::always_inline]] static void solve(const SupernodalFactor& factor, double* y)
  {
    for (const auto& piece : factor.pieces()) {
      const double* values = factor.values() + piece.value;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * count;
      for (int b = 0; b < piece.width; b += tile) {
        subtract(values, b, x, x, [b](int r) { return b + r; });
        values += b * tile;
        forwards(values, x + b * count);
        values += diagonal_values;
      }
      const int* below = factor.rows() + piece.row;
      for (int t = 0; t < piece.tiles; ++t, values += piece.width * tile, below += tile)
        subtract(values, piece.width, x, y, [below](int r) { return below[r]; });
    }
    for (auto p = factor.pieces().rbegin(); p != factor.pieces().rend(); ++p) {
      const Piece& piece = *p;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * count;
      const double* values = factor.values() + piece.value + triangle_values(piece.width) + panel_values(piece);
      const int* below = factor.rows() + piece.row + static_cast<std::ptrdiff_t>(piece.tiles) * tile;
      for (int t = 0; t < piece.tiles; ++t) {
        values -= piece.width * tile;
        below -= tile;
        subtract_transpose(values, piece.width, x, y, [below](int r) { return below[r]; });
      }
      for (int b = (blocks(piece.width) - 1) * tile; b >= 0; b -= tile) {
        values -= diagonal_values;
        backwards(values, x + b * count);
        values -= b * tile;
        subtract_transpose(values, b, x, x, [b](int r) { return b + r; });
      }
    }
  }
};

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
#if MORTISE_AVX512
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_16_avx512(const SupernodalFactor& factor, double* y)
{
  Tiles<8, 2, 8>::solve(factor, y);
}
[[gnu::target("avx512f,avx512vl,avx512dq,fma")]] void solve_8_avx512(const SupernodalFactor& factor, double* y)
{
  Tiles<8, 1, 8>::solve(factor, y);
}
#endif

// A few right-hand sides, row i of which starts at y + i * Count; registers along the rows, so that each number of the factor is
// read once for all of them.
template <int Count>
struct AlongRows {
  using Memory = Loose<tile>;
  using Rows = Memory::Lane;

  [[gnu::always_inline]] static double total(const Rows& v)
  {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
  }

  // y[target(r)] -= sum_j values[j][r] x[j] for the 8 rows r; two sums in turn, for one waits for its last addition.
  template <class Target>
  [[gnu::always_inline]] static void subtract(const double* values, int columns, const double* x, double* y, const Target& target)
  {
    Rows even[Count] = {}, odd[Count] = {}, value;
    int j = 0;
    for (; j + 1 < columns; j += 2) {
      Memory::load(value, values + j * tile);
      for (int n = 0; n < Count; ++n) even[n] += value * x[j * Count + n];
      Memory::load(value, values + (j + 1) * tile);
      for (int n = 0; n < Count; ++n) odd[n] += value * x[(j + 1) * Count + n];
    }
    if (j < columns) {
      Memory::load(value, values + j * tile);
      for (int n = 0; n < Count; ++n) even[n] += value * x[j * Count + n];
    }
    for (int n = 0; n < Count; ++n) even[n] += odd[n];
    for (int r = 0; r < tile; ++r)
      for (int n = 0; n < Count; ++n) y[target(r) * Count + n] -= even[n][r];
  }

  [[gnu::always_inline]] static void forwards(const SupernodalFactor& factor, double* y)
  {
    for (const auto& piece : factor.pieces()) {
      const double* values = factor.values() + piece.value;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * Count;
      for (int b = 0; b < piece.width; b += tile) {
        subtract(values, b, x, x, [b](int r) { return b + r; });
        values += b * tile;
        Tiles<1, Count, 8>::forwards(values, x + b * Count);
        values += diagonal_values;
      }
      const int* below = factor.rows() + piece.row;
      for (int t = 0; t < piece.tiles; ++t, values += piece.width * tile, below += tile)
        subtract(values, piece.width, x, y, [below](int r) { return static_cast<std::ptrdiff_t>(below[r]); });
    }
  }

  // z[n][r] = y[source(r)].
  template <class Source>
  [[gnu::always_inline]] static void gather(Rows (&z)[Count], const double* y, const Source& source)
  {
    for (int r = 0; r < tile; ++r)
      for (int n = 0; n < Count; ++n) z[n][r] = y[source(r) * Count + n];
  }

  [[gnu::always_inline]] static void backwards(const SupernodalFactor& factor, double* y)
  {
    for (auto p = factor.pieces().rbegin(); p != factor.pieces().rend(); ++p) {
      const Piece& piece = *p;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * Count;
      const double* values = factor.values() + piece.value + triangle_values(piece.width) + panel_values(piece);
      const int* below = factor.rows() + piece.row + static_cast<std::ptrdiff_t>(piece.tiles) * tile;
      Rows sum[widest][Count] = {}, z[Count], value;
      for (int t = 0; t < piece.tiles; ++t) {
        values -= piece.width * tile;
        below -= tile;
        gather(z, y, [below](int r) { return static_cast<std::ptrdiff_t>(below[r]); });
        for (int j = 0; j < piece.width; ++j) {
          Memory::load(value, values + j * tile);
          for (int n = 0; n < Count; ++n) sum[j][n] += value * z[n];
        }
      }
      for (int j = 0; j < piece.width; ++j)
        for (int n = 0; n < Count; ++n) x[j * Count + n] -= total(sum[j][n]);
      for (int b = (blocks(piece.width) - 1) * tile; b >= 0; b -= tile) {
        values -= diagonal_values;
        Tiles<1, Count, 8>::backwards(values, x + b * Count);
        values -= b * tile;
        gather(z, x, [b](int r) { return b + r; });
        for (int j = 0; j < b; ++j) {
          Memory::load(value, values + j * tile);
          for (int n = 0; n < Count; ++n) x[j * Count + n] -= total(value * z[n]);
        }
      }
    }
  }
};

template <int Count>
void solve_few(const SupernodalFactor& factor, double* y)
{
  AlongRows<Count>::forwards(factor, y);
  AlongRows<Count>::backwards(factor, y);
}

// From the widest on, for this processor.
std::span<const Kernel> kernels()
{
  static constexpr Kernel any[] = {{8, solve_8}, {4, solve_4}, {2, solve_few<2>}, {1, solve_few<1>}};
#if MORTISE_AVX512
  static constexpr Kernel avx512[] = {
      {16, solve_16_avx512}, {8, solve_8_avx512}, {4, solve_4}, {2, solve_few<2>}, {1, solve_few<1>}};
  static const bool has_avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  if (has_avx512) return avx512;
#endif
  return any;
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
  std::size_t size = 0;
  for (std::size_t s = 0; s < factor.nsuper; ++s)
    for (int first = super[s]; first < super[s + 1]; first += widest) {
      const int width = std::min(widest, super[s + 1] - first);
      const int height = row_start[s + 1] - row_start[s] - (first - super[s]) - width;
      pieces_.push_back({first, width, blocks(height), 0, size});
      size += triangle_values(width) + panel_values(pieces_.back());
    }
  values_.assign(size, 0);
  auto piece = pieces_.begin();
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t height = row_start[s + 1] - row_start[s];
    for (int first = super[s]; first < super[s + 1]; first += widest, ++piece) {
      const std::ptrdiff_t above = first - super[s];
      const double* block = numbers + panel_start[s] + above * height + above;  // of the piece, its diagonal first
      double* value = values_.data() + piece->value;
      const auto copy = [&](std::ptrdiff_t row, std::ptrdiff_t end, int columns) {
        for (int j = 0; j < columns; ++j, value += tile)
          for (std::ptrdiff_t r = row; r < std::min(row + tile, end); ++r) value[r - row] = block[j * height + r];
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
  for (const Kernel& kernel : kernels()) {
    const auto width = static_cast<std::size_t>(kernel.width);
    constexpr std::size_t line = 64 / sizeof(double);
    if (columns.size() < width) continue;
    work_.assign((n + tile) * width + line, 0);
    const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(work_.data()) / sizeof(double) % line;
    double* y = work_.data() + (line - misaligned) % line;
    for (; columns.size() >= width; columns = columns.subspan(width)) {
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t c = 0; c < width; ++c) y[k * width + c] = columns[c][permutation_[k]];
      kernel.solve(*this, y);
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t c = 0; c < width; ++c) columns[c][permutation_[k]] = y[k * width + c];
    }
  }
}

}  // namespace mortise
