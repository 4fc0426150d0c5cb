// What a deck asks for inside bodies, on two blocks of either method. The same on any ranks.
#include "analysis/probes.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mesh/shape_functions.hpp"
#include "model/resolution.hpp"
#include "partition/skins.hpp"
#include "testing/cut.hpp"

namespace mortise::analysis {
namespace {

const std::string two_methods = R"(
mesh:
  blocks:
    lower: {size: [1, 1, 1], cells: [2, 2, 2]}
    upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [2, 2, 2], element: prism6}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {lower: {material: steel}, upper: {material: steel, method: boundary_elements}}
decomposition: {method: grid, counts: {lower: [2, 1, 1], upper: [1, 2, 1]}}
)";

const std::string steel_on_rubber = R"(
mesh:
  blocks:
    lower: {size: [1, 1, 1], cells: [2, 2, 2]}
    upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [3, 3, 3]}
materials: {rubber: {young_modulus: 1, poisson_ratio: 0.3}, steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {lower: {material: rubber}, upper: {material: steel}}
contacts: [{name: joint, secondary: upper.zmin, primary: lower.zmax}]
)";

class Asked {
  Quiet quiet_;

 public:
  explicit Asked(const std::string& interior, const std::string& deck = two_methods)
      : document_(deck + "output: {" + (interior.starts_with("probes") ? "" : "interior: ") + interior + "}\n", "deck.yaml", {}),
        deck_(model::read_deck(document_, ""))
  {
    document_.check();
    auto decomposition = partition::cut_of(deck_.mesh, deck_.decomposition, comm);
    const auto on_surface = model::bodies_of_boundary_elements(deck_, decomposition.catalogue);
    decomposition = partition::skins(std::move(decomposition), on_surface, true, comm);
    resolved_ = model::resolve(deck_, document_, std::move(decomposition), quiet_.context);
    model_.emplace(deck_, resolved_.contacts, resolved_.decomposition, resolved_.temperatures);
  }
  post::Probes find() { return find_probes(*model_, document_, comm); }
  const model::Deck& deck() const { return deck_; }
  const std::vector<partition::Subdomain>& subdomains() const { return resolved_.decomposition.subdomains; }
  const partition::Subdomain& subdomain(const post::PointInCell& place) const
  {
    return resolved_.decomposition.subdomains[place.subdomain];
  }

  const Communicator& comm = quiet_.comm;

 private:
  deck::Document document_;
  model::Deck deck_;
  model::Resolution resolved_;
  std::optional<model::Model> model_;
};

// A plane where both blocks are cut into subdomains, or touch it, counts once; the places are where their reference coordinates
// say, and triangles in boundary elements are as small as asked.
TEST(Probes, PlanesCutBodiesOfBothMethods)
{
  Asked asked(
      "{planes: {across: {point: [0.5, 0, 0], normal: [2, 0, 0], size: 0.2}, bottom: {point: [0, 0, 0], normal: [0, 0, 1]}, "
      "joint: {point: [0, 0, 1], normal: [0, 0, 1]}, off: {point: [3, 0, 0], normal: [1, 0, 0]}, "
      "side: {point: [0, 0.5, 0], normal: [0, 1, 0], size: 0.2}}}");
  const auto probes = asked.find();
  ASSERT_EQ(probes.planes.size(), 5U);
  const double areas[] = {2, 1, 2, 0, 2};
  for (std::size_t k = 0; k < 5; ++k) {
    double area = 0;
    for (const auto& triangle : probes.planes[k].triangles) {
      const auto place = [&](std::size_t i) -> const post::PointInCell& {
        return probes.planes[k].places[static_cast<std::size_t>(triangle[i])];
      };
      area += (place(1).at - place(0).at).cross(place(2).at - place(0).at).norm() / 2;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(place(i).subdomain, place(0).subdomain);
        if (asked.subdomain(place(0)).skin && (k == 0 || k == 4)) {
          EXPECT_LE((place(i).at - place((i + 1) % 3).at).norm(), 0.2);
        }
      }
    }
    EXPECT_NEAR(asked.comm.sum(area), areas[k], 1e-12) << k;
    for (const auto& place : probes.planes[k].places) {
      const auto& mesh = post::solid(asked.subdomain(place));
      const auto& shape = mesh::shape_functions(mesh.cells.type[place.cell]);
      Eigen::VectorXd weight(shape.count());
      shape.evaluate(place.reference, weight);
      Point at = Point::Zero();
      for (Eigen::Index i = 0; i < weight.size(); ++i)
        at += weight[i] * mesh.points[static_cast<std::size_t>(mesh.cells[place.cell][static_cast<std::size_t>(i)])];
      EXPECT_LT((at - place.at).norm(), 1e-12);
    }
  }
  const auto warnings = idle_planes(asked.deck(), probes, asked.comm);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].text.find("\"off\""), std::string::npos);
  EXPECT_EQ(warnings[0].kind, "idle_plane");
}

TEST(Probes, PointsInNoBodyAreErrorsOnAllRanks)
{
  Asked asked("{points: [[0.5, 0.5, 1], [0.1, 0.2, 0.3], [0, 0, 2.25]]}");
  try {
    asked.find();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    const std::string text = error.what();
    EXPECT_NE(text.find("deck.yaml:9: output.interior.points[2]: the point (0, 0, 2.25) lies in no body; the nearest node, of "
                        "\"upper\", is 0.25 away"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("points[0]"), std::string::npos);
  }
}

// Points of probes and paths are counted through, in the order of names; a path may leave the bodies.
TEST(Probes, PathsAndPointsOfNames)
{
  Asked asked(
      "probes: {b: {from: [0.5, 0.5, 0], to: [0.5, 0.5, 4], count: 9}, a: {point: [0.25, 0.25, 1]}, c: {largest: von_mises}}");
  const auto probes = asked.find();
  EXPECT_EQ(probes.samples, 2 + 6);  // in two bodies; 0 .. 2 by halves, and 1 in two bodies
  EXPECT_EQ(asked.comm.sum(static_cast<long long>(probes.sampled.size())), 8);
  for (const auto& sample : probes.sampled) {
    const double z = sample.point == 0 ? 1 : 0.5 * static_cast<double>(sample.point - 1);
    EXPECT_NEAR(sample.place.at[2], z, 1e-12);
  }
  EXPECT_TRUE(probes.any_inside());
  ASSERT_EQ(probes.extremes.size(), 1U);
}

// Bodies, boundaries, and boundaries on bodies, with wild cards; nodes are those of their faces.
TEST(Probes, ExtremesAreLookedForWhereTheirNamesSay)
{
  Asked asked(
      "probes: {a: {largest: sxx, of: lower}, b: {largest: sxx, of: '*.zmax'}, c: {smallest: sxx, of: 'upper:*'}, "
      "d: {largest: sxx}, e: {largest: sxx, of: 'lower:*.xmin'}}");
  const auto probes = asked.find();
  ASSERT_EQ(probes.extremes.size(), 5U);
  using Bodies = std::vector<bool>;
  EXPECT_EQ(probes.extremes[0].on_body, (Bodies{true, false}));
  EXPECT_EQ(probes.extremes[3].on_body, (Bodies{true, true}));
  EXPECT_TRUE(probes.extremes[0].nodes.empty() && probes.extremes[3].nodes.empty());
  EXPECT_TRUE(probes.extremes[2].smallest);
  const auto expect = [&](std::size_t probe, const auto& meant) {
    ASSERT_EQ(probes.extremes[probe].nodes.size(), asked.subdomains().size());
    for (std::size_t s = 0; s < asked.subdomains().size(); ++s)
      for (std::size_t n = 0; n < asked.subdomains()[s].mesh.node_count(); ++n)
        EXPECT_EQ(probes.extremes[probe].nodes[s][n], meant(asked.subdomains()[s], asked.subdomains()[s].mesh.points[n]));
  };
  expect(1, [](const auto& s, const Point& x) { return x[2] == s.body + 1; });
  expect(2, [](const auto& s, const Point& x) {
    return s.body == 1 && (x[0] == 0 || x[0] == 1 || x[1] == 0 || x[1] == 1 || x[2] == 1 || x[2] == 2);
  });
  expect(4, [](const auto& s, const Point& x) { return s.body == 0 && x[0] == 0; });
}

// The soft side has the pressures: those of the stiff one, which the deck calls secondary, as a whole.
TEST(Probes, PressuresOfSidesThatAreExchanged)
{
  for (const char* of : {"joint", "upper.zmin", "upper", "lower.zmax", "lower", "'upper:*'"}) {
    Asked asked("probes: {a: {largest: pressure, of: " + std::string(of) + "}}", steel_on_rubber);
    const auto probes = asked.find();
    ASSERT_EQ(probes.extremes.size(), 1U);
    ASSERT_EQ(probes.extremes[0].contact_nodes.size(), 1U);
    long long found = 0;
    for (const bool node : probes.extremes[0].contact_nodes[0]) found += node;
    EXPECT_EQ(asked.comm.sum(found), 9) << of;
  }
  EXPECT_THROW(Asked("probes: {a: {largest: pressure, of: upper.xmin}}", steel_on_rubber).find(), Error);
}

}  // namespace
}  // namespace mortise::analysis
