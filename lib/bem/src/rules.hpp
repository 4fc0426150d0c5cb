// Quadrature on the unit interval and on triangles.
#pragma once

#include <array>
#include <vector>

namespace mortise::bem {

struct Node {
  double at, weight;
};
/// Gauss and Legendre's rule on (0, 1), exact up to degree 2 n - 1.
const std::vector<Node>& gauss(int n);

/// A point of a triangle by its three area coordinates; the weights of a rule add up to 1.
struct TriangleNode {
  std::array<double, 3> at;
  double weight;
};
using TriangleRule = std::vector<TriangleNode>;

/// Rules for functions that are smooth, the next one more exact than the one before: symmetric ones of degree 2, 4, 6 and 8
/// (3, 6, 12 and 16 points) [Dunavant, Int. J. Numer. Methods Eng. 21 (1985)], then products of Gauss rules of degree 10, 12
/// and 14.
inline constexpr int triangle_rules = 7;
const TriangleRule& triangle_rule(int index);

}  // namespace mortise::bem
