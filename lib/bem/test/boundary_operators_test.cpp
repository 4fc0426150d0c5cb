#include "bem/boundary_operators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/dense.hpp"
#include "surfaces.hpp"

namespace mortise::bem {
namespace {

const fem::Material soft{2.0, 0.3, 0, 0};
constexpr double soft_mu = 2.0 / 2.6, soft_lambda = 2 * soft_mu * 0.3 / 0.4;

// Integral of 1 / (4 pi r) over all pairs of points of a square of side 1 [Durand, Electrostatique, 1964: 4 (asinh 1 - (sqrt 2 -
// 1) / 3)].
double square_with_itself()
{
  return (std::asinh(1.0) - (std::sqrt(2.0) - 1) / 3) / std::numbers::pi;
}

// Pairs of panels of the face z = 0 of a cube: the panel itself, common edges and corners, and none in common.
TEST(LayerIntegrals, SquareWithItself)
{
  for (const int cells : {1, 2, 4})
    for (const double accuracy : {1e-4, 1e-8}) {
      const auto panels = test::box({cells, cells, cells}, Point(1, 1, 1));
      const auto layers = integrate_layers(panels, soft, accuracy);
      double single = 0;
      Eigen::Matrix3d kelvin = Eigen::Matrix3d::Zero();
      for (Eigen::Index p = 0; p < panels.size(); ++p)
        for (Eigen::Index q = 0; q < panels.size(); ++q)
          if (panels.normal[static_cast<std::size_t>(p)][2] < -0.5 && panels.normal[static_cast<std::size_t>(q)][2] < -0.5) {
            single += layers.single(p, q);
            kelvin += layers.kelvin.block<3, 3>(3 * p, 3 * q);
          }
      EXPECT_NEAR(single, square_with_itself(), 2 * accuracy * square_with_itself()) << cells;
      // d d' / r^3: half of 1 / r in the directions of the plane, by symmetry.
      const double factor = 1.3 / (2 * 2.0 * 0.7);
      const Eigen::Matrix3d exact =
          factor * square_with_itself() * Eigen::Vector3d(3 - 4 * 0.3 + 0.5, 3 - 4 * 0.3 + 0.5, 3 - 4 * 0.3).asDiagonal();
      EXPECT_LT((kelvin - exact).norm(), 10 * accuracy * exact.norm()) << cells;
    }
}

// Seen from a point of the surface, the surface fills half of all directions.
TEST(LayerIntegrals, DoubleLayerOfAConstantIsMinusOneHalf)
{
  for (const auto& panels : {test::box({3, 2, 1}, Point(1, 2, 0.3)), test::tetrahedron(), test::sphere(1, 1),
                             test::box({10, 10, 1}, Point(1, 1, 0.05))})
    for (const double accuracy : {1e-3, 1e-5}) {
      const Eigen::VectorXd sums = integrate_layers(panels, soft, accuracy).double_layer.rowwise().sum();
      for (Eigen::Index p = 0; p < panels.size(); ++p)
        EXPECT_NEAR(sums[p] / panels.area[static_cast<std::size_t>(p)], -0.5, 3 * accuracy) << panels.size();
    }
}

// The better the quadrature, the better are linear fields: V t = (M / 2 + K) u and D u + (M / 2 + K)' t = M't.
TEST(BoundaryOperators, LinearFieldsAreExactButForTheQuadrature)
{
  Eigen::Matrix3d gradient;
  gradient << 0.3, 0.2, -0.5, 0.7, -0.4, 0.1, 0.25, 0.9, 0.6;
  const Eigen::Matrix3d stress =
      soft_mu * (gradient + gradient.transpose()) + soft_lambda * gradient.trace() * Eigen::Matrix3d::Identity();
  for (const auto& panels : {test::box({2, 3, 2}, Point(1, 1.5, 0.8)), test::tetrahedron(), test::sphere(1, 2),
                             test::box({6, 6, 1}, Point(1, 1, 0.05))}) {
    const auto u = linear_field(panels, Point(0.1, 0.2, 0.3), gradient, Point(0.3, 0.4, 0.1));
    Eigen::VectorXd t(3 * panels.size());
    for (Eigen::Index p = 0; p < panels.size(); ++p) t.segment<3>(3 * p) = stress * panels.normal[static_cast<std::size_t>(p)];
    for (const double accuracy : {1e-3, 1e-5, 1e-7}) {
      const auto [v, k, d] = boundary_operators(panels, soft, accuracy);
      const Eigen::VectorXd forces = nodal_forces(panels, t);
      EXPECT_LT((v * t - k * u).norm(), 40 * accuracy * (v * t).norm()) << panels.size() << ' ' << accuracy;
      EXPECT_LT((d * u + k.transpose() * t - forces).norm(), 30 * accuracy * forces.norm()) << panels.size() << ' ' << accuracy;
      EXPECT_LT((d - d.transpose()).norm(), 1e-13 * d.norm());
      EXPECT_LT((v - v.transpose()).norm(), 1e-14 * v.norm());
    }
  }
}

// Calderon's identities for the border values of an elastic field, that of a point force outside: V t - (M / 2 + K) u, the mean
// over each panel, and D u - (M / 2 - K') t, nodal forces over the length of the mesh: of second order and of one and a half.
TEST(BoundaryOperators, CalderonIdentitiesHaveTheirOrders)
{
  for (const double nu : {0.0, 0.3, 0.49}) {
    const fem::Material material{2.0, nu, 0, 0};
    const auto field = test::kelvin(material, Point(1.7, 0.4, -0.5), Point(0.3, 1, -0.7));
    std::vector<double> of_displacement, of_force;
    for (const int cells : {2, 4, 8}) {
      const auto panels = test::box({cells, cells, cells}, Point(1, 1, 1));
      const auto u = field.nodal(panels), t = field.tractions(panels, material);
      const auto [v, k, d] = boundary_operators(panels, material, 1e-5);
      const Eigen::VectorXd given = nodal_forces(panels, t), image = v * t, gap = image - k * u,
                            missing = d * u + k.transpose() * t - given;
      double square = 0, whole = 0;
      for (Eigen::Index p = 0; p < panels.size(); ++p) {
        const double area = panels.area[static_cast<std::size_t>(p)];
        square += gap.segment<3>(3 * p).squaredNorm() / area;
        whole += image.segment<3>(3 * p).squaredNorm() / area;
      }
      of_displacement.push_back(std::sqrt(square / whole));
      of_force.push_back(missing.norm() / given.norm());
    }
    for (std::size_t i = 1; i < 3; ++i) {
      EXPECT_LT(of_displacement[i], 0.3 * of_displacement[i - 1]) << nu;
      EXPECT_LT(of_force[i], 0.4 * of_force[i - 1]) << nu;
    }
    EXPECT_LT(of_displacement[2], 0.012) << nu;
    EXPECT_LT(of_force[2], 0.012) << nu;
  }
}

// The surface of unit cubes.
Panels cubes(const std::set<std::array<int, 3>>& filled)
{
  std::map<std::array<int, 3>, Local> known;
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> corners;
  for (const auto& cube : filled)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        auto beside = cube;
        beside[axis] += 2 * side - 1;
        if (filled.contains(beside)) continue;
        std::array<Local, 4> quad{};
        for (std::size_t k = 0; k < 4; ++k) {
          auto at = cube;
          at[axis] += side;
          at[(axis + 1) % 3] += k == 1 || k == 2;
          at[(axis + 2) % 3] += k >= 2;
          const auto [it, is_new] = known.emplace(at, static_cast<Local>(points.size()));
          if (is_new) points.emplace_back(at[0], at[1], at[2]);
          quad[k] = it->second;
        }
        if (side == 0) std::swap(quad[1], quad[3]);
        corners.insert(corners.end(), {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}});
      }
  return make_panels(std::move(points), std::move(corners));
}

// Parts of the surface that touch in an edge or in a node, as METIS leaves them: what uniform pressure corrects is of the size of
// the quadrature's error there, too.
TEST(BoundaryOperators, SurfacesThatTouch)
{
  std::set<std::array<int, 3>> pierced;
  for (int i = 0; i < 27; ++i) pierced.insert({i / 9, i / 3 % 3, i % 3});
  pierced.erase({1, 1, 1});
  auto notched = pierced;
  notched.erase({0, 0, 0});  // its corner is one of the void's
  for (const auto& filled : {std::set<std::array<int, 3>>{{0, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 1}}, pierced, notched}) {
    const auto panels = cubes(filled);
    const auto [v, k, d] = boundary_operators(panels, soft, 1e-4);
    const auto exact = integrate_layers(panels, soft, 1e-7).kelvin;
    EXPECT_LT((v - exact).norm(), 1e-3 * exact.norm()) << filled.size();
    EXPECT_GT(dense::symmetric_eigenvalues(v)[0], 0) << filled.size();
  }
}

// Of spherical harmonics Y_l on the unit sphere: V_L Y_l = Y_l / (2 l + 1), K_L Y_l = -Y_l / (2 (2 l + 1)).
TEST(LayerIntegrals, EigenvaluesOfTheSphere)
{
  std::array<std::vector<double>, 3> single, twofold;
  for (const int levels : {2, 3}) {
    const auto panels = test::sphere(1, levels);
    const auto layers = integrate_layers(panels, soft, 1e-6);
    for (int l = 0; l < 3; ++l) {
      const auto harmonic = [&](const Point& x) { return l == 0 ? 1.0 : l == 1 ? x[2] : x[0] * x[1]; };
      Eigen::VectorXd on_panels(panels.size()), weighted(panels.size()), at_nodes(panels.node_count());
      for (std::size_t p = 0; p < panels.corners.size(); ++p) {
        const auto row = static_cast<Eigen::Index>(p);
        on_panels[row] = harmonic((panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2)).normalized());
        weighted[row] = panels.area[p] * on_panels[row];
      }
      for (Eigen::Index n = 0; n < at_nodes.size(); ++n) at_nodes[n] = harmonic(panels.points[static_cast<std::size_t>(n)]);
      const double norm = on_panels.dot(weighted);
      const double v = on_panels.dot(layers.single * on_panels) / norm, k = on_panels.dot(layers.double_layer * at_nodes) / norm;
      single[static_cast<std::size_t>(l)].push_back(std::abs(v * (2 * l + 1) - 1));
      twofold[static_cast<std::size_t>(l)].push_back(std::abs(-2 * k * (2 * l + 1) - 1));
    }
  }
  for (std::size_t l = 0; l < 3; ++l) {
    EXPECT_LT(single[l][1], 0.02) << l;
    EXPECT_LT(single[l][1], 0.3 * single[l][0]) << l;  // h^2
    if (l == 0) continue;                              // exact
    EXPECT_LT(twofold[l][1], 0.05) << l;
    EXPECT_LT(twofold[l][1], 0.3 * twofold[l][0]) << l;
  }
}

// A layer of tractions n on the unit sphere in space moves it by n / (3 (soft_lambda + 2 soft_mu)), one of e_z x n by e_z x n /
// (3 soft_mu): inside and outside such fields fit, u and u / r^3, and sigma n jumps by the layer.
TEST(LayerIntegrals, ElasticLayersOnTheSphere)
{
  for (const bool radial : {true, false}) {
    std::vector<double> error;
    for (const int levels : {2, 3}) {
      const auto panels = test::sphere(1, levels);
      const auto v = integrate_layers(panels, soft, 1e-6).kelvin;
      Eigen::VectorXd t(3 * panels.size());
      double norm = 0;
      for (std::size_t p = 0; p < panels.corners.size(); ++p) {
        const Point n = panels.normal[p], layer = radial ? n : Point::UnitZ().cross(n);
        t.segment<3>(3 * static_cast<Eigen::Index>(p)) = layer;
        norm += panels.area[p] * layer.squaredNorm();
      }
      error.push_back(std::abs(t.dot(v * t) / norm * 3 * (radial ? soft_lambda + 2 * soft_mu : soft_mu) - 1));
    }
    EXPECT_LT(error[1], 0.02) << radial;
    EXPECT_LT(error[1], 0.3 * error[0]) << radial;
  }
}

}  // namespace
}  // namespace mortise::bem
