// Places of curved cells, found again from their coordinates.
#include "mesh/inverse_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mesh/shape_functions.hpp"

namespace mortise::mesh {
namespace {

class InverseMap : public testing::TestWithParam<int> {
 protected:
  CellType type() const { return static_cast<CellType>(GetParam()); }

  // Sheared, and every node moved by up to a twentieth; a plane cell stays in its plane.
  std::vector<Point> nodes()
  {
    std::uniform_real_distribution<double> uniform(-0.05, 0.05);
    const Eigen::Matrix3d shear = (Eigen::Matrix3d() << 2, 0.3, 0.1, 0.2, 1, -0.2, 0, 0.4, 0.5).finished();
    std::vector<Point> result;
    for (const auto& n : shape_functions(type()).nodes()) {
      Point moved = n;
      for (int c = 0; c < dimension(type()); ++c) moved[c] += uniform(random_);
      result.push_back(shear * moved + Point(10, 20, 30));
      if (dimension(type()) == 2) result.back()[2] = 0;
    }
    return result;
  }
  // In the reference cell: a mean of its corners.
  Eigen::Vector3d somewhere()
  {
    std::exponential_distribution<double> weight;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double total = 0;
    for (int k = 0; k < corner_count(type()); ++k) {
      const double w = weight(random_);
      sum += w * shape_functions(type()).nodes()[static_cast<std::size_t>(k)];
      total += w;
    }
    return sum / total;
  }
  Point at(const std::vector<Point>& nodes, const Eigen::Vector3d& reference) const
  {
    Eigen::VectorXd value(shape_functions(type()).count());
    shape_functions(type()).evaluate(reference, value);
    Point x = Point::Zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) x += value[static_cast<Eigen::Index>(i)] * nodes[i];
    return x;
  }

 private:
  std::mt19937 random_{7};
};

TEST_P(InverseMap, FindsAnyPlaceOfTheCell)
{
  for (int i = 0; i < 50; ++i) {
    const auto cell = nodes();
    const auto reference = somewhere();
    const auto found = find_in_cell(type(), cell, at(cell, reference));
    EXPECT_LT(found.distance, 1e-12);
    EXPECT_LT((found.reference - reference).norm(), 1e-10);
  }
  const auto cell = nodes();
  for (const auto& corner : shape_functions(type()).nodes())
    EXPECT_LT(find_in_cell(type(), cell, at(cell, corner)).distance, 1e-12);
}

// A place a little outside is as far from the cell as it says; one far away is not near.
TEST_P(InverseMap, TellsHowFarOutsideAPlaceIs)
{
  const auto cell = nodes();
  const auto& corners = shape_functions(type()).nodes();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int k = 0; k < corner_count(type()); ++k) middle += corners[static_cast<std::size_t>(k)] / corner_count(type());
  const Point corner = cell.front(), outward = (corner - at(cell, middle)).normalized();
  for (const double distance : {1e-6, 1e-3, 0.05}) {
    const auto found = find_in_cell(type(), cell, corner + distance * outward);
    EXPECT_GT(found.distance, 0.1 * distance);
    EXPECT_LT(found.distance, 5 * distance);
    EXPECT_NEAR((at(cell, found.reference) - corner - distance * outward).norm(), found.distance, 1e-14);
  }
  EXPECT_GT(find_in_cell(type(), cell, corner + 20 * outward).distance, 10);
}

std::string name_of(const testing::TestParamInfo<int>& info)
{
  return std::string(name(static_cast<CellType>(info.param)));
}

std::vector<int> cells_of_bodies()
{
  std::vector<int> result;
  for (int t = 0; t < static_cast<int>(cell_types); ++t)
    if (dimension(static_cast<CellType>(t)) > 1) result.push_back(t);
  return result;
}

INSTANTIATE_TEST_SUITE_P(Types, InverseMap, testing::ValuesIn(cells_of_bodies()), name_of);

}  // namespace
}  // namespace mortise::mesh
