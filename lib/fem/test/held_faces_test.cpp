// What a pad between two held sides lacks, against energies of pads on fine meshes of second order.
#include "fem/held_faces.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fem/stress.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

constexpr double width = 20, height = 4;

// A pad of one layer of cells across y, its displacement, and its faces of x = 0 and x = width, or between its cells.
struct Pad {
  Block block;
  Material material;
  Kinematics kinematics = Kinematics::plane_strain;
  std::vector<HeldFace> faces = {};

  Pad(const char* element, double nu, double traction = 0, bool slides = false)
      : block(element, {5, 1, 1}, {width, height, 1}), material{5, nu, 0, 0}
  {
    if (block.dimension == 3) kinematics = Kinematics::solid;
    const bool between = std::isnan(traction);
    for (std::size_t c = 0; c < block.mesh.cells.size(); ++c) {
      const auto& own = mesh::faces(block.mesh.cells.type[c]);
      for (std::size_t f = 0; f < own.size(); ++f) {
        Point middle = Point::Zero();
        double least = height, most = 0;
        for (const int k : own[f].nodes) {
          const Point& x = block.mesh.points[static_cast<std::size_t>(block.mesh.cells[c][static_cast<std::size_t>(k)])];
          middle += x / static_cast<double>(own[f].nodes.size());
          least = std::min(least, x[1]);
          most = std::max(most, x[1]);
        }
        const bool end = middle[0] < 1e-9 || middle[0] > width - 1e-9;
        const bool inside = !end && (block.dimension == 2 || (middle[2] > 1e-9 && middle[2] < 1 - 1e-9));
        if (most - least > height / 2 && (between ? inside : end))
          faces.push_back({static_cast<Local>(c), static_cast<int>(f), Point::UnitY(), traction, slides, false});
      }
    }
  }
  template <class Field>
  HeldFaceErrors errors(const Field& u, Formulation formulation = Formulation::standard) const
  {
    const auto at_nodes = sample(block.mesh, block.dimension, u);
    const auto field = stresses(block.mesh, material, kinematics, at_nodes, formulation);
    const Eigen::MatrixXd recovered = field.nodal_sums.leftCols(6).array().colwise() / field.nodal_sums.col(6).array();
    auto result = errors_of_held_faces(block.mesh, material, kinematics, at_nodes, recovered, faces, formulation);
    EXPECT_LE(result.norm, (2 + 1e-9) * field.strain_energy);
    result.norm = 2 * field.strain_energy;  // of all cells, between which nothing is left
    return result;
  }
  double mu() const { return material.young_modulus / (2 * (1 + material.poisson_ratio)); }
  double uniaxial() const { return 2 * mu() * (1 - material.poisson_ratio) / (1 - 2 * material.poisson_ratio); }
};

const auto pressed = [](const Point& x) { return Point(0, -0.02 * x[1], 0); };
const auto sheared = [](const Point& x) { return Point(0.05 * x[1], 0, 0); };

// A pad 20 x 4, pressed with 2 % or sheared by 5 %, has the true errors that stand here, over its own norm.
TEST(HeldFaces, OfAPadAreItsTrueError)
{
  struct Case {
    double nu, true_pressed, true_sheared;
  };
  for (const auto& [nu, true_pressed, true_sheared] : {Case{0.3, 0.203, 0.251}, {0.45, 0.508, 0.224}, {0.49, 0.802, 0.213}})
    for (const auto* element : {"quad4", "tri3", "hex8", "prism6", "tet4"}) {
      const Pad pad(element, nu);
      const auto press = pad.errors(pressed), shear = pad.errors(sheared);
      const double all = press.norm * std::tanh(press.squared.sum() / press.norm);
      EXPECT_GT(std::sqrt(press.squared.sum() / press.norm), 0.95 * true_pressed) << element << nu;
      EXPECT_LT(std::sqrt(all / press.norm), 1.1 * true_pressed) << element << nu;
      EXPECT_NEAR(std::sqrt(shear.squared.sum() / shear.norm), true_sheared, 0.16 * true_sheared) << element << nu;
    }
}

// By the formula, also of bbar.
TEST(HeldFaces, OfThePressedPad)
{
  for (const auto formulation : {Formulation::standard, Formulation::bbar}) {
    const Pad pad("quad4", 0.49);
    const auto found = pad.errors(pressed, formulation);
    const double t = 0.02 * (pad.uniaxial() - 2 * pad.mu()), h = height;
    ASSERT_EQ(found.squared.size(), 2);
    for (const double squared : found.squared)
      EXPECT_NEAR(squared, h * h * t * t / std::sqrt(12 * pad.mu() * pad.uniaxial()), 1e-9 * squared);
  }
}

// Loads that give the traction leave nothing of it.
TEST(HeldFaces, KnownTractions)
{
  const Pad bare("quad4", 0.3);
  const double t = 0.02 * (bare.uniaxial() - 2 * bare.mu());
  EXPECT_LT(Pad("quad4", 0.3, -t).errors(pressed).squared.sum(), 1e-20 * bare.errors(pressed).norm);
  EXPECT_NEAR(Pad("quad4", 0.3, t).errors(pressed).squared.sum(), 4 * bare.errors(pressed).squared.sum(), 1e-9);
}

// Between cells nothing is left where stress is uniform; where nodes slide along a side, jumps tell displacements across that are
// linear and not a parabola: with sigma_x' = g g^2 h^3 / (12 mu) for each length.
TEST(HeldFaces, BetweenCells)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(Pad("hex8", 0.3, nan, true).errors(pressed).squared.sum(), 1e-20);
  const auto stretched = [](const Point& x) { return Point(1e-3 * x[0] * x[0], 0, 0); };
  EXPECT_EQ(Pad("quad4", 0.3, nan).errors(stretched).squared.sum(), 0);
  EXPECT_EQ(Pad("tri3", 0.3, nan, true).errors(stretched).squared.sum(), 0);
  const Pad pad("quad4", 0.4999, nan, true);
  const double g = 2e-3 * pad.uniaxial(), length = 16;  // of four faces between five cells
  EXPECT_NEAR(pad.errors(stretched).squared.sum(), g * g * std::pow(height, 3) / (12 * pad.mu()) * length,
              1e-6 * pad.errors(stretched).squared.sum());
}

// Where only one side is held shear counts alone, and near Poisson's ratio 0.5 alone; faces that go on as the side does not.
TEST(HeldFaces, ThatEndInside)
{
  for (const double nu : {0.3, 0.49, 0.499}) {
    Pad pad("quad4", nu);
    const double shear = pad.errors(sheared).squared.sum();
    for (auto& face : pad.faces) face.ends_inside = true;
    EXPECT_NEAR(pad.errors(sheared).squared.sum(), nu < 0.45 ? 0 : shear, 0.01 * shear) << nu;
    EXPECT_LT(pad.errors(pressed).squared.sum(), 1e-20);
    for (auto& face : pad.faces) face.across = Point::UnitX();
    EXPECT_EQ(pad.errors(sheared).squared.sum(), 0);
  }
}

// In axisymmetry a face goes all round.
TEST(HeldFaces, Axisymmetric)
{
  Pad pad("quad4", 0.3);
  pad.kinematics = Kinematics::axisymmetric;
  const auto found = pad.errors(pressed);
  EXPECT_EQ(found.squared.minCoeff(), 0);  // on the axis
  EXPECT_NEAR(found.squared.maxCoeff(), 2 * M_PI * width * Pad("quad4", 0.3).errors(pressed).squared[0], 1e-9);
}

}  // namespace
}  // namespace mortise::fem
