// Tables of results.h5 and lines of .csv files: the same whatever ranks their rows come from.
#include "output/tables.hpp"

#include <gtest/gtest.h>

#include "../../io/test/scratch.hpp"
#include "../src/csv.hpp"
#include "deck_of_blocks.hpp"
#include "output/probe_files.hpp"
#include "output/sections.hpp"

namespace mortise::output {
namespace {

// All rows of a table, by their numbers.
std::vector<Eigen::VectorXd> whole(const io::Table& table, const Communicator& comm)
{
  const auto rows = comm.all_gather(table.row);
  const auto values = comm.all_gather(table.values);
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(table.total));
  std::vector<Eigen::VectorXd> result(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto& row = result.at(static_cast<std::size_t>(rows[i]));
    EXPECT_EQ(row.size(), 0) << table.name << " has row " << rows[i] << " twice";
    row = Eigen::Map<const Eigen::VectorXd>(&values.at(i * static_cast<std::size_t>(table.columns)), table.columns);
  }
  return result;
}

TEST(Tables, HaveEachNodeAndCellOnce)
{
  const DeckOfBlocks blocks("");
  const auto nodes = node_tables(blocks.decomposition, blocks.interface, blocks.displacement, blocks.fields.stress);
  ASSERT_EQ(nodes.size(), 4U);
  const auto points = whole(nodes[0], blocks.comm), moved = whole(nodes[1], blocks.comm),
             von_mises = whole(nodes[2], blocks.comm), stress = whole(nodes[3], blocks.comm);
  ASSERT_EQ(points.size(), 45U + 36U);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Point x = points[n];
    EXPECT_EQ(moved[n], Eigen::VectorXd(DeckOfBlocks::moved(x)));
    EXPECT_EQ(stress[n], Eigen::VectorXd(DeckOfBlocks::stress(x)));
    EXPECT_EQ(von_mises[n][0], fem::von_mises(DeckOfBlocks::stress(x)));
  }
  for (const auto& table : cell_tables(blocks.decomposition, blocks.fields.stress, blocks.comm)) {
    const auto rows = whole(table, blocks.comm);
    ASSERT_EQ(rows.size(), 28U) << table.name;
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const double number = static_cast<double>(c);
      if (table.name == "cells/von_mises") {
        EXPECT_EQ(rows[c][0], number);
      } else if (table.name == "cells/body") {
        EXPECT_EQ(rows[c][0], c < 16 ? 0 : 1);
      }
    }
  }
}

// Two points at a kink share a node, and two may be alike in all that tells them apart.
TEST(Tables, OrderContactNodesByContactAndNode)
{
  const Communicator comm;
  std::vector<contact::ContactNodeState> all(6);
  const int contacts[] = {1, 0, 0, 1, 0, 1};
  const Global nodes[] = {4, 9, 9, 2, 3, 4};
  const double gaps[] = {0.5, 0.2, 0.1, 0, 0, 0.5};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].contact = contacts[i];
    all[i].node = nodes[i];
    all[i].gap = gaps[i];
    all[i].force_on_secondary = Point(1, 2, static_cast<double>(i));
    all[i].status = contact::Status::slip;
  }
  std::vector<contact::ContactNodeState> mine;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (static_cast<int>(i / 2) % comm.size() == comm.rank()) mine.push_back(all[i]);
  const auto table = contact_table(mine, comm);
  const auto rows = whole(table, comm);
  const std::size_t order[] = {4, 2, 1, 3};
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(rows[r][6], static_cast<double>(order[r])) << r;
  EXPECT_EQ(std::set({rows[4][6], rows[5][6]}), std::set({0.0, 5.0}));
  for (const auto& row : rows) EXPECT_EQ(row[11], 2);
}

// A point in a body on each rank, in turn.
post::PointInBody point_in_body(Global row, std::size_t point, int body, const Point& at)
{
  return {point, row, body, {0, 0, Point::Zero(), at}};
}

post::Values values_at(const std::vector<post::PointInBody>& points)
{
  const auto n = static_cast<Eigen::Index>(points.size());
  post::Values values{Eigen::MatrixXd(n, 3), Eigen::MatrixXd(n, 6)};
  for (Eigen::Index i = 0; i < n; ++i) {
    values.displacement.row(i) = DeckOfBlocks::moved(points[static_cast<std::size_t>(i)].place.at).transpose();
    values.stress.row(i) = DeckOfBlocks::stress(points[static_cast<std::size_t>(i)].place.at).transpose();
  }
  return values;
}

std::vector<post::PointInBody> share_of_rank(const std::vector<post::PointInBody>& all, const Communicator& comm)
{
  std::vector<post::PointInBody> mine;
  for (std::size_t i = all.size(); i-- > 0;)
    if (static_cast<int>(i) % comm.size() == comm.rank()) mine.push_back(all[i]);
  return mine;
}

TEST(InteriorPoints, AreRowsByTheirNumbers)
{
  const Communicator comm;
  mesh::Catalogue catalogue;
  catalogue.bodies = {{"plain", "plain"}, {"odd, \"name\"", "odd"}};
  const std::vector all{point_in_body(0, 0, 0, {0, 0, 0}), point_in_body(1, 0, 1, {0, 0, 0}), point_in_body(2, 1, 1, {1, 0, 2})};
  post::Probes probes;
  probes.points = share_of_rank(all, comm);
  probes.rows = 3;
  const auto values = values_at(probes.points);
  model::LoadState acts;
  acts.step = "on";
  acts.time = 1.5;
  const auto text = point_rows(catalogue, acts, probes, values, comm);
  EXPECT_EQ(text.substr(0, 29), "on,1.5,0,0,0,plain,1,2,0,10,-");
  EXPECT_NE(text.find("\non,1.5,0,0,0,\"odd, \"\"name\"\"\",1,2,0,10,"), std::string::npos) << text;
  EXPECT_NE(text.find("\non,1.5,1,0,2,\"odd, \"\"name\"\"\",2,4,5,11,-20,10,3,1,-7,"), std::string::npos) << text;
  post::Interior interior;
  interior.points = values;
  const auto tables = interior_tables({}, probes, interior, comm);
  ASSERT_EQ(tables.size(), 5U);
  EXPECT_EQ(whole(tables[0], comm)[2], Eigen::VectorXd(Point(1, 0, 2)));
  EXPECT_EQ(whole(tables[1], comm)[2], Eigen::VectorXd(Point(2, 4, 5)));
  EXPECT_EQ(whole(tables[4], comm)[1][0], 1);
  EXPECT_TRUE(interior_tables({}, {}, {}, comm).empty());
}

// A path from the upper body (number 1) down to the lower one, whose first point lies in neither; where it leaves a body that
// body comes first. And a point that two bodies have, and an extreme.
TEST(ProbeFiles, TellExtremesPointsAndPaths)
{
  const Communicator comm;
  const io::test::Scratch folder(comm);
  deck::Document document(deck_of_blocks +
                              "output:\n  probes:\n    down: {from: [1, 0, 4], to: [1, 0, 0], count: 5}\n"
                              "    joint: {point: [1, 0, 1]}\n    top: {largest: uz}\n",
                          "deck.yaml", {});
  const auto deck = model::read_deck(document, folder.path());
  document.check();
  mesh::Catalogue catalogue;
  catalogue.bodies = {{"lower", "lower"}, {"upper", "upper"}};
  // Points 0 to 4 are the path's, at z = 4, 3, 2, 1, 0; 5 is the probe's.
  const std::vector all{point_in_body(0, 1, 1, {1, 0, 3}), point_in_body(1, 2, 1, {1, 0, 2}), point_in_body(2, 3, 0, {1, 0, 1}),
                        point_in_body(3, 3, 1, {1, 0, 1}), point_in_body(4, 4, 0, {1, 0, 0}), point_in_body(5, 5, 0, {1, 0, 1}),
                        point_in_body(6, 5, 1, {1, 0, 1})};
  post::Probes probes;
  probes.sampled = share_of_rank(all, comm);
  probes.samples = 7;
  post::Fields fields;
  fields.interior.sampled = values_at(probes.sampled);
  fields.extremes.push_back({12.5, {2, 0, 1}, 1});
  const auto summaries = probe_summaries(deck, catalogue, probes, fields, comm);
  ASSERT_EQ(summaries.size(), 4U);
  EXPECT_EQ(summaries[0].path->points, 5);
  EXPECT_EQ(summaries[0].path->length, 4);
  EXPECT_EQ(summaries[1].place.body, "lower");
  EXPECT_EQ(summaries[2].place.body, "upper");
  EXPECT_EQ(summaries[2].at_point->displacement, (std::array<double, 3>{2, 3, 5}));
  EXPECT_EQ(summaries[3].value, 12.5);
  EXPECT_EQ(summaries[3].place.body, "upper");
  ProbeFiles files(deck);
  files.write(catalogue, {}, probes, fields.interior.sampled, summaries, comm);
  EXPECT_EQ(folder.files(), (std::set<std::string>{"probe.down.csv", "probes.csv"}));
  std::istringstream path(io::test::content(folder / "probe.down.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(path, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0].substr(0, 18), "s,x,y,z,body,ux,uy");
  EXPECT_EQ(lines[1], "0,1,0,4," + std::string(13, ','));
  const char* begin[] = {"1,1,0,3,upper,2,5,5,", "2,1,0,2,upper,2,4,5,", "3,1,0,1,upper,2,3,5,", "3,1,0,1,lower,2,3,5,",
                         "4,1,0,0,lower,2,2,5,"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(lines[i + 2].starts_with(begin[i])) << lines[i + 2];
  const auto table = io::test::content(folder / "probes.csv");
  EXPECT_TRUE(table.starts_with("joint.lower.ux,joint.lower.uy,")) << table;
  EXPECT_NE(table.find("joint.upper.principal_3,top,top.x,top.y,top.z,top.body\n2,3,5,"), std::string::npos) << table;
  EXPECT_NE(table.find(",12.5,2,0,1,upper\n"), std::string::npos) << table;
}

TEST(Csv, QuotesNamesThatNeedIt)
{
  EXPECT_EQ(quoted("ring.1"), "ring.1");
  EXPECT_EQ(quoted("a,b"), "\"a,b\"");
  EXPECT_EQ(quoted("5\" bore"), "\"5\"\" bore\"");
}

}  // namespace
}  // namespace mortise::output
