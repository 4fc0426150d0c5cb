// The deck as a whole, and the decks under inputs/.
#include "model/deck.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"

namespace mortise::model {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path)
{
  std::ifstream stream(path);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

std::vector<fs::path> example_decks()
{
  std::vector<fs::path> decks;
  for (const auto& folder : {"inputs", "regression/cases"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(MORTISE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".yaml" && entry.path().parent_path().extension() != ".out") decks.push_back(entry.path());
  return decks;
}

TEST(Decks, AllExamplesReadAndTheirWrittenFormReadsBackTheSame)
{
  ASSERT_GT(example_decks().size(), 7U);
  for (const auto& path : example_decks()) {
    SCOPED_TRACE(path);
    deck::Document document(text_of(path), path.string(), {});
    const auto deck = read_deck(document, "");
    EXPECT_NO_THROW(document.check());
    const auto written = write_deck(deck);
    deck::Document again(written, path.string(), {});
    const auto copy = read_deck(again, "");
    EXPECT_NO_THROW(again.check());
    EXPECT_EQ(write_deck(copy), written);
  }
}

std::string complaints(const std::string& text, const std::vector<std::string>& settings = {})
{
  deck::Document document(text, "deck.yaml", settings);
  read_deck(document, "");
  try {
    document.check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

const char* blocks = R"(mesh:
  blocks:
    a: {size: [1, 1, 1], cells: [2, 2, 2]}
    b: {origin: [0, 0, 1], size: [1, 1, 1], cells: [2, 2, 2]}
materials: {steel: {young_modulus: 1, poisson_ratio: 0.3}}
bodies: {a: {material: steel}, b: {material: steel}}
)";

void expect_complaint(const std::string& text, const std::string& expected)
{
  EXPECT_NE(complaints(blocks + text).find(expected), std::string::npos) << complaints(blocks + text);
}

TEST(Decks, NamesAndPreloadsAndNormalsReadBackTheSame)
{
  const std::string text = std::string(blocks) + R"(supports: [{boundary: a.zmin, displacement: {normal: 0.5, x: 1}}]
loads: [{boundary: b.zmax, pressure: 1}, {name: weight, body: b, acceleration: [0, 0, 1]}]
contacts:
  - {secondary: b.zmin, primary: a.zmax, friction: {bonded: true}, preload: {force: 3}}
  - {secondary: a.xmin, primary: a.ymin, friction: {bonded: true}, cyclic: {axis: [0, 0, -2], angle: 360/7, center: [1, 2, 3]}}
)";
  deck::Document document(text, "deck.yaml", {});
  const auto deck = read_deck(document, "");
  EXPECT_NO_THROW(document.check());
  EXPECT_EQ(deck.supports[0].name, "a.zmin");
  EXPECT_EQ(deck.supports[0].normal, 0.5);
  EXPECT_EQ(deck.supports[0].displacement[0], 1.0);
  EXPECT_EQ(deck.loads[0].name, "b.zmax");
  EXPECT_EQ(deck.loads[1].name, "weight");
  ASSERT_TRUE(deck.contacts[0].preload.has_value());
  EXPECT_EQ(deck.contacts[0].preload->force, 3.0);
  ASSERT_TRUE(deck.contacts[1].cyclic.has_value());
  EXPECT_EQ(deck.contacts[1].cyclic->angle, 360.0 / 7);
  const auto written = write_deck(deck);
  deck::Document again(written, "deck.yaml", {});
  const auto copy = read_deck(again, "");
  EXPECT_NO_THROW(again.check());
  EXPECT_EQ(write_deck(copy), written);
}

TEST(Decks, BoundaryElementsAreForBodiesOfOneMaterial)
{
  const std::string on_surface = "bodies.a.method=boundary_elements";
  deck::Document document(blocks, "deck.yaml", {on_surface});
  const auto deck = read_deck(document, "");
  EXPECT_NO_THROW(document.check());
  EXPECT_EQ(deck.bodies.at("a").method, fem::Method::boundary_elements);
  EXPECT_EQ(deck.bodies.at("b").method, fem::Method::finite_elements);
  deck::Document again(write_deck(deck), "deck.yaml", {});
  EXPECT_EQ(read_deck(again, "").bodies.at("a").method, fem::Method::boundary_elements);
  mesh::Catalogue catalogue;
  catalogue.bodies = {{"b", "b"}, {"a.1", "a", "a.1"}, {"a.2", "a", "a.2"}, {"c", "c"}};
  EXPECT_EQ(bodies_of_boundary_elements(deck, catalogue), (std::vector<bool>{false, true, true, false}));

  const auto expect = [&](std::vector<std::string> settings, const std::string& expected) {
    settings.push_back(on_surface);
    EXPECT_NE(complaints(blocks, settings).find(expected), std::string::npos) << complaints(blocks, settings);
  };
  expect({"bodies.a.formulation=bbar"}, "bodies.a.formulation: this is a formulation of finite elements");
  expect({"dimension=axisymmetric"}, "bodies.a.method: boundary elements are not for axisymmetric models");
  const std::string above = "bodies.a.method: boundary elements in plane stress need a Poisson's ratio above -0.5, found -0.7";
  expect({"dimension=plane_stress", "materials.steel.poisson_ratio=-0.7"}, above);
  for (const std::string plane : {"plane_strain", "plane_stress"})
    EXPECT_EQ(complaints(blocks, {"dimension=" + plane, on_surface}).find("bodies.a.method"), std::string::npos);
  EXPECT_EQ(complaints(blocks, {"dimension=plane_strain", "materials.steel.poisson_ratio=-0.7", on_surface}).find(above),
            std::string::npos);
  expect({"decomposition.subdomains_per_cluster=4"},
         "decomposition.subdomains_per_cluster: clusters are for finite elements, and the body \"a\" is of boundary elements");
  expect({"bodies.a={volumes: {c: steel}, method: boundary_elements}"},
         "bodies.a.volumes: boundary elements are for bodies of one material");
  EXPECT_NE(complaints(blocks, {"bodies.a.method=finite"}).find("boundary_elements"), std::string::npos);
}

TEST(Decks, TheInsideOfBodiesIsAskedForByWordListOrFile)
{
  const auto interior = [](const std::string& setting) {
    deck::Document document(blocks, "deck.yaml", {"output.interior=" + setting});
    const auto deck = read_deck(document, "");
    EXPECT_NO_THROW(document.check());
    deck::Document again(write_deck(deck), "deck.yaml", {});
    EXPECT_EQ(write_deck(read_deck(again, "")), write_deck(deck));
    return deck.output.interior;
  };
  EXPECT_FALSE(interior("{}").any());
  EXPECT_TRUE(interior("cells").cells);
  EXPECT_EQ(interior("{points: [[1, 2, 3], [4, 5, 6]]}").points.at(1), (std::array<double, 3>{4, 5, 6}));
  EXPECT_EQ(interior("{points: probes.csv}").point_file, (fs::current_path() / "probes.csv").string());
  EXPECT_EQ(interior("{planes: {mid: {point: [0, 0, 0], normal: [0, 0, 2]}}}").planes.at("mid").size, std::nullopt);

  const auto expect = [&](std::vector<std::string> settings, const std::string& expected) {
    EXPECT_NE(complaints(blocks, settings).find(expected), std::string::npos) << complaints(blocks, settings);
  };
  expect({"output.interior=nodes"}, "output.interior: expected cells, or a mapping such as {cells: true}, found \"nodes\"");
  expect({"output.interior.points=[[1, 2]]"}, "output.interior.points[0]: expected 3 entries");
  expect({"output.interior.planes={a/b: {point: [0, 0, 0], normal: [0, 0, 1]}}"},
         "output.interior.planes.a/b: the name goes into file");
  expect({"output.interior.planes={a: {point: [0, 0, 0], normal: [0, 0, 0]}}"}, "planes.a.normal: expected a direction");
  expect({"dimension=plane_strain", "output.interior.points=[[1, 2, 3]]"}, "output.interior.points[0]: a plane model has no z");
  expect({"dimension=plane_stress", "bodies.a.method=boundary_elements",
          "output.interior.planes={a: {point: [0, 0, 0], normal: [0, 0, 1]}}"},
         "output.interior.planes: sections are for models of dimension 3");
  for (const std::string plane : {"plane_strain", "plane_stress"})
    EXPECT_EQ(complaints(blocks, {"dimension=" + plane, "output.interior=cells", "bodies.a.method=boundary_elements"})
                  .find("output.interior"),
              std::string::npos);
}

TEST(Decks, SectionsAreCheckedAgainstEachOther)
{
  EXPECT_EQ(complaints(blocks), "");
  expect_complaint("decomposition: {method: grid, counts: {a: [2, 2, 2]}}\n", "the block \"b\" needs an entry");
  expect_complaint("decomposition: {method: grid, counts: {a: [2, 2, 2], b: [3, 1, 1]}}\n",
                   "expected 1 to 2 subdomains along x, found 3");
  expect_complaint("loads: [{boundary: a.xmax, pressure: 1, force: [1, 0, 0]}]\n",
                   "exactly one of pressure, traction, force, acceleration, centrifugal and temperature_change, found 2");
  expect_complaint("loads: [{boundary: a.xmax, acceleration: [1, 0, 0]}]\n", "an acceleration acts on a `body`");
  expect_complaint("loads: [{boundary: a.xmax, force: [1, 0]}]\n",
                   "deck.yaml:7: loads[0].force: expected 3 entries, since `dimension` is 3, found 2");
  expect_complaint("contacts: [{secondary: a.zmax, primary: {plane: {}}}]\n", "the key \"normal\" is missing");
  expect_complaint("contacts: [{secondary: a.zmax, primary: a.zmax}]\n", "same boundary");
  expect_complaint("contacts: [{secondary: a.zmax, primary: b.zmin}, {secondary: a.zmax, primary: b.zmin}]\n",
                   "two contacts are called");
  expect_complaint("contacts: [{secondary: a.zmax, primary: b.zmin, friction: {coulomb: -1}}]\n", "expected a number >= 0");
  expect_complaint("dimension: plane_strain\n", "does not fit a model of dimension 2");
  expect_complaint("dimension: axisymmetric\nloads: [{body: a, acceleration: [1, 0]}]\n", "along its axis, y, alone");
  expect_complaint("steps: [{scale: {nothing: 1}}]\n", "there is no load, support or contact of that name");
}

TEST(Decks, ResultsNeverReplaceTheDeck)
{
  deck::Document document(blocks, "models/deck.yaml", {});
  read_deck(document, "models/.");
  EXPECT_THROW(document.check(), Error);
  deck::Document other(blocks, "models/other.yaml", {});
  read_deck(other, "models");
  EXPECT_NO_THROW(other.check());
}

TEST(Decks, NamesAreCheckedAgainstTheMesh)
{
  deck::Document document(std::string(blocks) +
                              "supports: [{boundary: a.zmn, displacement: {z: 0}}, {boundary: 'c:a.zmin', displacement: {z: "
                              "0}}]\nloads: [{body: a, acceleration: [0, 0, 1]}]\n",
                          "deck.yaml", {});
  const auto deck = read_deck(document, "");
  mesh::Catalogue catalogue;
  catalogue.bodies = {{"a", "a"}, {"bb", "bb"}};
  catalogue.boundaries = {"a.zmin"};
  check_names(deck, as_written(deck), document, catalogue);
  try {
    document.check();
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string text = error.what();
    for (const char* expected :
         {"the mesh has no body \"b\", did you mean \"bb\"?", "the body \"bb\" of the mesh has no entry",
          "the mesh has no boundary \"a.zmn\", did you mean \"a.zmin\"?", "the mesh has no body \"c\"", "needs a density > 0"})
      EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
  }
}

TEST(Decks, RoundedFactorsAreNotForATightTolerance)
{
  expect_complaint("solver: {tolerance: 1e-8, factor_precision: single}\n",
                   "single precision is not exact enough for this tolerance");
  expect_complaint("solver: {factor_precision: half}\n", "factor_precision");
  for (const auto* solver : {"{tolerance: 1e-3, factor_precision: single}", "{factor_precision: single}", "{tolerance: 1e-8}"})
    EXPECT_EQ(complaints(std::string(blocks) + "solver: " + solver + "\n"), "") << solver;
}

TEST(Decks, SchemaIsJsonWithEverySection)
{
  const auto schema = nlohmann::json::parse(deck_schema());
  for (const char* section : {"title", "dimension", "mesh", "materials", "bodies", "supports", "loads", "contacts",
                              "decomposition", "solver", "friction_loop", "output"})
    EXPECT_TRUE(schema["properties"].contains(section)) << section;
  EXPECT_TRUE(schema["properties"]["solver"]["properties"].contains("factorization"));
}

}  // namespace
}  // namespace mortise::model
