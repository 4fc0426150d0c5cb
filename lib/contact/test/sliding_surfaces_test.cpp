// What facets make of cylinders and cones, and which motions let them slide along themselves.
#include "contact/sliding_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// A disturbed mesh of triangles round a cone: radius 10 at z = 0, growing by `slope`; 10 high.
constraint::SlidingSurface cone(double slope, int round, const Communicator& comm)
{
  Pair pair;
  pair.options.obstacle = Obstacle{};
  pair.secondary = surface(
      {round, round / 4, 0, 1.9 * std::numbers::pi, 0, 10, true, true, 0, 0.25},
      [&](double x, double z) {
        const double r = 10 + slope * z;
        return Point(r * std::cos(x), r * std::sin(x), z);
      },
      comm);
  constraint::Contacts contacts;  // supports hold all nodes of the other side: all faces count
  const auto found = sliding_surfaces({&pair, 1}, contacts, fem::Kinematics::solid, comm);
  EXPECT_EQ(found.size(), 1U);
  return found.front();
}

double root(const constraint::SlidingSurface::Form& form, const Eigen::Matrix<double, 6, 1>& motion)
{
  return std::sqrt(motion.dot(form * motion));
}

Eigen::Matrix<double, 6, 1> along_axis()
{
  return Eigen::Matrix<double, 6, 1>::Unit(2);
}
// About the axis of the cylinder, which does not pass through the centre of a part of it.
Eigen::Matrix<double, 6, 1> about_axis(const constraint::SlidingSurface& slide)
{
  Eigen::Matrix<double, 6, 1> result;
  result << Point(0, 0, 1).cross(slide.centre) / slide.length, 0, 0, 1;
  return result;
}

TEST(Slides, facets_of_a_cylinder_tilt_but_do_not_resist)
{
  const Communicator comm;
  for (const int round : {16, 32, 64}) {
    const auto slide = cone(0, round, comm);
    EXPECT_GT(slide.tilt, 0.1 * std::pow(5.0 / round, 2)) << round;
    EXPECT_LT(slide.tilt, std::pow(5.0 / round, 2)) << round;
    EXPECT_GT(root(slide.whole, along_axis()), 0.05 / round) << "facets are to tilt for this to be a test";
    EXPECT_LT(root(slide.smooth, along_axis()), 0.1 * std::sqrt(slide.tilt)) << round;
    EXPECT_LT(root(slide.smooth, about_axis(slide)), 0.1 * std::sqrt(slide.tilt) * root(slide.speed, about_axis(slide))) << round;
    EXPECT_GT(root(slide.smooth, Eigen::Matrix<double, 6, 1>::Unit(0)), 0.5);
  }
}

TEST(Slides, a_cone_of_one_degree_resists)
{
  const Communicator comm;
  const auto slide = cone(std::tan(std::numbers::pi / 180), 32, comm);
  EXPECT_NEAR(root(slide.smooth, along_axis()), std::sin(std::numbers::pi / 180), 2e-3);
  EXPECT_GT(root(slide.smooth, along_axis()), 0.1 * std::sqrt(slide.tilt));
  EXPECT_LT(root(slide.smooth, about_axis(slide)), 0.1 * std::sqrt(slide.tilt) * root(slide.speed, about_axis(slide)));
}

TEST(Slides, teeth_stand_in_the_whole)
{
  const Communicator comm;
  Pair pair;
  pair.options.obstacle = Obstacle{};
  pair.secondary = surface(
      {240, 4, 0, 1.9 * std::numbers::pi, 0, 10, true},
      [](double x, double z) {
        const double r = 10 + 0.3 * std::sin(20 * x);
        return Point(r * std::cos(x), r * std::sin(x), z);
      },
      comm);
  const auto slide = sliding_surfaces({&pair, 1}, {}, fem::Kinematics::solid, comm).front();
  const auto spin = about_axis(slide);
  EXPECT_LT(root(slide.smooth, spin), 0.05 * root(slide.whole, spin));
  EXPECT_GT(root(slide.whole, spin), 2 * std::sqrt(slide.tilt) * root(slide.speed, spin));
}

// Of a turn about the axis a facet feels nothing in the mean, a part of a flat does.
TEST(Slides, parts_of_flats_are_no_facets)
{
  const Communicator comm;
  for (const int faces : {1, 2, 5}) {
    Pair pair;
    pair.options.obstacle = Obstacle{};
    pair.secondary = surface(
        {16 * faces, 4, 0, 16, 0, 10, true},
        [&](double x, double z) {
          const auto corner = [](double k) {
            return Point(10 * std::cos(k * std::numbers::pi / 8), 10 * std::sin(k * std::numbers::pi / 8), 0);
          };
          const double k = std::min(std::floor(x + 1e-9), 15.0), part = x - k;
          return Point((1 - part) * corner(k) + part * corner(k + 1) + z * Point::UnitZ());
        },
        comm);
    const auto slide = sliding_surfaces({&pair, 1}, {}, fem::Kinematics::solid, comm).front();
    const auto spin = about_axis(slide);
    const double means = slide.of_faces.cwiseProduct(spin * spin.transpose()).sum(), whole = std::pow(root(slide.whole, spin), 2);
    EXPECT_NEAR(means / whole, 1 - 1.0 / (faces * faces), 1e-6) << faces << " faces a flat";
  }
}

// Edges of 45 degrees are teeth where they tilt faces, and facets of a coarse torus where all do.
TEST(Slides, sharp_edges_tilt_faces_with_kinks_alone)
{
  const Communicator comm;
  Pair pair;
  pair.options.obstacle = Obstacle{};
  const auto at = [](double k, double z) {
    return Point(10 * std::cos(k * std::numbers::pi / 4), 10 * std::sin(k * std::numbers::pi / 4), z);
  };
  pair.secondary = surface({7, 4, 0, 7, 0, 10, true}, at, comm);
  const auto slide = sliding_surfaces({&pair, 1}, {}, fem::Kinematics::solid, comm).front();
  EXPECT_NEAR(slide.tilt, 0, 1e-12);
  const double half = 2 * std::sin(std::numbers::pi / 16);        // of the angle, as a distance of normals
  EXPECT_NEAR(slide.tilt_with_kinks, half * half * 6 / 7, 1e-9);  // those at both ends have one edge
}

}  // namespace
}  // namespace mortise::contact
