#include "fem/element.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace mortise::fem {
namespace {

using mesh::CellType;
const std::vector<CellType> all_types{CellType::line2, CellType::tri3, CellType::quad4,
                                      CellType::tet4,  CellType::hex8, CellType::prism6};

TEST(Element, ShapeFunctionsArePartitionsOfUnity)
{
  for (const auto type : all_types) {
    const auto& e = element(type);
    for (std::size_t q = 0; q < e.points(); ++q) {
      EXPECT_NEAR(e.shape[q].sum(), 1, 1e-14);
      EXPECT_LT(e.gradient[q].colwise().sum().cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(Element, WeightsSumToTheReferenceVolume)
{
  const std::vector<double> volume{2, 0.5, 4, 1.0 / 6, 8, 1};
  for (std::size_t t = 0; t < all_types.size(); ++t) {
    const auto& e = element(all_types[t]);
    EXPECT_NEAR(std::accumulate(e.weight.begin(), e.weight.end(), 0.0), volume[t], 1e-14);
    for (const double w : e.weight) EXPECT_GT(w, 0);
  }
}

// Values at the points of a field with given nodal values extrapolate to those nodal values where points suffice, else to a
// constant.
TEST(Element, ExtrapolationInvertsInterpolation)
{
  for (const auto type : all_types) {
    const auto& e = element(type);
    EXPECT_LT((e.extrapolation.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
    if (static_cast<int>(e.points()) < e.nodes) continue;
    Eigen::MatrixXd interpolation(static_cast<Eigen::Index>(e.points()), e.nodes);
    for (std::size_t q = 0; q < e.points(); ++q) interpolation.row(static_cast<Eigen::Index>(q)) = e.shape[q].transpose();
    EXPECT_TRUE((e.extrapolation * interpolation).isIdentity(1e-12));
  }
}

}  // namespace
}  // namespace mortise::fem
