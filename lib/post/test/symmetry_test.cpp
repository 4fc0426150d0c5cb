// A part of a body on one side of its planes of symmetry has the stresses and the error of the whole. The same on any ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "post/stress_recovery.hpp"
#include "testing/cut.hpp"

namespace mortise::post {
namespace {

// The box -2 < x < 2, -1 < y < 1, 0 < z < 1 or its part with x > 0, y > 0, of two materials. Cells, displacements and temperature
// are uneven, but symmetric in x and y; all may be turned, so that planes of symmetry lie askew.
struct Setting {
  std::string element;
  int dimension = 3;
  bool quarter = false, turned = false;
};

class Body {
 public:
  explicit Body(const Setting& setting)
  {
    const bool solid = setting.dimension == 3;
    const Eigen::Matrix3d turn =
        setting.turned ? Eigen::AngleAxisd(0.7, solid ? Point(1, -2, 3).normalized() : Point(0, 0, 1)).toRotationMatrix()
                       : Eigen::Matrix3d::Identity();
    mesh::Options mesh;
    auto& box = mesh.blocks["box"];
    box.element = setting.element;
    box.origin = setting.quarter ? std::array<double, 3>{0, 0, 0} : std::array<double, 3>{-2, -1, 0};
    box.size = setting.quarter ? std::array<double, 3>{2, 1, 1} : std::array<double, 3>{4, 2, 1};
    box.cells = setting.quarter ? std::array<int, 3>{4, 4, 4} : std::array<int, 3>{8, 8, 4};
    partition::Options options;
    options.method = "grid";
    options.counts["box"] = setting.quarter ? std::array<int, 3>{1, 3, 2} : std::array<int, 3>{4, 1, 2};
    if (!solid) box.cells[2] = options.counts["box"][2] = 1;
    decomposition_ = partition::cut_of(mesh, options, comm, setting.dimension);
    kinematics_ = solid ? fem::Kinematics::solid : fem::Kinematics::plane_strain;
    for (auto& s : decomposition_.subdomains) {
      std::vector<int> of_cell;
      for (std::size_t c = 0; c < s.mesh.cells.size(); ++c) {
        double sum = 0;
        for (const Local n : s.mesh.cells[c]) sum += s.mesh.points[static_cast<std::size_t>(n)][solid ? 2 : 0];
        of_cell.push_back(std::abs(sum) > 0.5 * static_cast<double>(s.mesh.cells[c].size()));
      }
      fem::Constitution own{fem::Materials({fem::Material{200, 0.3, 0, 1e-3}, fem::Material{70, 0.2, 0, 2e-3}}, of_cell)};
      own.temperature_change.varying = [back = Eigen::Matrix3d(turn.transpose())](const Point& x) {
        return 2 * std::cos((back * x)[0]);
      };
      constitution_.push_back(own);
      auto& u = displacement.emplace_back(setting.dimension * static_cast<Eigen::Index>(s.mesh.node_count()));
      auto& before = places_.emplace_back(s.mesh.points);
      auto& symmetric = symmetric_.mirrored.emplace_back();
      for (std::size_t n = 0; n < before.size(); ++n) {
        const Point x = before[n];
        const double up = solid ? x[2] : 0.3;
        const Point moved = x + 0.06 * Point(std::sin(2 * x[0]) * std::cos(3 * x[1] * x[1] + up),
                                             std::sin(3 * x[1]) * std::cos(x[0] * x[0] - 2 * up),
                                             solid ? std::cos(2 * x[0]) * std::cos(4 * x[1]) : 0);
        const Point field = 1e-2 * Point(x[0] * std::cos(2 * x[1]) * (1 + up * up), std::sin(x[1]) * std::exp(-x[0] * x[0]) * up,
                                         solid ? std::cos(2 * x[0]) * std::cos(x[1]) * std::exp(up) : 0);
        s.mesh.points[n] = turn * moved;
        u.segment(setting.dimension * static_cast<Eigen::Index>(n), setting.dimension) =
            Point(turn * field).head(setting.dimension);
        SymmetricNode at{static_cast<Local>(n), {}};
        for (int c = 0; c < 2 && setting.quarter; ++c)
          if (x[c] == 0) at.normals.emplace_back(turn * -Point::Unit(c));
        if (!at.normals.empty()) symmetric.push_back(at);
      }
    }
    directory_ = std::make_unique<partition::NodeDirectory>(partition::even_directory(decomposition_, comm));
    interface_ = partition::find_interface(decomposition_, *directory_, comm);
  }

  ElasticBodies bodies(bool symmetric = true) const
  {
    ElasticBodies result{decomposition_, interface_, kinematics_, constitution_, 2};
    if (symmetric) result.symmetric = &symmetric_;
    return result;
  }

  // Of all nodes of all ranks, by their places before they moved.
  std::map<std::array<double, 3>, std::array<double, 13>> by_place(const StressField& field) const
  {
    struct AtNode {
      std::array<double, 3> at;
      std::array<double, 13> values;
    };
    std::vector<AtNode> own;
    for (std::size_t s = 0; s < places_.size(); ++s)
      for (std::size_t n = 0; n < places_[s].size(); ++n) {
        const auto row = static_cast<Eigen::Index>(n);
        auto& node = own.emplace_back(AtNode{{places_[s][n][0], places_[s][n][1], places_[s][n][2]}, {}});
        for (Eigen::Index k = 0; k < 12; ++k) node.values[static_cast<std::size_t>(k)] = field.by_material[s](row, k);
        node.values[12] = field.nodal_von_mises[s][row];
      }
    std::map<std::array<double, 3>, std::array<double, 13>> result;
    for (const auto& node : comm.all_gather(own)) result[node.at] = node.values;
    return result;
  }

  Communicator comm;
  std::vector<Eigen::VectorXd> displacement;

 private:
  partition::Decomposition decomposition_;
  std::vector<std::vector<Point>> places_;
  std::unique_ptr<partition::NodeDirectory> directory_;
  partition::Interface interface_;
  fem::Kinematics kinematics_ = fem::Kinematics::solid;
  std::vector<fem::Constitution> constitution_;
  SymmetricNodes symmetric_;
};

void expect_stresses_of_the_whole(Setting setting)
{
  const Body whole(setting);
  setting.quarter = true;
  const Body quarter(setting);
  const auto of_whole = recover_stress(whole.bodies(), whole.displacement, whole.comm);
  const auto of_quarter = recover_stress(quarter.bodies(), quarter.displacement, quarter.comm);
  const auto all = whole.by_place(of_whole), part = quarter.by_place(of_quarter);
  const double largest = of_whole.largest_von_mises.value;
  double difference = 0;
  std::size_t found = 0;
  for (const auto& [at, values] : part)
    if (const auto same = all.find(at); same != all.end()) {
      ++found;
      for (std::size_t k = 0; k < values.size(); ++k) difference = std::max(difference, std::abs(values[k] - same->second[k]));
    }
  EXPECT_EQ(found, part.size());
  EXPECT_LT(difference, 1e-11 * largest);
  EXPECT_NEAR(of_quarter.largest_von_mises.value, largest, 1e-11 * largest);
  EXPECT_NEAR(4 * of_quarter.strain_energy, of_whole.strain_energy, 1e-11 * of_whole.strain_energy);
  // Patches solve equations.
  EXPECT_NEAR(4 * of_quarter.squared_error, of_whole.squared_error, 1e-8 * of_whole.squared_error);
  const auto norms = energy_norms(quarter.bodies(), quarter.displacement, quarter.comm),
             norms_of_whole = energy_norms(whole.bodies(), whole.displacement, whole.comm);
  EXPECT_GT(norms.error, 0);
  EXPECT_NEAR(2 * norms.error, norms_of_whole.error, 1e-11 * norms_of_whole.error);

  // The mesh is so uneven that it matters.
  const auto alone = recover_stress(quarter.bodies(false), quarter.displacement, quarter.comm);
  EXPECT_GT(std::abs(4 * alone.squared_error / of_whole.squared_error - 1), 1e-3);
  double shear = 0;
  for (const auto& [at, values] : quarter.by_place(alone))
    for (std::size_t k = 0; k < 12; ++k) shear = std::max(shear, std::abs(values[k] - part.at(at)[k]));
  EXPECT_GT(shear, 1e-3 * largest);
}

TEST(Symmetry, Hexahedra) { expect_stresses_of_the_whole({"hex8"}); }
TEST(Symmetry, HexahedraAskew) { expect_stresses_of_the_whole({"hex8", 3, false, true}); }
TEST(Symmetry, HexahedraOfSecondOrderAskew) { expect_stresses_of_the_whole({"hex20", 3, false, true}); }
TEST(Symmetry, QuadrilateralsAskew) { expect_stresses_of_the_whole({"quad4", 2, false, true}); }
TEST(Symmetry, QuadrilateralsOfSecondOrder) { expect_stresses_of_the_whole({"quad8", 2}); }

}  // namespace
}  // namespace mortise::post
