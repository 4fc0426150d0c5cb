// Triangular solves on the tiles of a SupernodalFactor for many right-hand sides at a time, interleaved: row i of them starts at
// y + i * count. A register holds what several right-hand sides have in one row; the numbers of the factor are broadcast. Those
// in single precision are widened tile by tile.
//
// Vectors wider than the processor's own go through memory operation by operation (GCC keeps no such vector in registers), which
// costs a factor of three: what has 8 lanes is for functions compiled for AVX-512.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "supernodal.hpp"

namespace mortise::supernodal {

constexpr int widest = 32;
constexpr int tile = TilesOfFactor::tile;
using Piece = TilesOfFactor::Piece;

// Of the triangle's block of rows number b: b tiles of 8 columns, then the diagonal one, packed by columns.
constexpr int diagonal_values = tile * (tile + 1) / 2;

inline int blocks(int width)
{
  return (width + tile - 1) / tile;
}

inline std::size_t triangle_values(int width)
{
  std::size_t size = 0;
  for (int b = 0; b < blocks(width); ++b) size += static_cast<std::size_t>(b * tile * tile + diagonal_values);
  return size;
}

inline std::size_t panel_values(const Piece& piece)
{
  return static_cast<std::size_t>(piece.tiles) * static_cast<std::size_t>(piece.width * tile);
}

// The factor is read from the first number to the last, and back: what comes so much later is asked for. Hardware looks no
// further than a page, and not at all behind pages that it has not seen; a sweep takes a third to a half less time.
constexpr std::ptrdiff_t bytes_ahead = 8192;

template <class Stored>
[[gnu::always_inline]] inline void prefetch(const Stored* values, std::ptrdiff_t ahead)
{
  __builtin_prefetch(reinterpret_cast<const char*>(values) + ahead);
}

// Vectors of doubles at any address: a reference to such a vector forgets, with some compilers, that it need not be aligned.
template <int Lanes>
struct Loose {
  typedef double Lane __attribute__((vector_size(Lanes * sizeof(double))));
  typedef float Narrow __attribute__((vector_size(Lanes * sizeof(float))));
  struct [[gnu::packed, gnu::may_alias]] Unaligned { Lane lane; };
  struct [[gnu::packed, gnu::may_alias]] UnalignedNarrow { Narrow lane; };
  [[gnu::always_inline]] static void load(Lane& lane, const double* from)
  {
    lane = reinterpret_cast<const Unaligned*>(from)->lane;
  }
  [[gnu::always_inline]] static void load(Lane& lane, const float* from)
  {
    lane = __builtin_convertvector(reinterpret_cast<const UnalignedNarrow*>(from)->lane, Lane);
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

  // Tiles of `columns` columns as doubles: where they are, or in a buffer. What is broadcast from there comes at no cost.
  struct Widened {
    alignas(64) double values[widest * tile];
  };
  // `ahead`: bytes, of what is asked for from memory.
  template <class Stored>
  [[gnu::always_inline]] static const double* widened(const Stored* values, int columns, std::ptrdiff_t ahead, Widened& buffer)
  {
    constexpr int line = 64 / sizeof(Stored);
    for (int k = 0; k < columns * tile; k += line) prefetch(values + k, ahead);
    if constexpr (std::is_same_v<Stored, double>) {
      return values;
    } else {
      constexpr int step = std::max(Lanes, 4);
      for (int k = 0; k < columns * tile; k += step) {
        typename Loose<step>::Lane lane;
        Loose<step>::load(lane, values + k);
        Loose<step>::store(lane, buffer.values + k);
      }
      return buffer.values;
    }
  }

  // y[target(r)] -= sum_j values[j][r] x[j] for the 8 rows r.
  template <class Stored, class Target>
  [[gnu::always_inline]] static void subtract(const Stored* stored, int columns, double* x, double* y, const Target& target)
  {
    Widened buffer;
    const double* const values = widened(stored, columns, bytes_ahead, buffer);
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
  template <class Stored, class Source>
  [[gnu::always_inline]] static void subtract_transpose(const Stored* stored, int columns, double* x, double* y,
                                                        const Source& source)
  {
    Widened buffer;
    const double* const values = widened(stored, columns, -bytes_ahead, buffer);
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

  template <class Stored>
  [[gnu::always_inline]] static void forwards(const Stored* values, double* x)
  {
    for (int j = 0; j < tile; ++j) {
      Lane xj[Registers];
      for (int n = 0; n < Registers; ++n) {
        Memory::load(xj[n], at(x, j, n));
        xj[n] *= double{*values};
        Memory::store(xj[n], at(x, j, n));
      }
      ++values;
      for (int i = j + 1; i < tile; ++i, ++values)
        for (int n = 0; n < Registers; ++n) {
          const Lane part = double{*values} * xj[n];
          Memory::subtract_at(at(x, i, n), part);
        }
    }
  }

  template <class Stored>
  [[gnu::always_inline]] static void backwards(const Stored* values, double* x)
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
          xj[n] -= double{values[i - j]} * xi;
        }
      for (int n = 0; n < Registers; ++n) {
        xj[n] *= double{*values};
        Memory::store(xj[n], at(x, j, n));
      }
    }
  }

  template <class Stored>
  [[gnu::always_inline]] static void solve(const SupernodalFactor<Stored>& factor, double* y)
  {
    for (const auto& piece : factor.pieces()) {
      const Stored* values = factor.values() + piece.value;
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
      const Stored* values = factor.values() + piece.value + triangle_values(piece.width) + panel_values(piece);
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

}  // namespace mortise::supernodal
