#include "rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mortise::fem {

namespace {

using Rule = std::vector<IntegrationPoint>;

// Gauss's rule with two or three points on [-1, 1].
Rule gauss(int points)
{
  if (points == 2) {
    const double a = 1 / std::sqrt(3.0);
    return {{{-a, 0, 0}, 1}, {{a, 0, 0}, 1}};
  }
  const double a = std::sqrt(0.6);
  return {{{-a, 0, 0}, 5.0 / 9}, {{0, 0, 0}, 8.0 / 9}, {{a, 0, 0}, 5.0 / 9}};
}

// The coordinates of `b` behind the `dimension` first ones of `a`.
Rule product(const Rule& a, int dimension, const Rule& b)
{
  Rule result;
  for (const auto& q : b)
    for (const auto& p : a) {
      Eigen::Vector3d at = p.at;
      for (int c = dimension; c < 3; ++c) at[c] = q.at[c - dimension];
      result.push_back({at, p.weight * q.weight});
    }
  return result;
}

Rule square(int points)
{
  return product(gauss(points), 1, gauss(points));
}

Rule cube(int points)
{
  return product(square(points), 2, gauss(points));
}

// All permutations of barycentric coordinates, each with `weight` of the simplex's volume.
void add_orbit(std::vector<double> barycentric, double weight, Rule& rule)
{
  std::sort(barycentric.begin(), barycentric.end());
  const double volume = barycentric.size() == 3 ? 1.0 / 2 : 1.0 / 6;
  do {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (std::size_t c = 1; c < barycentric.size(); ++c) at[static_cast<Eigen::Index>(c) - 1] = barycentric[c];
    rule.push_back({at, weight * volume});
  } while (std::next_permutation(barycentric.begin(), barycentric.end()));
}

// Degrees 1, 2 and 4 [Dunavant, IJNME 21 (1985)].
Rule triangle(int degree)
{
  Rule rule;
  if (degree == 1) {
    add_orbit({1.0 / 3, 1.0 / 3, 1.0 / 3}, 1, rule);
  } else if (degree == 2) {
    add_orbit({1.0 / 6, 1.0 / 6, 2.0 / 3}, 1.0 / 3, rule);
  } else {
    for (const auto& [a, weight] :
         {std::pair(0.445948490915964886, 0.223381589678011466), std::pair(0.091576213509770743, 0.109951743655321868)})
      add_orbit({a, a, 1 - 2 * a}, weight, rule);
  }
  return rule;
}

// Degrees 1 and 5 [Walkington, Quadrature on simplices of arbitrary dimension (2000)].
Rule tetrahedron(int degree)
{
  Rule rule;
  if (degree == 1) {
    add_orbit({0.25, 0.25, 0.25, 0.25}, 1, rule);
    return rule;
  }
  for (const auto& [a, weight] :
       {std::pair(0.31088591926330060980, 0.11268792571801585080), std::pair(0.092735250310891226402, 0.073493043116361949544)})
    add_orbit({a, a, a, 1 - 3 * a}, weight, rule);
  const double b = 0.045503704125649649492;
  add_orbit({b, b, 0.5 - b, 0.5 - b}, 0.042546020777081466438, rule);
  return rule;
}

}  // namespace

Rule integration_rule(mesh::CellType type)
{
  using enum mesh::CellType;
  switch (type) {
    case line2:
      return gauss(2);
    case line3:
      return gauss(3);
    case tri3:
      return triangle(1);
    case tri6:
      return triangle(4);
    case quad4:
      return square(2);
    case quad8:
    case quad9:
      return square(3);
    case tet4:
      return tetrahedron(1);
    case tet10:
      return tetrahedron(5);
    case hex8:
      return cube(2);
    case hex20:
    case hex27:
      return cube(3);
    case prism6:
      return product(triangle(2), 2, gauss(2));
    case prism15:
    case prism18:
      return product(triangle(4), 2, gauss(3));
  }
  return {};
}

}  // namespace mortise::fem
