#include "mesh/cell.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "mesh/shape_functions.hpp"

namespace mortise::mesh {
namespace {

class Cell : public testing::TestWithParam<int> {
 protected:
  CellType type() const { return static_cast<CellType>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Types, Cell, testing::Range(0, static_cast<int>(cell_types)),
                         [](const auto& info) { return std::string(name(static_cast<CellType>(info.param))); });

// Our nodes are where gmsh says that its are.
TEST_P(Cell, HasItsNodesInTheOrderOfGmsh)
{
  static const std::map<std::string_view, int> numbers{
      {"line2", 1},  {"tri3", 2},   {"quad4", 3},  {"tet4", 4},     {"hex8", 5},   {"prism6", 6}, {"line3", 8},   {"tri6", 9},
      {"quad9", 10}, {"tet10", 11}, {"hex27", 12}, {"prism18", 13}, {"quad8", 16}, {"hex20", 17}, {"prism15", 18}};
  gmsh::initialize(0, nullptr, false);
  std::string theirs;
  int d = 0, o = 0, nodes = 0, primary = 0;
  std::vector<double> at;
  gmsh::model::mesh::getElementProperties(numbers.at(name(type())), theirs, d, o, nodes, at, primary);
  gmsh::finalize();
  EXPECT_EQ(d, mesh::dimension(type()));
  ASSERT_EQ(nodes, node_count(type()));
  const auto& reference = shape_functions(type()).nodes();
  for (std::size_t n = 0; n < reference.size(); ++n)
    for (std::size_t c = 0; c < static_cast<std::size_t>(d); ++c)
      EXPECT_NEAR(reference[n][static_cast<Eigen::Index>(c)], at[n * static_cast<std::size_t>(d) + c], 1e-15) << n;
}

TEST_P(Cell, HasShapeFunctionsWithRightGradients)
{
  const auto& functions = shape_functions(type());
  const int d = mesh::dimension(type());
  Eigen::VectorXd value(functions.count()), step(functions.count());
  for (int n = 0; n < functions.count(); ++n) {
    functions.evaluate(functions.nodes()[static_cast<std::size_t>(n)], value);
    EXPECT_LT((value - Eigen::VectorXd::Unit(functions.count(), n)).norm(), 1e-13);
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 0.4);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < d; ++c) x[c] = uniform(random);
  Eigen::MatrixXd gradient;
  functions.evaluate(x, value, &gradient);
  EXPECT_NEAR(value.sum(), 1, 1e-13);
  for (int c = 0; c < d; ++c) {
    const double h = 1e-4;
    Eigen::VectorXd other(functions.count());
    functions.evaluate(x + h * Eigen::Vector3d::Unit(c), step);
    functions.evaluate(x - h * Eigen::Vector3d::Unit(c), other);
    EXPECT_LT((gradient.col(c) - (step - other) / (2 * h)).norm(), 1e-7);
  }
}

// Restricted to a face, the functions of its nodes are those of the face, and all others vanish.
TEST_P(Cell, HasFacesOfItsOwnFunctions)
{
  const auto& functions = shape_functions(type());
  for (const auto& face : faces(type())) {
    ASSERT_EQ(static_cast<int>(face.nodes.size()), node_count(face.type));
    const auto& on_face = shape_functions(face.type);
    Eigen::VectorXd theirs(on_face.count()), ours(functions.count());
    const Eigen::Vector3d at(0.31, mesh::dimension(face.type) == 2 ? 0.27 : 0, 0);
    on_face.evaluate(at, theirs);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < face.nodes.size(); ++i)
      x += theirs[static_cast<Eigen::Index>(i)] * functions.nodes()[static_cast<std::size_t>(face.nodes[i])];
    functions.evaluate(x, ours);
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      EXPECT_NEAR(ours[face.nodes[i]], theirs[static_cast<Eigen::Index>(i)], 1e-13);
      ours[face.nodes[i]] = 0;
    }
    EXPECT_LT(ours.norm(), 1e-13);
  }
}

TEST(CellType, IsFoundByItsName)
{
  EXPECT_EQ(cell_type("prism15"), CellType::prism15);
  EXPECT_FALSE(cell_type("hex21"));
}

}  // namespace
}  // namespace mortise::mesh
