#include "base/dense.hpp"

#include <gtest/gtest.h>

namespace mortise::dense {
namespace {

TEST(Dense, AMatrixThatIsNearlySingularHasNoInverse)
{
  const Eigen::Matrix3d a{{2, 1, 0}, {1, 3, 1}, {0, 0, 1e-8}};
  const auto found = inverse(a, 1e-10);
  ASSERT_TRUE(found);
  EXPECT_LT((*found * a - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_FALSE(inverse(a, 1e-7));
  EXPECT_FALSE(inverse(Eigen::Matrix3d::Zero(), 1e-100));
}

}  // namespace
}  // namespace mortise::dense
