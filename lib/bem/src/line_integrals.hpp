// Double integrals over two straight lines X and Y in a plane, of the kernels of which those of elasticity are made:
//
//     single = II ln r,   tensor = II d d'/r^2,   double_y[k] = II n_y.d/r^2 phi_k(y),   double_x[k] = -II n_x.d/r^2 phi_k(x),
//
// d = x - y, r = |d|; phi_k is linear and 1 in end k. tensor: XX YY XY.
#pragma once

#include <array>
#include <complex>

namespace mortise::bem {

using Complex = std::complex<double>;

/// From its begin to its end, as complex numbers. The normal is at its right.
struct Line {
  Complex begin, end;
};

struct LineIntegrals {
  double single = 0;
  std::array<double, 3> tensor{};
  std::array<double, 2> double_x{}, double_y{};
};

/// To about 1e-12 times the ratio of their lengths, relative to the lengths' product (single, tensor) and to the lengths. The
/// lines may have ends in common, be the same or lie in one line; they must not cross each other.
LineIntegrals integrate(const Line& x, const Line& y);

}  // namespace mortise::bem
