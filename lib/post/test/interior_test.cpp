// What is found inside bodies, against fields that both methods represent exactly. The same on any ranks.
#include "post/interior.hpp"

#include <gtest/gtest.h>

#include <random>

#include "bem/particular_solution.hpp"
#include "bem/plane_state.hpp"
#include "bem/steklov_poincare.hpp"
#include "bem/surface_stress.hpp"
#include "fem/stiffness.hpp"
#include "feti/dense_subdomain.hpp"
#include "partition/skins.hpp"
#include "testing/cut.hpp"

namespace mortise::post {
namespace {

const fem::Material steel{200, 0.3, 2, 1e-3};
constexpr double warmer = 5;
const Eigen::Matrix3d slope = (Eigen::Matrix3d() << 3, 2, -5, 7, -4, 1, 2.5, 9, 6).finished() * 1e-3;

// A block of finite elements and one of boundary elements on it, which touch at z = 1, in a plane at y = 1. Both are warmed; the
// upper one, its field being the sum of a particular solution and a linear one, has weight as well.
struct TwoMethods {
  fem::Kinematics kinematics;
  Communicator comm;
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  std::vector<fem::Constitution> constitution;
  std::vector<partition::CopyOf> copies;
  std::vector<std::shared_ptr<const feti::SubdomainOperator>> operators;
  std::vector<Eigen::VectorXd> displacement;

  TwoMethods(const std::string& element, int parts, fem::Kinematics kind = fem::Kinematics::solid) : kinematics(kind)
  {
    const int d = fem::dimension(kinematics);
    mesh::Options mesh;
    for (const char* name : {"fe", "be"}) {
      mesh.blocks[name].size = {2, 1, 1};
      mesh.blocks[name].cells = {4, 2, 3};
      mesh.blocks[name].element = element;
    }
    mesh.blocks["be"].origin[static_cast<std::size_t>(d) - 1] = 1;
    partition::Options options;
    options.method = "grid";
    options.counts["fe"] = options.counts["be"] = {parts, 1, 1};
    decomposition = partition::cut_of(mesh, options, comm, d);
    decomposition = partition::skins(std::move(decomposition), {true, false}, true, comm);
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const auto& subdomain = decomposition.subdomains[s];
      constitution.push_back(of(subdomain.skin));
      copies.push_back({s, {}});
      operators.emplace_back();
      if (subdomain.skin)
        operators.back() = std::make_shared<feti::DenseSubdomain>(
            d == 2 ? bem::steklov_poincare(bem::make_panels<2>(subdomain.mesh), in_plane())
                   : bem::steklov_poincare(bem::make_panels(subdomain.mesh), steel),
            fem::rigid_motions(subdomain.mesh.points, kinematics), subdomain.mesh.points, d);
      auto& u = displacement.emplace_back(d * static_cast<Eigen::Index>(subdomain.mesh.node_count()));
      for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
        u.segment(d * static_cast<Eigen::Index>(n), d) = moved(subdomain.mesh.points[n], subdomain.skin).head(d);
    }
    directory = std::make_unique<partition::NodeDirectory>(partition::even_directory(decomposition, comm));
    interface = partition::find_interface(decomposition, *directory, comm);
  }

  bool flat() const { return kinematics != fem::Kinematics::solid; }
  fem::Material in_plane() const { return bem::in_plane(steel, kinematics); }
  Eigen::Matrix3d gradient() const
  {
    Eigen::Matrix3d result = slope;
    if (flat()) result.row(2).setZero(), result.col(2).setZero();
    return result;
  }
  bool upper(const Point& x) const { return x[flat() ? 1 : 2] > 1; }
  fem::Constitution of(bool skin) const
  {
    const Point weight = flat() ? Point(3, -10, 0) : Point(3, 0, -10);
    return {steel, fem::Formulation::standard, warmer, skin ? weight : Point::Zero()};
  }
  bem::ParticularSolution particular(bool skin) const { return {of(skin), Point::Zero(), kinematics}; }
  Point moved(const Point& x, bool skin) const { return gradient() * x + particular(skin).displacement(x); }
  fem::Stress stress(const Point& x, bool skin) const
  {
    fem::Stress result = bem::components(bem::hooke(in_plane(), gradient())) + particular(skin).stress(x);
    if (flat()) result[2] = bem::stress_across_plane(of(skin), kinematics, result[0] + result[1]);
    return result;
  }
  ElasticBodies bodies() const { return {decomposition, interface, kinematics, constitution, 1, copies, operators}; }
  void expect_exact(const Values& values, std::size_t i, const Point& x, bool skin) const
  {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_LT((values.displacement.row(row).transpose() - moved(x, skin)).norm(), 1e-11) << x.transpose();
    EXPECT_LT((values.stress.row(row).transpose() - stress(x, skin)).norm(), 1e-8) << x.transpose();
  }
};

std::vector<Point> random_points(int count, bool flat)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Point> result;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    result.push_back(flat ? Point(2 * x, 2 * y, 0) : Point(2 * x, y, 2 * z));
  }
  return result;
}

void expect_exact_values(const TwoMethods& model)
{
  const auto points = random_points(60, model.flat());
  auto found = find_points(model.decomposition, model.kinematics, points, model.comm);
  ASSERT_TRUE(found.lost.empty());
  EXPECT_EQ(found.rows, 60);
  EXPECT_EQ(model.comm.sum(static_cast<long long>(found.mine.size())), 60);
  Probes probes;
  probes.cells = true;
  probes.points = found.mine;
  probes.rows = found.rows;
  auto stress = recover_stress(model.bodies(), model.displacement, model.comm);
  const auto largest = stress.largest_von_mises;
  const auto interior = evaluate_interior(model.bodies(), probes, model.displacement, stress, model.comm);
  EXPECT_GE(stress.largest_von_mises.value, largest.value);
  for (std::size_t i = 0; i < probes.points.size(); ++i) {
    const Point& x = points[probes.points[i].point];
    EXPECT_EQ(probes.points[i].body, model.upper(x) ? 0 : 1);
    model.expect_exact(interior.points, i, x, model.upper(x));
  }
  long long nodes = 0;
  for (std::size_t s = 0; s < model.decomposition.subdomains.size(); ++s) {
    const auto& subdomain = model.decomposition.subdomains[s];
    if (!subdomain.skin) {
      EXPECT_EQ(interior.nodes[s].stress.rows(), 0);
      continue;
    }
    for (std::size_t n = subdomain.mesh.node_count(); n < subdomain.inside.node_count(); ++n, ++nodes)
      model.expect_exact(interior.nodes[s], n - subdomain.mesh.node_count(), subdomain.inside.points[n], true);
    EXPECT_EQ(interior.cell_von_mises[s].size(), static_cast<Eigen::Index>(subdomain.inside.cells.size()));
    for (std::size_t c = 0; c < subdomain.inside.cells.size(); ++c) {  // a linear stress: that of the mean of the corners
      const auto type = subdomain.inside.cells.type[c];
      Point middle = Point::Zero();
      for (int k = 0; k < mesh::corner_count(type); ++k)
        middle += subdomain.inside.points[static_cast<std::size_t>(subdomain.inside.cells[c][static_cast<std::size_t>(k)])] /
                  mesh::corner_count(type);
      EXPECT_NEAR(interior.cell_von_mises[s][static_cast<Eigen::Index>(c)], fem::von_mises(model.stress(middle, true)), 1e-8);
    }
  }
  EXPECT_GT(model.comm.sum(nodes), 0);
}

class Inside : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(Inside, ValuesAreExact)
{
  expect_exact_values({std::get<0>(GetParam()), std::get<1>(GetParam())});
}

INSTANTIATE_TEST_SUITE_P(Cells, Inside,
                         testing::Combine(testing::Values("tet4", "hex8", "prism6", "hex20", "tet10"), testing::Values(1, 2)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::string(std::get<1>(info.param) > 1 ? "_cut" : "");
                         });

class InsideThePlane : public testing::TestWithParam<std::tuple<const char*, int, fem::Kinematics>> {};

TEST_P(InsideThePlane, ValuesAreExact)
{
  const auto [element, parts, kinematics] = GetParam();
  expect_exact_values({element, parts, kinematics});
}

INSTANTIATE_TEST_SUITE_P(Cells, InsideThePlane,
                         testing::Combine(testing::Values("quad4", "tri3", "quad8"), testing::Values(1, 2),
                                          testing::Values(fem::Kinematics::plane_strain, fem::Kinematics::plane_stress)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::string(std::get<1>(info.param) > 1 ? "_cut" : "") +
                                  (std::get<2>(info.param) == fem::Kinematics::plane_strain ? "_strain" : "_stress");
                         });

// The largest stress of a body under its weight is inside, where only the inside is asked.
TEST(Interior, TheLargestVonMisesStressMayBeInside)
{
  const TwoMethods model("hex8", 1);
  auto stress = recover_stress(model.bodies(), model.displacement, model.comm);
  stress.largest_von_mises = {1e-3, Point::Zero()};
  Probes probes;
  probes.cells = true;
  evaluate_interior(model.bodies(), probes, model.displacement, stress, model.comm);
  const auto& [value, at, body] = stress.largest_von_mises;
  EXPECT_EQ(model.decomposition.catalogue.bodies[static_cast<std::size_t>(body)].name, "be");
  EXPECT_GT(value, 1e-3);
  EXPECT_NEAR(value, fem::von_mises(model.stress(at, true)), 1e-8);
  EXPECT_TRUE(at[2] > 1 && at[2] < 2);
}

// Rows of all ranks: point and body.
std::vector<std::pair<long long, int>> rows_of(const FoundPoints& found, const Communicator& comm)
{
  struct Row {
    Global row;
    long long point;
    int body;
  };
  std::vector<Row> rows;
  for (const auto& p : found.mine) rows.push_back({p.row, static_cast<long long>(p.point), p.body});
  rows = comm.all_gather(rows);
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.row < b.row; });
  std::vector<std::pair<long long, int>> result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].row, static_cast<Global>(i));
    result.emplace_back(rows[i].point, rows[i].body);
  }
  return result;
}

// In several bodies where they touch, once in a body where it is cut, near the surface on it, and nowhere.
TEST(Interior, PointsHaveARowForEachBody)
{
  const TwoMethods model("hex8", 2);
  const std::vector<Point> points{{0.3, 0.4, 1},      // in both
                                  {1, 0.5, 1.5},      // where the upper one is cut
                                  {1, 0.5, 1},        // both
                                  {0, 0, 0},          // a corner
                                  {0.3, 0.4, -1e-7},  // on a face, within rounding
                                  {0.3, 0.4, 2.02},   // a little above
                                  {0.3, 1.4, 1.4},    // outside
                                  {-5, 0, 0.1}};      // far away
  const auto found = find_points(model.decomposition, fem::Kinematics::solid, points, model.comm);
  const std::vector<std::pair<long long, int>> expected{{0, 0}, {0, 1}, {1, 0}, {2, 0}, {2, 1}, {3, 1}, {4, 1}, {5, 0}};
  EXPECT_EQ(rows_of(found, model.comm), expected);
  EXPECT_EQ(found.rows, 8);
  ASSERT_EQ(found.lost.size(), 2U);
  EXPECT_EQ(found.lost[0].point, 6U);
  EXPECT_EQ(found.lost[0].body, 0);
  EXPECT_NEAR(found.lost[0].distance, (Point(0.5, 1, 4.0 / 3) - points[6]).norm(), 1e-12);
  EXPECT_EQ(found.lost[1].point, 7U);
  EXPECT_EQ(found.lost[1].body, 1);
  EXPECT_NEAR(found.lost[1].distance, std::hypot(5, 0.1), 1e-12);
}

}  // namespace
}  // namespace mortise::post
