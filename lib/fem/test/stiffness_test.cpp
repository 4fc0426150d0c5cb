#include "fem/stiffness.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "fem/loads.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

TEST(Stiffness, RigidMotionsHaveNoEnergyAndAreOrthonormal)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 2, 2}, {3, 1, 2});
    block.distort(0.05, true);
    for (auto& p : block.mesh.points) p += Point(100, -40, block.dimension == 3 ? 7 : 0);  // far from the origin
    const auto r = rigid_motions(block.mesh.points, kinematics);
    const auto k = dense(stiffness(block.mesh, steel(), kinematics));
    ASSERT_EQ(r.cols(), block.dimension == 3 ? 6 : 3);
    EXPECT_TRUE((r.transpose() * r).isIdentity(1e-13)) << name;
    EXPECT_LT((k * r).norm(), 1e-11 * k.norm()) << name;
  }
}

// Panels of boundary elements, and cells of a plane model in space.
TEST(Stiffness, IsOfCellsOfTheModelsDimensionAlone)
{
  for (const char* name : {"tri3", "quad4"})
    EXPECT_THROW(stiffness(Block(name, {2, 2, 1}).mesh, steel(), Kinematics::solid), Error);
  EXPECT_THROW(stiffness(Block("tet4", {2, 2, 2}).mesh, steel(), Kinematics::plane_strain), Error);
}

// A single cell resists everything but rigid motions: no hourglass, no negative eigenvalue.
TEST(Stiffness, OfOneCellHasTheRankOfTheElement)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {1, 1, 1});
    block.distort(0.08, true);
    mesh::Mesh one;
    one.cell_id = {0};
    const auto nodes = block.mesh.cells[0];
    std::vector<Local> local(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      one.points.push_back(block.mesh.points[static_cast<std::size_t>(nodes[i])]);
      local[i] = static_cast<Local>(i);
    }
    one.cells.add(block.mesh.cells.type[0], local);
    const auto values = dense::symmetric_eigenvalues(dense(stiffness(one, steel(), kinematics)));
    const int rigid = block.dimension == 3 ? 6 : 3;
    EXPECT_LT(values.head(rigid).cwiseAbs().maxCoeff(), 1e-12 * values.maxCoeff()) << name;
    EXPECT_GT(values[rigid], 1e-4 * values.maxCoeff()) << name;
  }
}

// The patch test: a linear displacement on a distorted mesh has its exact energy, and no interior node feels a force.
TEST(Stiffness, PassesThePatchTest)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 3, 3}, {1, 2, 1.5});
    block.distort(0.07);
    const auto gradient = some_gradient(block.dimension);
    const auto u = sample(block.mesh, block.dimension, [&](const Point& x) { return Point(gradient * x); });
    const auto k = dense(stiffness(block.mesh, steel(), kinematics));
    const Eigen::VectorXd force = k * u;
    const double density = (hooke(gradient, steel(), kinematics).array() * gradient.array()).sum();
    EXPECT_NEAR(u.dot(force), density * block.measure(), 1e-11 * density) << name;
    std::size_t inside = 0;
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
      if (block.on_surface(n)) continue;
      ++inside;
      EXPECT_LT(force.segment(static_cast<Eigen::Index>(n) * block.dimension, block.dimension).norm(), 1e-12 * force.norm())
          << name;
    }
    EXPECT_GE(inside, block.dimension == 3 ? 8u : 4u);
  }
}

class Formulations : public testing::TestWithParam<std::tuple<Formulation, Case>> {};
INSTANTIATE_TEST_SUITE_P(Cells, Formulations,
                         testing::Values(std::tuple(Formulation::bbar, Case{"hex8", Kinematics::solid}),
                                         std::tuple(Formulation::bbar, Case{"prism6", Kinematics::solid}),
                                         std::tuple(Formulation::bbar, Case{"quad4", Kinematics::plane_strain}),
                                         std::tuple(Formulation::incompatible, Case{"hex8", Kinematics::solid}),
                                         std::tuple(Formulation::incompatible, Case{"quad4", Kinematics::plane_strain}),
                                         std::tuple(Formulation::incompatible, Case{"quad4", Kinematics::plane_stress})));

// On a distorted mesh: rigid motions have no energy, nothing else has none, and linear displacements have theirs.
TEST_P(Formulations, KeepKernelRankAndPatchTest)
{
  const auto& [formulation, kind] = GetParam();
  Block block(kind.element, {3, 3, 3}, {1, 2, 1.5});
  block.distort(0.07);
  const int d = block.dimension;
  const auto k = dense(stiffness(block.mesh, steel(), kind.kinematics, formulation));
  const auto r = rigid_motions(block.mesh.points, kind.kinematics);
  EXPECT_LT((k * r).norm(), 1e-11 * k.norm());
  const auto values = dense::symmetric_eigenvalues(k);
  EXPECT_GT(values[r.cols()], 1e-5 * values.maxCoeff());
  const auto gradient = some_gradient(d);
  const auto u = sample(block.mesh, d, [&](const Point& x) { return Point(gradient * x); });
  const double density = (hooke(gradient, steel(), kind.kinematics).array() * gradient.array()).sum();
  EXPECT_NEAR(u.dot(k * u), density * block.measure(), 1e-11 * density);
  const Eigen::VectorXd force = k * u;
  for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
    if (block.on_surface(n)) continue;
    EXPECT_LT(force.segment(static_cast<Eigen::Index>(n) * d, d).norm(), 1e-12 * force.norm());
  }
}

// One layer of cells bends as beam theory says.
TEST(Formulations, IncompatibleModesBend)
{
  for (const auto& [name, kinematics] : {Case{"hex8", Kinematics::solid}, Case{"quad4", Kinematics::plane_stress}}) {
    const double length = 8, e = 1000, force = 0.01;
    Block block(name, {16, 1, 1}, {length, 1, 0.5});
    const int d = block.dimension;
    const double width = d == 3 ? 0.5 : 1.0;
    auto k = stiffness(block.mesh, Material{e, 0.0, 0, 0}, kinematics, Formulation::incompatible);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(k.rows());
    add_traction(block.mesh, block.boundary("xmax"), kinematics, Point(0, force / width, 0), f);
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n)
      if (block.mesh.points[n][0] < 1e-9)
        for (int c = 0; c < d; ++c) k.coeffRef(static_cast<int>(n) * d + c, static_cast<int>(n) * d + c) += 1e9 * e;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double, Eigen::ColMajor, int>> solver(k);
    const Eigen::VectorXd u = solver.solve(f);
    const double beam = force * std::pow(length, 3) / (3 * e * width / 12) + force * length / (5.0 / 6 * 0.5 * e * width);
    EXPECT_NEAR(f.dot(u) / force / beam, 1, 0.01) << name;
  }
}

// A thick ring of nearly incompressible material under pressure inside: Lame's displacement, which full integration misses by
// far.
TEST(Formulations, BbarDoesNotLock)
{
  const Material rubber{1000, 0.4999, 0, 0};
  const double inner = 1, outer = 2, pressure = 10;
  const double e = rubber.young_modulus, nu = rubber.poisson_ratio;
  const double exact =
      (1 + nu) * pressure * inner / e * ((1 - 2 * nu) * inner * inner + outer * outer) / (outer * outer - inner * inner);
  const auto expansion = [&](Formulation formulation) {
    Block block("quad4", {8, 8, 0});
    for (auto& p : block.mesh.points) {  // x: radius, y: angle
      const double radius = inner + (outer - inner) * p[0], angle = std::acos(-1.0) / 2 * p[1];
      p = Point(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    auto k = stiffness(block.mesh, rubber, Kinematics::plane_strain, formulation);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(k.rows());
    add_pressure(block.mesh, block.boundary("xmin"), Kinematics::plane_strain, pressure, f);
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n)
      for (int c = 0; c < 2; ++c)
        if (std::abs(block.mesh.points[n][c]) < 1e-9)
          k.coeffRef(static_cast<int>(n) * 2 + c, static_cast<int>(n) * 2 + c) += 1e9 * e;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double, Eigen::ColMajor, int>> solver(k);
    const Eigen::VectorXd u = solver.solve(f);
    double sum = 0;
    int count = 0;
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n)
      if (std::abs(block.mesh.points[n].norm() - inner) < 1e-9) {
        sum += u.segment<2>(static_cast<Eigen::Index>(n) * 2).norm();
        ++count;
      }
    return sum / count;
  };
  EXPECT_NEAR(expansion(Formulation::bbar) / exact, 1, 0.01);
  EXPECT_LT(expansion(Formulation::standard) / exact, 0.9);
}

// Turned with its mesh, the stiffness turns with it: K' = T K T'.
TEST(Stiffness, IsInvariantUnderRotation)
{
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.8, Point(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Matrix3d turn_in_plane = Eigen::AngleAxisd(0.8, Point(0, 0, 1)).toRotationMatrix();
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {2, 2, 2});
    block.distort(0.06, true);
    const int d = block.dimension;
    const Eigen::MatrixXd q = (d == 3 ? rotation : turn_in_plane).topLeftCorner(d, d);
    const auto k = dense(stiffness(block.mesh, steel(), kinematics));
    for (auto& p : block.mesh.points) p.head(d) = q * p.head(d);
    const auto rotated = dense(stiffness(block.mesh, steel(), kinematics));
    Eigen::MatrixXd t = Eigen::MatrixXd::Zero(k.rows(), k.cols());
    for (Eigen::Index n = 0; n < k.rows(); n += d) t.block(n, n, d, d) = q;
    EXPECT_LT((rotated - t * k * t.transpose()).norm(), 1e-12 * k.norm()) << name;
  }
}

// The matrix of a cell is used again for the next one only if that is really its translate.
TEST(Stiffness, NearlyCongruentCellsKeepTheirOwnMatrix)
{
  for (const double stretch : {0.0, 1e-9, 1e-5}) {
    Block block("hex8", {2, 1, 1}, {2, 1, 1});
    for (auto& p : block.mesh.points)
      if (p[0] > 1.5) p[0] += stretch;
    const auto both = dense(stiffness(block.mesh, steel(), Kinematics::solid));
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(both.rows(), both.cols());
    for (std::size_t c = 0; c < 2; ++c) {
      auto alone = block.mesh;
      alone.cells = {};
      alone.cells.add(mesh::CellType::hex8, block.mesh.cells[c]);
      sum += dense(stiffness(alone, steel(), Kinematics::solid));
    }
    EXPECT_LT((both - sum).norm(), 1e-14 * sum.norm()) << stretch;
  }
}

TEST(Stiffness, CellInsideOutIsNamed)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {2, 2, 2});
    // Its first edge runs the other way; one in the middle of a curved one lies beyond its end.
    const auto nodes =
        block.mesh.cells.nodes.end() - static_cast<std::ptrdiff_t>(block.mesh.cells[block.mesh.cells.size() - 1].size());
    std::swap(nodes[0], nodes[1]);
    const auto type = block.mesh.cells.type[0];
    if (type != mesh::first_order(type)) {
      auto& middle = block.mesh.points[static_cast<std::size_t>(nodes[mesh::corner_count(type)])];
      middle += 3 * (block.mesh.points[static_cast<std::size_t>(nodes[0])] - middle);
    }
    try {
      stiffness(block.mesh, steel(), kinematics);
      FAIL() << "no error for " << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::bad_input);
      EXPECT_NE(std::string(error.what()).find("turned inside out"), std::string::npos) << error.what();
    }
  }
}

// Timoshenko's cantilever, Poisson's ratio 0: F L^3 / 3 E I + F L / (5/6 G A). Linear cells are too stiff: multilinear ones
// by 1 + (dx / 4 dy)^2 / 2 = 1 + 1 / 32 with four layers of squares, those of triangles, also extruded ones, and tetrahedra by
// more. Those of second order need a quarter of the layers.
TEST(Stiffness, CantileverBendsAsBeamTheorySays)
{
  struct Expectation {
    Case kind;
    double least;
    bool coarse = false;
  };
  for (const auto& [kind, least, coarse] :
       {Expectation{{"hex8", Kinematics::solid}, 0.965}, Expectation{{"prism6", Kinematics::solid}, 0.8},
        Expectation{{"tet4", Kinematics::solid}, 0.7}, Expectation{{"quad4", Kinematics::plane_stress}, 0.965},
        Expectation{{"tri3", Kinematics::plane_stress}, 0.8}, Expectation{{"hex20", Kinematics::solid}, 0.99, true},
        Expectation{{"hex27", Kinematics::solid}, 0.99, true}, Expectation{{"tet10", Kinematics::solid}, 0.98, true},
        Expectation{{"prism15", Kinematics::solid}, 0.98, true}, Expectation{{"quad8", Kinematics::plane_stress}, 0.99, true},
        Expectation{{"quad9", Kinematics::plane_stress}, 0.99, true},
        Expectation{{"tri6", Kinematics::plane_stress}, 0.98, true}}) {
    const double length = 8, e = 1000;
    Block block(kind.element, coarse ? std::array{8, 1, 1} : std::array{32, 4, 2}, {length, 1, 0.5});
    const int d = block.dimension;
    const double width = d == 3 ? 0.5 : 1.0, force = 0.01;
    auto k = stiffness(block.mesh, Material{e, 0.0, 0, 0}, kind.kinematics);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(k.rows());
    add_traction(block.mesh, block.boundary("xmax"), kind.kinematics, Point(0, force / width, 0), f);
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n)
      if (block.mesh.points[n][0] < 1e-9)
        for (int c = 0; c < d; ++c) k.coeffRef(static_cast<int>(n) * d + c, static_cast<int>(n) * d + c) += 1e9 * e;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double, Eigen::ColMajor, int>> solver(k);
    const Eigen::VectorXd u = solver.solve(f);
    const double tip = f.dot(u) / force;  // mean over the loaded end
    const double inertia = width / 12, shear = 5.0 / 6 * 0.5 * e * width;
    const double beam = force * std::pow(length, 3) / (3 * e * inertia) + force * length / shear;
    EXPECT_GT(tip / beam, least) << kind.element;
    EXPECT_LT(tip / beam, 1.01) << kind.element;
  }
}

}  // namespace
}  // namespace mortise::fem
