#include "supernodal.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace mortise {

namespace {

constexpr int widest = 32;

// The same row of several right-hand sides.
template <int Width>
using Row = Eigen::Array<double, Width, 1>;

template <int Width>
Eigen::Map<Row<Width>> row(double* block, int i)
{
  return Eigen::Map<Row<Width>>(block + static_cast<std::ptrdiff_t>(i) * Width);
}

}  // namespace

SupernodalFactor::SupernodalFactor(const cholmod_factor& factor)
{
  const auto* super = static_cast<const int*>(factor.super);
  const auto* row_start = static_cast<const int*>(factor.pi);
  const auto* panel_start = static_cast<const int*>(factor.px);
  const auto* rows = static_cast<const int*>(factor.s);
  const auto* values = static_cast<const double*>(factor.x);
  const auto* permutation = static_cast<const int*>(factor.Perm);
  permutation_.assign(permutation, permutation + factor.n);
  std::size_t size = 0;
  for (std::size_t s = 0; s < factor.nsuper; ++s)
    for (int first = super[s]; first < super[s + 1]; first += widest) {
      const int width = std::min(widest, super[s + 1] - first);
      const int height = row_start[s + 1] - row_start[s] - (first - super[s]) - width;
      pieces_.push_back({first, width, height, 0, size});
      size +=
          static_cast<std::size_t>(width * (width + 1) / 2) + static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      tallest_ = std::max(tallest_, height);
    }
  values_.reserve(size);
  auto piece = pieces_.begin();
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t height = row_start[s + 1] - row_start[s];
    for (int first = super[s]; first < super[s + 1]; first += widest, ++piece) {
      const std::ptrdiff_t above = first - super[s];
      const double* block = values + panel_start[s] + above * height + above;  // of the piece, its diagonal first
      for (int j = 0; j < piece->width; ++j) {
        values_.push_back(1 / block[j * height + j]);
        values_.insert(values_.end(), block + j * height + j + 1, block + j * height + piece->width);
      }
      for (int j = 0; j < piece->width; ++j)
        values_.insert(values_.end(), block + j * height + piece->width, block + j * height + piece->width + piece->height);
      // Pieces of a supernode share its list of rows, each from further down.
      piece->row = rows_.size() + static_cast<std::size_t>(above + piece->width);
    }
    rows_.insert(rows_.end(), rows + row_start[s], rows + row_start[s + 1]);
  }
}

void SupernodalFactor::solve(const double* b, double* x, int columns, int stride) const
{
  int done = 0;
  const auto in_blocks = [&](auto width) {
    for (; columns - done >= width; done += width)
      solve_block<width>(b + static_cast<std::ptrdiff_t>(done) * stride, x + static_cast<std::ptrdiff_t>(done) * stride, stride);
  };
  in_blocks(std::integral_constant<int, 8>());
  in_blocks(std::integral_constant<int, 4>());
  if (done < columns)
    solve_few(b + static_cast<std::ptrdiff_t>(done) * stride, x + static_cast<std::ptrdiff_t>(done) * stride, columns - done,
              stride);
}

template <int Width>
void SupernodalFactor::solve_block(const double* b, double* x, int stride) const
{
  constexpr int tile = 4;  // rows or columns of a panel at a time: as many sums as registers hold
  const auto n = static_cast<std::ptrdiff_t>(permutation_.size());
  work_.resize(static_cast<std::size_t>((n + tallest_) * Width));
  double* y = work_.data();
  double* gathered = y + n * Width;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    for (int c = 0; c < Width; ++c)
      y[k * Width + c] = b[permutation_[static_cast<std::size_t>(k)] + c * static_cast<std::ptrdiff_t>(stride)];

  for (const auto& piece : pieces_) {
    const double* value = values_.data() + piece.value;
    const int* below = rows_.data() + piece.row;
    double* x1 = y + static_cast<std::ptrdiff_t>(piece.first) * Width;
    for (int j = 0; j < piece.width; ++j) {
      const Row<Width> xj = *value++ * row<Width>(x1, j);
      row<Width>(x1, j) = xj;
      for (int i = j + 1; i < piece.width; ++i) row<Width>(x1, i) -= *value++ * xj;
    }
    const auto subtract = [&](int i, auto count) {
      Row<Width> sum[tile];
      for (int r = 0; r < count; ++r) sum[r].setZero();
      const double* p = value + i;
      for (int j = 0; j < piece.width; ++j, p += piece.height) {
        const Row<Width> xj = row<Width>(x1, j);
        for (int r = 0; r < count; ++r) sum[r] += p[r] * xj;
      }
      for (int r = 0; r < count; ++r) row<Width>(y, below[i + r]) -= sum[r];
    };
    int i = 0;
    for (; i + tile <= piece.height; i += tile) subtract(i, std::integral_constant<int, tile>());
    if (i < piece.height) subtract(i, piece.height - i);
  }

  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    const double* panel = values_.data() + piece->value + piece->width * (piece->width + 1) / 2;
    const int* below = rows_.data() + piece->row;
    double* x1 = y + static_cast<std::ptrdiff_t>(piece->first) * Width;
    for (int i = 0; i < piece->height; ++i) row<Width>(gathered, i) = row<Width>(y, below[i]);
    const auto subtract = [&](int j, auto count) {
      Row<Width> sum[tile];
      for (int r = 0; r < count; ++r) sum[r].setZero();
      const double* p = panel + static_cast<std::ptrdiff_t>(j) * piece->height;
      for (int i = 0; i < piece->height; ++i) {
        const Row<Width> zi = row<Width>(gathered, i);
        for (int r = 0; r < count; ++r) sum[r] += p[static_cast<std::ptrdiff_t>(r) * piece->height + i] * zi;
      }
      for (int r = 0; r < count; ++r) row<Width>(x1, j + r) -= sum[r];
    };
    int j = 0;
    for (; j + tile <= piece->width; j += tile) subtract(j, std::integral_constant<int, tile>());
    if (j < piece->width) subtract(j, piece->width - j);
    const double* value = panel;
    for (j = piece->width - 1; j >= 0; --j) {
      value -= piece->width - j;
      Row<Width> xj = row<Width>(x1, j);
      for (int i = j + 1; i < piece->width; ++i) xj -= value[i - j] * row<Width>(x1, i);
      row<Width>(x1, j) = *value * xj;
    }
  }
  for (std::ptrdiff_t k = 0; k < n; ++k)
    for (int c = 0; c < Width; ++c)
      x[permutation_[static_cast<std::size_t>(k)] + c * static_cast<std::ptrdiff_t>(stride)] = y[k * Width + c];
}

// Column after column on each piece, so that it comes from memory once.
void SupernodalFactor::solve_few(const double* b, double* x, int columns, int stride) const
{
  using Column = Eigen::Map<Eigen::VectorXd>;
  using Part = Eigen::Map<const Eigen::VectorXd>;
  using Panel = Eigen::Map<const Eigen::MatrixXd>;
  const auto n = static_cast<std::ptrdiff_t>(permutation_.size());
  work_.resize(static_cast<std::size_t>(n * columns + tallest_));
  double* y = work_.data();
  double* gathered = y + n * columns;
  for (int c = 0; c < columns; ++c)
    for (std::ptrdiff_t k = 0; k < n; ++k)
      y[c * n + k] = b[permutation_[static_cast<std::size_t>(k)] + c * static_cast<std::ptrdiff_t>(stride)];
  for (const auto& piece : pieces_) {
    const double* triangle = values_.data() + piece.value;
    const Panel panel(triangle + piece.width * (piece.width + 1) / 2, piece.height, piece.width);
    const int* below = rows_.data() + piece.row;
    for (int c = 0; c < columns; ++c) {
      double* column = y + c * n;
      double* x1 = column + piece.first;
      const double* value = triangle;
      for (int j = 0; j < piece.width; ++j) {
        x1[j] *= *value++;
        const int rest = piece.width - j - 1;
        Column(x1 + j + 1, rest) -= x1[j] * Part(value, rest);
        value += rest;
      }
      Column product(gathered, piece.height);
      product.noalias() = panel * Column(x1, piece.width);
      for (int i = 0; i < piece.height; ++i) column[below[i]] -= product[i];
    }
  }
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    const Panel panel(values_.data() + piece->value + piece->width * (piece->width + 1) / 2, piece->height, piece->width);
    const int* below = rows_.data() + piece->row;
    for (int c = 0; c < columns; ++c) {
      double* column = y + c * n;
      double* x1 = column + piece->first;
      for (int i = 0; i < piece->height; ++i) gathered[i] = column[below[i]];
      Column(x1, piece->width).noalias() -= panel.transpose() * Column(gathered, piece->height);
      const double* value = panel.data();
      for (int j = piece->width - 1; j >= 0; --j) {
        const int rest = piece->width - j - 1;
        value -= rest + 1;
        x1[j] = *value * (x1[j] - Part(value + 1, rest).dot(Column(x1 + j + 1, rest)));
      }
    }
  }
  for (int c = 0; c < columns; ++c)
    for (std::ptrdiff_t k = 0; k < n; ++k)
      x[permutation_[static_cast<std::size_t>(k)] + c * static_cast<std::ptrdiff_t>(stride)] = y[c * n + k];
}

}  // namespace mortise
