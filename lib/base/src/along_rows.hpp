// Triangular solves on the tiles of a SupernodalFactor for one or two right-hand sides. There are too few to fill a register, so
// that registers go along the rows here: column j of a tile is one register (AVX-512) or two (AVX2), and each number of the
// factor is read once for both right-hand sides. For functions compiled for one of these.
#pragma once

#include "tiles.hpp"

namespace mortise::supernodal {

// The 8 rows of a tile in registers of Lanes numbers. Sums of them are the field's arithmetic, register by register.
template <int Lanes>
struct RowsOfTile {
  static constexpr int parts = tile / Lanes;
  using Memory = Loose<Lanes>;
  using Lane = typename Memory::Lane;
  Lane part[parts];

  [[gnu::always_inline]] void clear()
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) part[p] = Lane{};
  }
  template <class Stored>
  [[gnu::always_inline]] void load(const Stored* from)
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) Memory::load(part[p], from + p * Lanes);
  }
  [[gnu::always_inline]] void store(double* to) const
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) Memory::store(part[p], to + p * Lanes);
  }
  [[gnu::always_inline]] void subtract_at(double* at) const
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) Memory::subtract_at(at + p * Lanes, part[p]);
  }
  [[gnu::always_inline]] void add(const RowsOfTile& other)
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) part[p] += other.part[p];
  }
  [[gnu::always_inline]] void add_product(const RowsOfTile& a, double b)
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) part[p] += a.part[p] * b;
  }
  [[gnu::always_inline]] void add_product(const RowsOfTile& a, const RowsOfTile& b)
  {
#pragma GCC unroll 2
    for (int p = 0; p < parts; ++p) part[p] += a.part[p] * b.part[p];
  }

  // The totals of v[0] .. v[7], in one: neighbours are added, then neighbours of these.
  [[gnu::always_inline]] void add_up(const RowsOfTile* v)
  {
    if constexpr (Lanes == 8) {
      Lane pair[4], four[2];
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k)
        pair[k] = __builtin_shufflevector(v[2 * k].part[0], v[2 * k + 1].part[0], 0, 8, 2, 10, 4, 12, 6, 14) +
                  __builtin_shufflevector(v[2 * k].part[0], v[2 * k + 1].part[0], 1, 9, 3, 11, 5, 13, 7, 15);
#pragma GCC unroll 2
      for (int k = 0; k < 2; ++k)
        four[k] = __builtin_shufflevector(pair[2 * k], pair[2 * k + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
                  __builtin_shufflevector(pair[2 * k], pair[2 * k + 1], 2, 3, 10, 11, 6, 7, 14, 15);
      part[0] = __builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 8, 9, 10, 11) +
                __builtin_shufflevector(four[0], four[1], 4, 5, 6, 7, 12, 13, 14, 15);
    } else {
#pragma GCC unroll 2
      for (int p = 0; p < parts; ++p) {
        Lane both[4], pair[2];
#pragma GCC unroll 4
        for (int k = 0; k < 4; ++k) both[k] = v[4 * p + k].part[0] + v[4 * p + k].part[1];
#pragma GCC unroll 2
        for (int k = 0; k < 2; ++k)
          pair[k] = __builtin_shufflevector(both[2 * k], both[2 * k + 1], 0, 4, 2, 6) +
                    __builtin_shufflevector(both[2 * k], both[2 * k + 1], 1, 5, 3, 7);
        part[p] = __builtin_shufflevector(pair[0], pair[1], 0, 1, 4, 5) + __builtin_shufflevector(pair[0], pair[1], 2, 3, 6, 7);
      }
    }
  }

  // a0 b0 a1 b1 .. in z[0], z[1] <-> a and b.
  [[gnu::always_inline]] static void separate(RowsOfTile (&z)[2])
  {
    if constexpr (Lanes == 8) {
      const Lane first = __builtin_shufflevector(z[0].part[0], z[1].part[0], 0, 2, 4, 6, 8, 10, 12, 14);
      z[1].part[0] = __builtin_shufflevector(z[0].part[0], z[1].part[0], 1, 3, 5, 7, 9, 11, 13, 15);
      z[0].part[0] = first;
    } else {
      const RowsOfTile low = z[0], high = z[1];
      z[0].part[0] = __builtin_shufflevector(low.part[0], low.part[1], 0, 2, 4, 6);
      z[0].part[1] = __builtin_shufflevector(high.part[0], high.part[1], 0, 2, 4, 6);
      z[1].part[0] = __builtin_shufflevector(low.part[0], low.part[1], 1, 3, 5, 7);
      z[1].part[1] = __builtin_shufflevector(high.part[0], high.part[1], 1, 3, 5, 7);
    }
  }
  [[gnu::always_inline]] static void interleave(RowsOfTile (&z)[2])
  {
    if constexpr (Lanes == 8) {
      const Lane first = __builtin_shufflevector(z[0].part[0], z[1].part[0], 0, 8, 1, 9, 2, 10, 3, 11);
      z[1].part[0] = __builtin_shufflevector(z[0].part[0], z[1].part[0], 4, 12, 5, 13, 6, 14, 7, 15);
      z[0].part[0] = first;
    } else {
      const RowsOfTile a = z[0], b = z[1];
      z[0].part[0] = __builtin_shufflevector(a.part[0], b.part[0], 0, 4, 1, 5);
      z[0].part[1] = __builtin_shufflevector(a.part[0], b.part[0], 2, 6, 3, 7);
      z[1].part[0] = __builtin_shufflevector(a.part[1], b.part[1], 0, 4, 1, 5);
      z[1].part[1] = __builtin_shufflevector(a.part[1], b.part[1], 2, 6, 3, 7);
    }
  }
  [[gnu::always_inline]] static void separate(RowsOfTile (&)[1]) {}
  [[gnu::always_inline]] static void interleave(RowsOfTile (&)[1]) {}
};

// Row i of Count right-hand sides starts at y + i * Count.
template <int Count, int Lanes>
struct AlongRows {
  using Rows = RowsOfTile<Lanes>;
  using Diagonal = Tiles<1, Count, 8>;
  // Tiles that share the sums of a column on their way to memory: as many as registers hold.
  static constexpr int together = Lanes == 8 ? 4 : 4 / Count;

  // Most tiles do. Rows rise strictly until the factor's number of rows fills them up, so that the last two tell.
  [[gnu::always_inline]] static bool follow_each_other(const int* rows)
  {
    return rows[tile - 1] - rows[0] == tile - 1 && rows[tile - 2] - rows[0] == tile - 2;
  }

  [[gnu::always_inline]] static void gather(Rows (&z)[Count], const double* y, const int* rows)
  {
    if (follow_each_other(rows)) {
      for (int n = 0; n < Count; ++n) z[n].load(y + static_cast<std::ptrdiff_t>(rows[0]) * Count + n * tile);
    } else {
      alignas(64) double buffer[tile * Count];
      for (int r = 0; r < tile; ++r)
        for (int n = 0; n < Count; ++n) buffer[r * Count + n] = y[static_cast<std::ptrdiff_t>(rows[r]) * Count + n];
      for (int n = 0; n < Count; ++n) z[n].load(buffer + n * tile);
    }
    Rows::separate(z);
  }
  [[gnu::always_inline]] static void scatter(Rows (&z)[Count], double* y, const int* rows)
  {
    Rows::interleave(z);
    if (follow_each_other(rows)) {
      for (int n = 0; n < Count; ++n) z[n].subtract_at(y + static_cast<std::ptrdiff_t>(rows[0]) * Count + n * tile);
    } else {
      alignas(64) double buffer[tile * Count];
      for (int n = 0; n < Count; ++n) z[n].store(buffer + n * tile);
      for (int r = 0; r < tile; ++r)
        for (int n = 0; n < Count; ++n) y[static_cast<std::ptrdiff_t>(rows[r]) * Count + n] -= buffer[r * Count + n];
    }
  }

  // sum = sum_j values[j] x[j]; several sums in turn, for one waits for its last addition.
  template <class Stored>
  [[gnu::always_inline]] static void multiply(const Stored* values, int columns, const double* x, Rows (&sum)[Count])
  {
    constexpr int turns = 4 / Count;
    Rows part[turns][Count], value;
#pragma GCC unroll 4
    for (int k = 0; k < turns; ++k)
#pragma GCC unroll 2
      for (int n = 0; n < Count; ++n) part[k][n].clear();
    int j = 0;
    for (; j + turns <= columns; j += turns)
#pragma GCC unroll 4
      for (int k = 0; k < turns; ++k) {
        value.load(values + (j + k) * tile);
        prefetch(values + (j + k) * tile, bytes_ahead);
#pragma GCC unroll 2
        for (int n = 0; n < Count; ++n) part[k][n].add_product(value, x[(j + k) * Count + n]);
      }
    for (; j < columns; ++j) {
      value.load(values + j * tile);
#pragma GCC unroll 2
      for (int n = 0; n < Count; ++n) part[0][n].add_product(value, x[j * Count + n]);
    }
    for (int n = 0; n < Count; ++n) {
      sum[n] = part[0][n];
      for (int k = 1; k < turns; ++k) sum[n].add(part[k][n]);
    }
  }

  template <class Stored>
  [[gnu::always_inline]] static void forwards(const SupernodalFactor<Stored>& factor, double* y)
  {
    Rows sum[Count];
    for (const auto& piece : factor.pieces()) {
      const Stored* values = factor.values() + piece.value;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * Count;
      for (int b = 0; b < piece.width; b += tile) {
        if (b > 0) {
          multiply(values, b, x, sum);
          Rows::interleave(sum);
          for (int n = 0; n < Count; ++n) sum[n].subtract_at(x + b * Count + n * tile);
        }
        values += b * tile;
        Diagonal::forwards(values, x + b * Count);
        values += diagonal_values;
      }
      const int* below = factor.rows() + piece.row;
      for (int t = 0; t < piece.tiles; ++t, values += piece.width * tile, below += tile) {
        multiply(values, piece.width, x, sum);
        scatter(sum, y, below);
      }
    }
  }

  // sum[j] += values[j] z for `Several` tiles, each `stride` numbers from the next.
  template <int Several, class Stored>
  [[gnu::always_inline]] static void add_products(const Stored* values, int columns, std::ptrdiff_t stride,
                                                  const Rows (&z)[Several][Count], Rows (*sum)[Count])
  {
    for (int j = 0; j < columns; ++j) {
      Rows part[Count], value;
#pragma GCC unroll 2
      for (int n = 0; n < Count; ++n) part[n] = sum[j][n];
#pragma GCC unroll 4
      for (int t = 0; t < Several; ++t) {
        value.load(values + t * stride + j * tile);
        prefetch(values + t * stride + j * tile, -bytes_ahead);
#pragma GCC unroll 2
        for (int n = 0; n < Count; ++n) part[n].add_product(value, z[t][n]);
      }
#pragma GCC unroll 2
      for (int n = 0; n < Count; ++n) sum[j][n] = part[n];
    }
  }

  template <int Several, class Stored>
  [[gnu::always_inline]] static void add_tiles(const Stored*& values, const int*& below, int columns, const double* y,
                                               Rows (*sum)[Count])
  {
    values -= Several * columns * tile;
    below -= Several * tile;
    Rows z[Several][Count];
#pragma GCC unroll 4
    for (int t = 0; t < Several; ++t) gather(z[t], y, below + t * tile);
    add_products<Several>(values, columns, columns * tile, z, sum);
  }

  [[gnu::always_inline]] static void subtract_totals(Rows (*sum)[Count], int columns, double* x)
  {
    for (int k = 0; k < columns * Count; k += tile) {
      Rows total;
      total.add_up(sum[0] + k);
      if (k + tile <= columns * Count) {
        total.subtract_at(x + k);
      } else {
        alignas(64) double buffer[tile];
        total.store(buffer);
        for (int n = k; n < columns * Count; ++n) x[n] -= buffer[n - k];
      }
    }
  }

  template <class Stored>
  [[gnu::always_inline]] static void backwards(const SupernodalFactor<Stored>& factor, double* y)
  {
    for (auto p = factor.pieces().rbegin(); p != factor.pieces().rend(); ++p) {
      const Piece& piece = *p;
      double* x = y + static_cast<std::ptrdiff_t>(piece.first) * Count;
      const Stored* values = factor.values() + piece.value + triangle_values(piece.width) + panel_values(piece);
      const int* below = factor.rows() + piece.row + static_cast<std::ptrdiff_t>(piece.tiles) * tile;
      Rows sum[widest + tile][Count];
      for (int j = 0; j < blocks(piece.width) * tile; ++j)
        for (int n = 0; n < Count; ++n) sum[j][n].clear();
      int t = piece.tiles;
      for (; t >= together; t -= together) add_tiles<together>(values, below, piece.width, y, sum);
      for (; t > 0; --t) add_tiles<1>(values, below, piece.width, y, sum);
      subtract_totals(sum, piece.width, x);
      for (int b = (blocks(piece.width) - 1) * tile; b >= 0; b -= tile) {
        values -= diagonal_values;
        Diagonal::backwards(values, x + b * Count);
        values -= b * tile;
        if (b == 0) break;
        Rows z[1][Count];
        for (int n = 0; n < Count; ++n) z[0][n].load(x + b * Count + n * tile);
        Rows::separate(z[0]);
        for (int j = 0; j < b; ++j)
          for (int n = 0; n < Count; ++n) sum[j][n].clear();
        add_products<1>(values, b, 0, z, sum);
        subtract_totals(sum, b, x);
      }
    }
  }

  template <class Stored>
  [[gnu::always_inline]] static void solve(const SupernodalFactor<Stored>& factor, double* y)
  {
    forwards(factor, y);
    backwards(factor, y);
  }
};

}  // namespace mortise::supernodal
