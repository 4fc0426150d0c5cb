#include "fem/element.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "mesh/shape_functions.hpp"

namespace mortise::fem {
namespace {

using mesh::CellType;

std::vector<CellType> all_types()
{
  std::vector<CellType> all;
  for (std::size_t t = 0; t < mesh::cell_types; ++t) all.push_back(static_cast<CellType>(t));
  return all;
}

TEST(Element, ShapeFunctionsArePartitionsOfUnity)
{
  for (const auto type : all_types()) {
    const auto& e = element(type);
    for (std::size_t q = 0; q < e.points(); ++q) {
      EXPECT_NEAR(e.shape[q].sum(), 1, 1e-14);
      EXPECT_LT(e.gradient[q].colwise().sum().cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(Element, WeightsSumToTheReferenceVolume)
{
  const std::map<CellType, double> volume{{CellType::line2, 2},      {CellType::tri3, 0.5}, {CellType::quad4, 4},
                                          {CellType::tet4, 1.0 / 6}, {CellType::hex8, 8},   {CellType::prism6, 1}};
  for (const auto type : all_types()) {
    const auto& e = element(type);
    EXPECT_NEAR(std::accumulate(e.weight.begin(), e.weight.end(), 0.0), volume.at(mesh::first_order(type)), 1e-14);
    for (const double w : e.weight) EXPECT_GT(w, 0);
  }
}

// The rules integrate products of two shape functions of second order cells exactly, those of first order products of gradients.
TEST(Element, RulesAreExact)
{
  // x^4 over the reference cell; triangles and tetrahedra have the integral 4! / (4 + d)!.
  const std::map<CellType, double> exact{{CellType::line3, 0.4},       {CellType::tri6, 1.0 / 30}, {CellType::quad8, 0.8},
                                         {CellType::tet10, 1.0 / 210}, {CellType::hex20, 1.6},     {CellType::prism15, 1.0 / 15}};
  for (const auto& [type, value] : exact) {
    const auto& e = element(type);
    const auto& nodes = mesh::shape_functions(type).nodes();
    double sum = 0;
    for (std::size_t q = 0; q < e.points(); ++q) {
      double x = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) x += e.shape[q][static_cast<Eigen::Index>(i)] * nodes[i][0];
      sum += e.weight[q] * x * x * x * x;
    }
    EXPECT_NEAR(sum, value, 1e-14) << mesh::name(type);
  }
}

// Values at the points of a function that cells of first order hold extrapolate to its values at all nodes where points suffice,
// else to a constant.
TEST(Element, ExtrapolationInvertsInterpolation)
{
  for (const auto type : all_types()) {
    const auto& e = element(type);
    EXPECT_LT((e.extrapolation.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
    const auto& linear = mesh::shape_functions(mesh::first_order(type));
    if (static_cast<int>(e.points()) < linear.count()) continue;
    const auto& nodes = mesh::shape_functions(type).nodes();
    Eigen::MatrixXd at_points(static_cast<Eigen::Index>(e.points()), linear.count()), at_nodes(e.nodes, linear.count());
    Eigen::VectorXd value(linear.count());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      linear.evaluate(nodes[i], value);
      at_nodes.row(static_cast<Eigen::Index>(i)) = value.transpose();
    }
    for (std::size_t q = 0; q < e.points(); ++q) {
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < nodes.size(); ++i) x += e.shape[q][static_cast<Eigen::Index>(i)] * nodes[i];
      linear.evaluate(x, value);
      at_points.row(static_cast<Eigen::Index>(q)) = value.transpose();
    }
    EXPECT_LT((e.extrapolation * at_points - at_nodes).norm(), 1e-12) << mesh::name(type);
  }
}

}  // namespace
}  // namespace mortise::fem
