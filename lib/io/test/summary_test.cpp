#include "io/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace mortise::io {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object)
{
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

Summary sample()
{
  Summary s;
  s.version = "1.2.3";
  s.title = "Two \"blocks\"";
  s.converged = true;
  s.primal_unknowns = 5'000'000'000;
  s.strain_energy = 0.1;
  s.reactions.push_back({"ground", {1, 2, 3}, std::array<double, 3>{4, 5, 6}, "floor"});
  s.contacts.push_back({"interface", {4, 5, 6}, 7, 8, 9, 10, 11, 6.5});
  s.time["solve"] = 1.5;
  s.peak_memory_bytes = 3e10;
  s.communication["solve"] = {{10, 20, 30, 40}, {5, 6, 7.5, 8}};
  return s;
}

TEST(Summary, FieldsAreThePromisedOnesInTheirOrder)
{
  const auto json = Json::parse(to_json(sample()));
  using Names = std::vector<std::string>;
  EXPECT_EQ(keys(json), (Names{"version",
                               "title",
                               "converged",
                               "exit_status",
                               "ranks",
                               "primal_unknowns",
                               "dual_unknowns",
                               "subdomains",
                               "clusters",
                               "kernel_dimension",
                               "single_precision",
                               "bodies",
                               "body_names",
                               "algorithm",
                               "friction_steps",
                               "outer_iterations",
                               "hessian_multiplications",
                               "residuals",
                               "error_estimate",
                               "strain_energy",
                               "max_von_mises",
                               "max_displacement",
                               "max_von_mises_place",
                               "moments_about",
                               "reactions",
                               "contacts",
                               "stuck",
                               "warnings",
                               "time",
                               "peak_memory_bytes",
                               "communication"}));
  EXPECT_EQ(keys(json["residuals"]),
            (Names{"projected_gradient", "equality", "equilibrium", "penetration", "complementarity", "supports", "interfaces"}));
  EXPECT_EQ(keys(json["error_estimate"]), (Names{"discretization", "algebraic"}));
  EXPECT_EQ(keys(json["reactions"][0]), (Names{"boundary", "force", "moment", "name"}));
  EXPECT_EQ(keys(json["max_von_mises_place"]), (Names{"coordinates", "body"}));
  EXPECT_EQ(keys(json["contacts"][0]),
            (Names{"name", "force", "max_pressure", "area", "open", "stick", "slip", "max_recovered_pressure", "max_tension"}));
  EXPECT_EQ(keys(json["time"]),
            (Names{"total", "mesh", "partition", "assembly", "contact", "factorization", "solve", "multiplication", "output"}));
  EXPECT_EQ(keys(json["communication"]), (Names{"total", "set_up", "solve", "multiplication"}));
  EXPECT_EQ(keys(json["communication"]["solve"]), (Names{"largest", "mean"}));
  EXPECT_EQ(keys(json["communication"]["solve"]["mean"]), (Names{"messages", "bytes", "collectives", "collective_bytes"}));
}

TEST(Summary, WhatWasNotCountedHasNoNumbers)
{
  auto s = sample();
  s.communication.clear();
  const auto json = Json::parse(to_json(s));
  EXPECT_FALSE(json.contains("communication"));
  EXPECT_TRUE(json.contains("peak_memory_bytes"));
}

TEST(Summary, ProbesHaveTheFieldsOfTheirKind)
{
  auto s = sample();
  s.probes.reserve(4);
  const auto add = [&](const char* name) -> StateSummary::Probe& {
    auto& probe = s.probes.emplace_back();
    probe.name = name;
    probe.place = {{1, 2, 3}, "lower"};
    return probe;
  };
  auto& peak = add("peak");
  peak.largest = "von_mises";
  peak.value = 7;
  auto& low = add("low");
  low.smallest = "principal_stress";
  low.value = std::nan("");
  add("tip").at_point = StateSummary::Probe::State{{1, 2, 3}, {9, 8, 7}, {1, 2, 3, 4, 5, 6}, 2.5};
  add("edge").path = StateSummary::Probe::Path{"probe.edge.csv", 21, 2.5};
  const auto json = Json::parse(to_json(s))["probes"];
  using Names = std::vector<std::string>;
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(keys(json[0]), (Names{"name", "largest", "value", "place"}));
  EXPECT_EQ(json[0]["value"], 7);
  EXPECT_EQ(json[0]["place"]["body"], "lower");
  EXPECT_EQ(keys(json[1]), (Names{"name", "smallest", "value", "place"}));
  EXPECT_TRUE(json[1]["value"].is_null());
  EXPECT_EQ(keys(json[2]), (Names{"name", "displacement", "stress", "principal_stress", "von_mises", "place"}));
  EXPECT_EQ(json[2]["stress"][5], 6);
  EXPECT_EQ(json[2]["principal_stress"], (Json{9, 8, 7}));
  EXPECT_EQ(keys(json[3]), (Names{"name", "file", "points", "length"}));
}

TEST(Summary, MomentsOfSupportsStandWhereThereAreSome)
{
  auto s = sample();
  s.reactions[0].moment.reset();
  s.reactions.push_back({"wall", {0, 0, 1}, std::array<double, 3>{4, 5, 6}});
  const auto json = Json::parse(to_json(s));
  EXPECT_FALSE(json["reactions"][0].contains("moment"));
  EXPECT_EQ(json["reactions"][1]["moment"], (Json{4, 5, 6}));
}

TEST(Summary, ValuesComeBack)
{
  const auto json = Json::parse(to_json(sample()));
  EXPECT_EQ(json["title"], "Two \"blocks\"");
  EXPECT_EQ(json["converged"], true);
  EXPECT_EQ(json["primal_unknowns"], 5'000'000'000);
  EXPECT_EQ(json["strain_energy"], 0.1);
  EXPECT_EQ(json["reactions"][0]["force"], (Json{1, 2, 3}));
  EXPECT_EQ(json["reactions"][0]["moment"], (Json{4, 5, 6}));
  EXPECT_EQ(json["reactions"][0]["name"], "floor");
  EXPECT_EQ(json["contacts"][0]["slip"], 11);
  EXPECT_EQ(json["time"]["solve"], 1.5);
  EXPECT_EQ(json["time"]["mesh"], 0);
  EXPECT_TRUE(json["peak_memory_bytes"].is_number_integer());
  EXPECT_EQ(json["peak_memory_bytes"], 30'000'000'000);
  EXPECT_EQ(json["communication"]["solve"]["largest"]["bytes"], 20);
  EXPECT_EQ(json["communication"]["solve"]["mean"]["collectives"], 7.5);
  EXPECT_EQ(json["communication"]["set_up"]["largest"]["messages"], 0);
}

TEST(Summary, WhatIsOpenStandsWhereThereIsSome)
{
  auto s = sample();
  EXPECT_TRUE(Json::parse(to_json(s))["stuck"].empty());
  s.contacts.push_back(s.contacts[0]);
  s.contacts[1].undecided = {{12, 3}, {0, 0}};
  s.stuck.push_back({"interface", 4, "stick/slip", {1, 2, 3}, 7, 12});
  const auto json = Json::parse(to_json(s));
  EXPECT_FALSE(json["contacts"][0].contains("undecided"));
  EXPECT_EQ(json["contacts"][1]["undecided"]["open_closed"], (Json{{"points", 12}, {"cells", 3}}));
  EXPECT_EQ(json["contacts"][1]["undecided"]["stick_slip"]["points"], 0);
  ASSERT_EQ(json["stuck"].size(), 1U);
  EXPECT_EQ(keys(json["stuck"][0]), (std::vector<std::string>{"contact", "points", "states", "place", "turns", "steps"}));
  EXPECT_EQ(json["stuck"][0]["states"], "stick/slip");
  EXPECT_EQ(json["stuck"][0]["place"], (Json{1, 2, 3}));
}

TEST(Summary, WarningsSayWhatWhereAndWhatToDo)
{
  auto s = sample();
  s.warnings.push_back({"large_displacement", "far", "hold it", Point(1, 2, 3), "plate", "", "", 1.5, 0.05, "pull"});
  s.warnings.push_back({"facet_push", "push", "refine"});
  const auto json = Json::parse(to_json(s))["warnings"];
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(keys(json[0]), (std::vector<std::string>{"kind", "text", "place", "value", "limit", "cure", "step"}));
  EXPECT_EQ(keys(json[0]["place"]), (std::vector<std::string>{"coordinates", "body"}));
  EXPECT_EQ(json[0]["place"]["coordinates"], (Json{1, 2, 3}));
  EXPECT_EQ(json[0]["place"]["body"], "plate");
  EXPECT_EQ(json[0]["value"], 1.5);
  EXPECT_TRUE(json[1]["place"].empty());
  EXPECT_FALSE(json[1].contains("step"));
}

TEST(Summary, WhatIsNotFiniteOrNotEstimatedIsNull)
{
  auto s = sample();
  s.strain_energy = std::nan("");
  s.residuals.equality = INFINITY;
  s.reactions[0].force[1] = std::nan("");
  auto json = Json::parse(to_json(s));
  EXPECT_TRUE(json["strain_energy"].is_null());
  EXPECT_TRUE(json["residuals"]["equality"].is_null());
  EXPECT_TRUE(json["reactions"][0]["force"][1].is_null());
  EXPECT_TRUE(json["error_estimate"]["discretization"].is_null());
  s.error_estimate.discretization = 0.03;
  EXPECT_EQ(Json::parse(to_json(s))["error_estimate"]["discretization"], 0.03);
}

// Who kills the run before its last state must not find one that looks finished.
TEST(Summary, OfARunThatIsNotFinishedClaimsNothing)
{
  auto s = sample();
  s.finished = false;
  const auto json = Json::parse(to_json(s));
  EXPECT_EQ(json["converged"], false);
  EXPECT_TRUE(json["exit_status"].is_null());
}

TEST(Summary, TitleThatIsNotUtf8DoesNotCostTheSummary)
{
  auto s = sample();
  s.title =
      "Druckst\xfc"
      "ck";
  EXPECT_EQ(Json::parse(to_json(s))["title"],
            "Druckst\xef\xbf\xbd"
            "ck");
}

}  // namespace
}  // namespace mortise::io
