// The inside of plane bodies.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "bem/plane_state.hpp"
#include "bem/representation.hpp"
#include "lines.hpp"

namespace mortise::bem {
namespace {

using namespace test;

const Eigen::Matrix3d plane_slope = (Eigen::Matrix3d() << 0.3, 0.2, 0, 0.7, -0.4, 0, 0, 0, 0).finished();

fem::Material plane_steel(fem::Kinematics kinematics = fem::Kinematics::plane_strain)
{
  return in_plane({2.0, 0.3}, kinematics);
}

Eigen::VectorXd plane_noise(Eigen::Index size, unsigned seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(generator); });
}

// `distance` times a panel's size inside of the middle, the quarter and the beginning of each panel; at corners along the
// bisector.
std::vector<Point> near_border(const PlanePanels& panels, double distance)
{
  std::vector<Point> result;
  std::vector<std::size_t> ending(panels.points.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) ending[static_cast<std::size_t>(panels.corners[p][1])] = p;
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const Point a = panels.corner(p, 0), b = panels.corner(p, 1);
    const double depth = distance * panels.area[p];
    for (const double s : {0.5, 0.25}) result.emplace_back((1 - s) * a + s * b - depth * panels.normal[p]);
    const std::size_t before = ending[static_cast<std::size_t>(panels.corners[p][0])];
    result.emplace_back(a - std::min(depth, distance * panels.area[before]) *
                                (panels.normal[p] + panels.normal[before]).normalized());
  }
  return result;
}

struct PlaneErrors {
  double displacement = 0, stress = 0;
};
PlaneErrors errors_in_plane(const PlanePanels& panels, const fem::Material& material, const Field& field,
                            const std::vector<Point>& points, const Eigen::VectorXd& t)
{
  const auto found = Representation(panels, material).evaluate(points, nodal(panels, field), t);
  PlaneErrors result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    result.displacement =
        std::max(result.displacement, (found.displacement.row(row).head<2>().transpose() - field.u(points[i]).head<2>()).norm());
    const fem::Stress exact = components(hooke(material, field.gradient(points[i])));
    result.stress = std::max(result.stress, (found.stress.row(row).transpose() - exact).norm());
  }
  return result;
}

TEST(PlaneRepresentation, ConstantStressIsExactUpToSidesAndCorners)
{
  for (const auto kinematics : {fem::Kinematics::plane_strain, fem::Kinematics::plane_stress})
    for (const auto& panels : borders())
      for (const double distance : {0.3, 1e-2, 1e-6, 1e-10, 0.0}) {
        const auto material = plane_steel(kinematics);
        const auto field = linear(plane_slope);
        const auto [displacement, stress] =
            errors_in_plane(panels, material, field, near_border(panels, distance), tractions_of(panels, material, field));
        EXPECT_LT(displacement, 1e-11) << panels.size() << ", " << distance;
        EXPECT_LT(stress, 1e-11) << panels.size() << ", " << distance;
      }
}

// Somigliana's identity with its kernels [Brebbia, Telles and Wrobel, Boundary element techniques, 1984, sections 5.2 and 5.10],
// of arbitrary u and tractions in equilibrium, on panels cut into parts that grow with their distance from the point.
struct Textbook {
  Point displacement = Point::Zero();
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
};
Textbook textbook(const PlanePanels& panels, const fem::Material& material, const Point& x, const Eigen::VectorXd& u,
                  const Eigen::VectorXd& t)
{
  const double nu = material.poisson_ratio, mu = shear_modulus(material), pi = std::numbers::pi;
  constexpr std::array<std::pair<double, double>, 5> gauss{{{0.046910077030668, 0.118463442528095},
                                                            {0.230765344947158, 0.239314335249683},
                                                            {0.5, 0.284444444444444},
                                                            {0.769234655052841, 0.239314335249683},
                                                            {0.953089922969332, 0.118463442528095}}};
  Textbook result;
  const auto add = [&](const Point& y, const Point& n, const Point& force, const Point& value, double weight) {
    const Point d = y - x;
    const double r = d.norm();
    const Point e = d / r;
    const double slope = e.dot(n);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const double same = a == b;
        result.displacement[a] +=
            weight * (-(3 - 4 * nu) * std::log(r) * same + e[a] * e[b]) / (8 * pi * mu * (1 - nu)) * force[b];
        result.displacement[a] += weight *
                                  (slope * ((1 - 2 * nu) * same + 2 * e[a] * e[b]) - (1 - 2 * nu) * (e[a] * n[b] - e[b] * n[a])) /
                                  (4 * pi * (1 - nu) * r) * value[b];
        for (int k = 0; k < 2; ++k) {
          const double ka = k == a, kb = k == b;
          result.stress(a, b) += weight * ((1 - 2 * nu) * (ka * e[b] + kb * e[a] - same * e[k]) + 2 * e[a] * e[b] * e[k]) /
                                 (4 * pi * (1 - nu) * r) * force[k];
          result.stress(a, b) -=
              weight * mu / (2 * pi * (1 - nu) * r * r) *
              (2 * slope * ((1 - 2 * nu) * same * e[k] + nu * (ka * e[b] + kb * e[a]) - 4 * e[a] * e[b] * e[k]) +
               2 * nu * (n[a] * e[b] * e[k] + n[b] * e[a] * e[k]) +
               (1 - 2 * nu) * (2 * n[k] * e[a] * e[b] + n[b] * ka + n[a] * kb) - (1 - 4 * nu) * n[k] * same) *
              value[k];
        }
      }
  };
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto value = [&](int k) { return lifted<2>(u.segment<2>(2 * panels.corners[p][static_cast<std::size_t>(k)])); };
    const std::function<void(double, double)> part = [&](double from, double to) {
      const auto point = [&](double s) { return Point((1 - s) * panels.corner(p, 0) + s * panels.corner(p, 1)); };
      const double length = (to - from) * panels.area[p];
      if (length > 0.25 * (point((from + to) / 2) - x).norm()) {
        part(from, (from + to) / 2);
        part((from + to) / 2, to);
        return;
      }
      for (const auto& [at, weight] : gauss) {
        const double s = from + at * (to - from);
        add(point(s), panels.normal[p], lifted<2>(t.segment<2>(2 * static_cast<Eigen::Index>(p))),
            (1 - s) * value(0) + s * value(1), weight * length);
      }
    };
    part(0, 1);
  }
  result.stress(2, 2) = nu * (result.stress(0, 0) + result.stress(1, 1));
  return result;
}

// Without a resultant: the unit of length adds nothing then.
Eigen::VectorXd balanced(const PlanePanels& panels, Eigen::VectorXd t)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double length = 0;
  for (Eigen::Index p = 0; p < panels.size(); ++p) {
    sum += panels.area[static_cast<std::size_t>(p)] * t.segment<2>(2 * p);
    length += panels.area[static_cast<std::size_t>(p)];
  }
  for (Eigen::Index p = 0; p < panels.size(); ++p) t.segment<2>(2 * p) -= sum / length;
  return t;
}

TEST(PlaneRepresentation, AgreesWithTheKernelsOfTextbooks)
{
  const auto material = plane_steel();
  // Of panels that meet at corners, so that t and du / ds are constant on each. The last one has a short panel between long ones,
  // next to which points are then.
  const auto uneven = polygons({{{0, 0, 0}, {0.5, 0, 0}, {0.505, 0.01, 0}, {1, -0.5, 0}, {1, 1, 0}, {0, 1, 0}}}, 1);
  for (const auto& panels : {polygons({circle(1, 7), circle(0.1, 5, true)}, 1), uneven}) {
    const Eigen::VectorXd u = plane_noise(2 * panels.node_count(), 1), t = balanced(panels, plane_noise(2 * panels.size(), 2));
    const Representation inside(panels, material);
    std::vector<double> shortest(panels.points.size(), 1e9);  // panel of each node
    for (std::size_t p = 0; p < panels.corners.size(); ++p)
      for (const Local n : panels.corners[p]) {
        auto& own = shortest[static_cast<std::size_t>(n)];
        own = std::min(own, panels.area[p]);
      }
    for (const double distance : {0.5, 0.1, 1e-3, 1e-5}) {
      std::vector<Point> points;
      for (const auto& x : near_border(panels, distance))
        if (inside.locate(x).inside) points.push_back(x);
      if (points.size() > 20) points.resize(20);
      ASSERT_FALSE(points.empty());
      const auto found = inside.evaluate(points, u, t);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const auto [displacement, stress] = textbook(panels, material, points[i], u, t);
        EXPECT_LT((found.displacement.row(row).transpose() - displacement).norm(), 1e-8) << panels.size() << ", " << distance;
        bool at_a_node = false;  // where logarithms are cut off
        for (std::size_t n = 0; n < shortest.size(); ++n)
          at_a_node = at_a_node || (panels.points[n] - points[i]).norm() < 0.051 * shortest[n];
        if (!at_a_node) {
          EXPECT_LT((found.stress.row(row).transpose() - components(stress)).norm(),
                    (distance < 1e-4 ? 1e-5 : 1e-8) * stress.norm())
              << i;
        }
      }
    }
  }
}

TEST(PlaneRepresentation, LargeRotationsLeaveStressesAlone)
{
  const auto panels = rectangle(2, 1, 16, 8);
  const auto material = plane_steel();
  const auto bent = plane_bending(0.3);
  Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
  spin(0, 1) = -1e4;
  spin(1, 0) = 1e4;
  const Eigen::VectorXd u = nodal(panels, bent), t = tractions_of(panels, material, bent),
                        turned = u + linear_field(panels, {1e4, 0, 0}, spin, {0, 0, 0});
  const std::vector<Point> points{{1, 0.5, 0}, {0.2, 0.1, 0}, {1.9, 0.99, 0}};
  const Representation inside(panels, material);
  EXPECT_LT((inside.evaluate(points, u, t).stress - inside.evaluate(points, turned, t).stress).norm(), 1e-9);
}

// In the unit of length, of forces that have a resultant by the error of their panels alone.
TEST(PlaneRepresentation, TheUnitOfLengthIsIndifferent)
{
  const auto panels = polygons({circle(1.3, 24)}, 1);
  const auto material = plane_steel();
  const Eigen::VectorXd u = plane_noise(2 * panels.node_count(), 3), t = plane_noise(2 * panels.size(), 4);
  const std::vector<Point> points{{0.1, 0.2, 0}, {-0.7, 0.8, 0}};
  const auto found = Representation(panels, material).evaluate(points, u, t);
  for (const double factor : {1e-6, 1e6}) {
    const auto other = scaled(panels, factor);
    std::vector<Point> there;
    for (const auto& x : points) there.emplace_back(factor * x);
    const auto again = Representation(other, material).evaluate(there, factor * u, t);
    EXPECT_LT((again.stress - found.stress).norm(), 1e-11 * found.stress.norm());
    EXPECT_LT((again.displacement - factor * found.displacement).norm(), 1e-11 * factor * found.displacement.norm());
  }
}

// A linear stress: t and du / ds are linear on each panel.
TEST(PlaneRepresentation, BendingIsExactUpToSidesAndCorners)
{
  const auto field = plane_bending(0.3);
  const auto material = plane_steel();
  for (const auto& panels : {rectangle(2, 1, 16, 8), rectangle(20, 1, 40, 2),
                             polygons({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}}, 3)})
    for (const double distance : {0.9, 0.3, 0.1, 1e-3, 1e-6, 0.0}) {
      std::vector<Point> points;
      for (const auto& x : near_border(panels, distance))
        if (distance < 0.5 || Representation(panels, material).locate(x).inside) points.push_back(x);
      const auto error = errors_in_plane(panels, material, field, points, tractions_of(panels, material, field));
      EXPECT_LT(error.stress, distance > 0 ? 1e-10 : 1e-7) << panels.size() << ", " << distance;
    }
  const auto displacement_error = [&](int cells) {
    const auto panels = rectangle(2, 1, 2 * cells, cells);
    return errors_in_plane(panels, material, field, near_border(panels, 0.3), tractions_of(panels, material, field)).displacement;
  };
  EXPECT_LT(displacement_error(8), 3e-3);
  EXPECT_LT(displacement_error(16), displacement_error(8) / 3);
}

// A ring under pressure inside [Lame], panels of unequal lengths: u and t are of second order inside, in the wall and next to it.
TEST(PlaneRepresentation, LameRing)
{
  for (const auto kinematics : {fem::Kinematics::plane_strain, fem::Kinematics::plane_stress}) {
    const auto material = plane_steel(kinematics);
    const double nu = material.poisson_ratio, mu = shear_modulus(material), inner = 0.5, outer = 1, pressure = 0.2;
    const double share = pressure * inner * inner / (outer * outer - inner * inner);
    const double a = share * (1 - 2 * nu) / (2 * mu), b = share * outer * outer / (2 * mu);
    const Field field{[=](const Point& x) -> Point { return (a + b / x.squaredNorm()) * x; },
                      [=](const Point& x) -> Eigen::Matrix3d {
                        const double square = x.squaredNorm();
                        Eigen::Matrix3d plane = Eigen::Matrix3d::Identity();
                        plane(2, 2) = 0;
                        return (a + b / square) * plane - 2 * b / (square * square) * x * x.transpose();
                      }};
    const Point middle(0.75, 0, 0);  // sigma_r = share (1 - outer^2 / r^2)
    EXPECT_NEAR(hooke(material, field.gradient(middle))(0, 0), share * (1 - 1 / (0.75 * 0.75)), 1e-14);
    const auto errors_at = [&](int sides, double radius) {
      const auto panels = ring(inner, outer, sides, 0.2);
      std::vector<Point> points;
      for (int i = 0; i < 50; ++i) points.emplace_back(radius * std::cos(0.1 + 2 * i), radius * std::sin(0.1 + 2 * i), 0);
      return errors_in_plane(panels, material, field, points, tractions_of(panels, material, field));
    };
    for (const double radius : {0.501, 0.51, 0.55, 0.75, 0.95}) {
      const auto coarse = errors_at(32, radius), fine = errors_at(64, radius), finest = errors_at(128, radius);
      EXPECT_LT(fine.displacement, coarse.displacement / 3) << radius;
      EXPECT_LT(finest.displacement, fine.displacement / 3) << radius;
      EXPECT_LT(finest.stress, coarse.stress / 8) << radius;
      EXPECT_LT(finest.stress, 0.005 * pressure) << radius;
    }
  }
}

TEST(PlaneLocation, InsideOrOutside)
{
  for (const auto& panels : borders()) {
    const Representation border(panels, plane_steel());
    for (const double distance : {0.05, 1e-3, 1e-6, 1e-9}) {
      const auto points = near_border(panels, distance);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto p = i / 3;
        const auto in = border.locate(points[i]);
        EXPECT_TRUE(in.inside) << panels.size() << ", " << distance;
        const Point from = i % 3 == 2 ? panels.corner(p, 0) : points[i] + distance * panels.area[p] * panels.normal[p];
        const auto out = border.locate(2 * from - points[i]);
        EXPECT_FALSE(out.inside) << panels.size() << ", " << distance;
        if (i % 3 != 2) {
          EXPECT_EQ(in.panel, p);
          EXPECT_NEAR(in.distance, distance * panels.area[p], 1e-14);
        }
      }
    }
    EXPECT_FALSE(border.locate({1e3, 1e3, 0}).inside);
  }
  EXPECT_FALSE(Representation(ring(0.6, 1, 16), plane_steel()).locate({0.1, 0.2, 0}).inside);
  EXPECT_EQ(Representation(rectangle(1, 1, 4, 4), plane_steel()).locate({0.3, 1, 0}).distance, 0);
}

}  // namespace
}  // namespace mortise::bem
