#include "model/indefinite.hpp"

#include <gtest/gtest.h>

namespace mortise::model {
namespace {

partition::Subdomain two_tetrahedra(double height)
{
  partition::Subdomain subdomain;
  subdomain.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}, {0, 0, -height}};
  subdomain.mesh.cells.add(mesh::CellType::tet4, std::vector<Local>{0, 1, 2, 3});
  subdomain.mesh.cells.add(mesh::CellType::tet4, std::vector<Local>{0, 2, 1, 4});
  return subdomain;
}

std::string why(double height, const fem::Materials& materials)
{
  return why_indefinite(two_tetrahedra(height), materials, "plate");
}

TEST(Indefinite, NamesTheBodyAndWhatIsExtreme)
{
  const fem::Material steel{2e5, 0.3, 0, 0}, rubber{1e-5, 0.3, 0, 0}, water{1, 0.49999999, 0, 0};
  const std::string head =
      "the stiffness matrix of the body \"plate\" is not positive definite to the accuracy of numbers; probably:\n  ";
  EXPECT_EQ(why(1e-4, steel).rfind(head + "cells are up to 1.41e+04 times longer than thick (edges from 0.0001 to 1.41)", 0), 0U);
  EXPECT_EQ(why(1, water), head + "Poisson's ratio is 0.49999999: take at most 0.4999999");
  EXPECT_EQ(why(1, {{steel, rubber}, {0, 1}}).rfind(head + "Young's moduli are from 1e-05 to 2e+05", 0), 0U);
  EXPECT_NE(why(1, steel).find("look for cells without volume"), std::string::npos);
}

}  // namespace
}  // namespace mortise::model
