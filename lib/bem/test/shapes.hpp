// Closed surfaces for tests.
#pragma once

#include <map>

#include "bem/panels.hpp"

namespace mortise::bem {

/// A box with its corner at the origin, `cells` squares an axis, two panels each.
inline Panels box(const std::array<int, 3>& cells, const Point& size)
{
  std::map<std::array<int, 3>, Local> numbers;
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> corners;
  const auto node = [&](std::array<int, 3> at) {
    const auto [found, fresh] = numbers.emplace(at, static_cast<Local>(points.size()));
    if (fresh) points.emplace_back(size[0] * at[0] / cells[0], size[1] * at[1] / cells[1], size[2] * at[2] / cells[2]);
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t s = (axis + 1) % 3, t = (axis + 2) % 3;
    for (int i = 0; i < cells[s]; ++i)
      for (int j = 0; j < cells[t]; ++j)
        for (const bool top : {false, true}) {
          std::array<Local, 4> square{};
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = top ? cells[axis] : 0;
            at[s] = i + (k == 1 || k == 2);
            at[t] = j + (k >= 2);
            square[top ? k : 3 - k] = node(at);
          }
          corners.push_back({square[0], square[1], square[2]});
          corners.push_back({square[0], square[2], square[3]});
        }
  }
  return make_panels(std::move(points), std::move(corners));
}

/// The corners (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1).
inline Panels tetrahedron()
{
  return make_panels({Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1)},
                     {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
}

/// The unit sphere: an octahedron whose faces are cut into 4 `levels` times.
inline Panels sphere(int levels)
{
  std::vector<Point> points;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) points.emplace_back(side * Point::Unit(axis));
  std::vector<std::array<Local, 3>> corners;
  for (const Local x : {0, 1})
    for (const Local y : {2, 3})
      for (const Local z : {4, 5})
        corners.push_back((x + y + z) % 2 == 1 ? std::array<Local, 3>{x, y, z} : std::array<Local, 3>{x, z, y});
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Local, Local>, Local> middles;
    const auto middle = [&](Local a, Local b) {
      const auto [found, fresh] = middles.emplace(std::minmax(a, b), static_cast<Local>(points.size()));
      if (fresh) points.push_back((points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
      return found->second;
    };
    std::vector<std::array<Local, 3>> finer;
    for (const auto& [a, b, c] : corners) {
      const Local ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(part);
    }
    corners = std::move(finer);
  }
  return make_panels(std::move(points), std::move(corners));
}

}  // namespace mortise::bem
