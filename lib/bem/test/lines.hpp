// Borders of plane bodies that the tests of bem share.
#pragma once

#include <cmath>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::bem::test {

/// Closed polygons, counter-clockwise round the inside, each side cut into `cuts` panels.
inline PlanePanels polygons(const std::vector<std::vector<Point>>& loops, int cuts)
{
  std::vector<Point> points;
  std::vector<std::array<Local, 2>> corners;
  for (const auto& loop : loops) {
    const auto first = static_cast<Local>(points.size()), count = static_cast<Local>(loop.size()) * cuts;
    for (std::size_t k = 0; k < loop.size(); ++k)
      for (int i = 0; i < cuts; ++i)
        points.push_back(loop[k] + static_cast<double>(i) / cuts * (loop[(k + 1) % loop.size()] - loop[k]));
    for (Local i = 0; i < count; ++i) corners.push_back({first + i, first + (i + 1) % count});
  }
  return make_panels(std::move(points), std::move(corners));
}

/// [0, width] x [0, height]; panels of about one length.
inline PlanePanels rectangle(double width, double height, int along, int across)
{
  std::vector<Point> loop;
  for (int i = 0; i < along; ++i) loop.emplace_back(width * i / along, 0, 0);
  for (int i = 0; i < across; ++i) loop.emplace_back(width, height * i / across, 0);
  for (int i = along; i > 0; --i) loop.emplace_back(width * i / along, height, 0);
  for (int i = across; i > 0; --i) loop.emplace_back(0, height * i / across, 0);
  return polygons({loop}, 1);
}

/// `uneven`: how much the sides differ.
inline std::vector<Point> circle(double radius, int sides, bool clockwise = false, double uneven = 0)
{
  std::vector<Point> loop;
  for (int i = 0; i < sides; ++i) {
    const double even = 2 * std::numbers::pi * i / sides * (clockwise ? -1 : 1), angle = even + uneven * std::sin(2 * even + 0.3);
    loop.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return loop;
}

inline PlanePanels ring(double inner, double outer, int sides, double uneven = 0)
{
  return polygons({circle(outer, sides, false, uneven), circle(inner, sides, true, uneven)}, 1);
}

/// A square, a triangle, a circle, a slender strip, a ring, an L, a ring of very unequal panels.
inline std::vector<PlanePanels> borders()
{
  return {rectangle(1, 1, 4, 4),
          polygons({{Point(0, 0, 0), Point(1, 0.1, 0), Point(0.3, 0.8, 0)}}, 3),
          polygons({circle(1.3, 24)}, 1),
          rectangle(20, 1, 40, 2),
          ring(0.6, 1, 16),
          polygons({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}}, 3),
          polygons({circle(1, 12), circle(0.02, 40, true)}, 1)};
}

inline PlanePanels scaled(PlanePanels panels, double factor)
{
  for (auto& x : panels.points) x *= factor;
  return make_panels(std::move(panels.points), std::move(panels.corners));
}

/// Of a field of plane strain, nodal displacements and tractions in the middle of each panel.
inline Eigen::VectorXd nodal(const PlanePanels& panels, const Field& field)
{
  Eigen::VectorXd result(2 * panels.node_count());
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    result.segment<2>(2 * n) = flattened<2>(field.u(panels.points[static_cast<std::size_t>(n)]));
  return result;
}
inline Eigen::VectorXd tractions_of(const PlanePanels& panels, const fem::Material& material, const Field& field)
{
  Eigen::VectorXd result(2 * panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    result.segment<2>(2 * static_cast<Eigen::Index>(p)) =
        flattened<2>(hooke(material, field.gradient(panels.middle(p))) * panels.normal[p]);
  return result;
}

/// Bending of a strip along x by curvature 1 in plane strain: sigma_xx = E / (1 - nu^2) y.
inline Field plane_bending(double nu)
{
  const double across = nu / (1 - nu);
  return {[=](const Point& x) -> Point {
            return {x[0] * x[1], -(x[0] * x[0] + across * x[1] * x[1]) / 2, 0};
          },
          [=](const Point& x) { return (Eigen::Matrix3d() << x[1], x[0], 0, -x[0], -across * x[1], 0, 0, 0, 0).finished(); }};
}

}  // namespace mortise::bem::test
