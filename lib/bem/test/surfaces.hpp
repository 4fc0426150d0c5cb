// Surfaces and elastic fields that the tests of bem share.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "bem/panels.hpp"
#include "bem/representation.hpp"
#include "bem/surface_stress.hpp"

namespace mortise::bem::test {

/// The box [0, size] of cells[0] x cells[1] x cells[2] cells, each rectangle two triangles; `place` maps [0, 1] to itself and
/// grades the cells of each edge.
inline Panels box(
    const std::array<int, 3>& cells, const Point& size, const std::function<double(double)>& place = [](double s) { return s; })
{
  std::map<std::array<int, 3>, Local> known;
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> corners;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [it, is_new] = known.emplace(at, static_cast<Local>(points.size()));
    if (is_new) {
      Point& x = points.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) x[static_cast<int>(c)] = size[static_cast<int>(c)] * place(double(at[c]) / cells[c]);
    }
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int i = 0; i < cells[a]; ++i)
      for (int j = 0; j < cells[b]; ++j)
        for (const bool far : {false, true}) {
          std::array<Local, 4> quad{};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = far ? cells[axis] : 0;
            at[a] = i + (k == 1 || k == 2);
            at[b] = j + (k >= 2);
            quad[static_cast<std::size_t>(k)] = node(at);
          }
          if (!far) std::swap(quad[1], quad[3]);
          corners.push_back({quad[0], quad[1], quad[2]});
          corners.push_back({quad[0], quad[2], quad[3]});
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

/// An octahedron whose triangles are cut into four `levels` times, its corners pushed onto the sphere.
inline Panels sphere(double radius, int levels)
{
  std::vector<Point> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<Local, 3>> corners{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                            {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Local, Local>, Local> middles;
    const auto middle = [&](Local a, Local b) {
      const auto [it, is_new] = middles.emplace(std::minmax(a, b), static_cast<Local>(points.size()));
      if (is_new) points.push_back((points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
      return it->second;
    };
    std::vector<std::array<Local, 3>> finer;
    for (const auto& [a, b, c] : corners) {
      const Local ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    corners = std::move(finer);
  }
  for (auto& p : points) p *= radius;
  return make_panels(std::move(points), std::move(corners));
}

inline fem::Material steel()
{
  fem::Material material;
  material.young_modulus = 2;
  material.poisson_ratio = 0.3;
  return material;
}

/// An elastic field without body forces: displacement and its gradient d u_i / d x_j.
struct Field {
  std::function<Point(const Point&)> u;
  std::function<Eigen::Matrix3d(const Point&)> gradient;

  Eigen::VectorXd nodal(const Panels& panels) const
  {
    Eigen::VectorXd result(3 * panels.node_count());
    for (Eigen::Index n = 0; n < panels.node_count(); ++n)
      result.segment<3>(3 * n) = u(panels.points[static_cast<std::size_t>(n)]);
    return result;
  }
  /// In the middle of each panel.
  Eigen::VectorXd tractions(const Panels& panels, const fem::Material& material) const
  {
    Eigen::VectorXd result(3 * panels.size());
    for (std::size_t p = 0; p < panels.corners.size(); ++p) {
      const Point middle = (panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2)) / 3;
      result.segment<3>(3 * static_cast<Eigen::Index>(p)) = hooke(material, gradient(middle)) * panels.normal[p];
    }
    return result;
  }
};

inline Field linear(const Eigen::Matrix3d& gradient)
{
  return {[=](const Point& x) -> Point { return gradient * x + Point(0.1, 0.2, 0.3); }, [=](const Point&) { return gradient; }};
}

/// Pure bending of a beam along x about the y axis by curvature 1: sigma_xx = E z [Timoshenko and Goodier, Theory of elasticity].
inline Field bending(double nu)
{
  return {[=](const Point& x) -> Point {
            return {x[0] * x[2], -nu * x[1] * x[2], (-x[0] * x[0] + nu * (x[1] * x[1] - x[2] * x[2])) / 2};
          },
          [=](const Point& x) {
            return (Eigen::Matrix3d() << x[2], 0, x[0], 0, -nu * x[2], -nu * x[1], -x[0], nu * x[1], -nu * x[2]).finished();
          }};
}

/// A point force in the infinite space: U(x - origin) force.
inline Field kelvin(const fem::Material& material, const Point& origin, const Point& force)
{
  const double nu = material.poisson_ratio, factor = (1 + nu) / (8 * std::numbers::pi * material.young_modulus * (1 - nu));
  return {[=](const Point& x) -> Point {
            const Point d = x - origin;
            const double r = d.norm();
            return factor * ((3 - 4 * nu) / r * force + d.dot(force) / (r * r * r) * d);
          },
          [=](const Point& x) -> Eigen::Matrix3d {
            const Point d = x - origin;
            const double r = d.norm(), along = d.dot(force);
            return factor / (r * r * r) *
                   (-(3 - 4 * nu) * force * d.transpose() + along * Eigen::Matrix3d::Identity() + d * force.transpose() -
                    3 * along / (r * r) * d * d.transpose());
          }};
}

/// Inside, of displacements and tractions, with the stresses that are recovered from them.
inline InteriorField inside(const Panels& panels, std::span<const Point> points, const Eigen::VectorXd& u,
                            const Eigen::VectorXd& t, double accuracy = 1e-5)
{
  const auto recovered = recovered_stresses(panels, steel(), {u, t});
  return Representation(panels, steel(), accuracy).evaluate(points, u, t, recovered);
}

inline double shear_modulus(const fem::Material& material)
{
  return material.young_modulus / (2 * (1 + material.poisson_ratio));
}

}  // namespace mortise::bem::test
