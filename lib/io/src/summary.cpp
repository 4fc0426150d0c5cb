#include "io/summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"

namespace mortise::io {

namespace {

using Json = nlohmann::ordered_json;

Json number(double x)
{
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}
Json vector(const std::array<double, 3>& x)
{
  return Json::array({number(x[0]), number(x[1]), number(x[2])});
}

Json communication(const Summary::Communication& c)
{
  return {{"messages", number(c.messages)},
          {"bytes", number(c.bytes)},
          {"collectives", number(c.collectives)},
          {"collective_bytes", number(c.collective_bytes)}};
}

// What is not known of the place has no key.
Json place(const Warning& w)
{
  Json json = Json::object();
  if (w.at) json["coordinates"] = vector({(*w.at)[0], (*w.at)[1], (*w.at)[2]});
  if (!w.body.empty()) json["body"] = w.body;
  if (!w.boundary.empty()) json["boundary"] = w.boundary;
  if (!w.contact.empty()) json["contact"] = w.contact;
  return json;
}

Json warning(const Warning& w)
{
  Json json{{"kind", w.kind},           {"text", w.text},           {"place", place(w)},
            {"value", number(w.value)}, {"limit", number(w.limit)}, {"cure", w.cure}};
  if (!w.step.empty()) json["step"] = w.step;
  return json;
}

Json place(const StateSummary::Location& p)
{
  return {{"coordinates", vector(p.coordinates)}, {"body", p.body}};
}

Json probe(const StateSummary::Probe& p)
{
  Json json{{"name", p.name}};
  if (p.path) {
    json["file"] = p.path->file;
    json["points"] = p.path->points;
    json["length"] = number(p.path->length);
    return json;
  }
  if (p.at_point) {
    const auto& s = *p.at_point;
    json["displacement"] = vector(s.displacement);
    json["stress"] = Json::array();
    for (const double x : s.stress) json["stress"].push_back(number(x));
    json["principal_stress"] = vector(s.principal_stress);
    json["von_mises"] = number(s.von_mises);
  } else {
    json[p.largest.empty() ? "smallest" : "largest"] = p.largest.empty() ? p.smallest : p.largest;
    json["value"] = number(p.value);
  }
  if (!p.axes.empty()) json["axes"] = p.axes;
  json["place"] = place(p.place);
  return json;
}

Json band(const StateSummary::Contact::Band& b)
{
  return {{"points", b.points}, {"cells", b.cells}};
}

void add_work(const StateSummary& s, Json& json)
{
  json["friction_steps"] = s.friction_steps;
  json["outer_iterations"] = s.outer_iterations;
  json["hessian_multiplications"] = s.hessian_multiplications;
}

Json reaction(const StateSummary::Reaction& r)
{
  Json json{{"boundary", r.boundary}, {"force", vector(r.force)}};
  if (r.moment) json["moment"] = vector(*r.moment);
  json["name"] = r.name;
  return json;
}

Json coupling(const StateSummary::Coupling& c)
{
  return {{"name", c.name},
          {"boundary", c.boundary},
          {"displacement", vector(c.displacement)},
          {"rotation", vector(c.rotation)},
          {"force", vector(c.force)},
          {"moment", vector(c.moment)},
          {"reaction_force", vector(c.reaction_force)},
          {"reaction_moment", vector(c.reaction_moment)}};
}

Json spring(const StateSummary::Spring& s)
{
  return {{"name", s.name}, {"force", number(s.force)}, {"elongation", number(s.elongation)}};
}

Json contact(const StateSummary::Contact& c)
{
  Json json{{"name", c.name},
            {"force", vector(c.force)},
            {"max_pressure", number(c.max_pressure)},
            {"area", number(c.area)},
            {"open", c.open},
            {"stick", c.stick},
            {"slip", c.slip},
            {"max_recovered_pressure", number(c.max_recovered_pressure)},
            {"max_tension", number(c.max_tension)}};
  if (c.exchanged) json["exchanged"] = true;
  if (c.initial_gap)
    json["initial_gap"] = {{"smallest", number(c.initial_gap->smallest)},
                           {"largest_overlap", number(c.initial_gap->largest_overlap)},
                           {"touching_area", number(c.initial_gap->touching_area)}};
  if (c.preload) json["preload"] = {{"force", number(c.preload->force)}, {"shortening", number(c.preload->shortening)}};
  if (c.undecided)
    json["undecided"] = {{"open_closed", band(c.undecided->open_closed)}, {"stick_slip", band(c.undecided->stick_slip)}};
  return json;
}

Json stuck(const StateSummary::Stuck& s)
{
  return {{"contact", s.contact},     {"points", s.points}, {"states", s.states},
          {"place", vector(s.place)}, {"turns", s.turns},   {"steps", s.steps}};
}

template <class Value>
void add_list(const char* key, const std::vector<Value>& values, Json (*as_json)(const Value&), Json& json)
{
  json[key] = Json::array();
  for (const auto& value : values) json[key].push_back(as_json(value));
}

// In the order that is promised; lists of what a deck need not have are there if it has any.
void add_state(const StateSummary& s, Json& json)
{
  json["residuals"] = {{"projected_gradient", number(s.residuals.projected_gradient)},
                       {"equality", number(s.residuals.equality)},
                       {"equilibrium", number(s.residuals.equilibrium)},
                       {"penetration", number(s.residuals.penetration)},
                       {"complementarity", number(s.residuals.complementarity)},
                       {"supports", number(s.residuals.supports)},
                       {"interfaces", number(s.residuals.interfaces)}};
  json["error_estimate"] = {{"discretization", number(s.error_estimate.discretization)},
                            {"algebraic", number(s.error_estimate.algebraic)}};
  json["strain_energy"] = number(s.strain_energy);
  json["max_von_mises"] = number(s.max_von_mises);
  json["max_displacement"] = number(s.max_displacement);
  json["max_von_mises_place"] = place(s.max_von_mises_place);
  if (!s.probes.empty()) add_list("probes", s.probes, probe, json);
  json["moments_about"] = vector(s.moments_about);
  add_list("reactions", s.reactions, reaction, json);
  if (!s.couplings.empty()) add_list("couplings", s.couplings, coupling, json);
  if (!s.springs.empty()) add_list("springs", s.springs, spring, json);
  add_list("contacts", s.contacts, contact, json);
  add_list("stuck", s.stuck, stuck, json);
}

}  // namespace

std::string interrupted_summary(const std::string& version, const std::string& title, int exit_status)
{
  const Json json{{"version", version},         {"title", title},      {"converged", false},
                  {"exit_status", exit_status}, {"interrupted", true}, {"steps", Json::array()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_json(const Summary& s)
{
  Json json{{"version", s.version},
            {"title", s.title},
            {"converged", s.finished && s.converged},
            {"exit_status", s.finished ? Json(s.exit_status) : Json(nullptr)},
            {"ranks", s.ranks},
            {"primal_unknowns", s.primal_unknowns},
            {"dual_unknowns", s.dual_unknowns},
            {"subdomains", s.subdomains},
            {"clusters", s.clusters},
            {"kernel_dimension", s.kernel_dimension},
            {"single_precision", s.single_precision},
            {"bodies", s.bodies},
            {"body_names", s.body_names},
            {"algorithm", s.algorithm}};
  if (s.finished && s.exit_status == static_cast<int>(ExitStatus::interrupted)) json["interrupted"] = true;
  add_work(s, json);
  add_state(s, json);
  json["warnings"] = Json::array();
  for (const auto& w : s.warnings) json["warnings"].push_back(warning(w));
  for (const auto& step : s.steps) {
    Json state{{"name", step.name}, {"time", number(step.time)}, {"converged", step.converged}};
    add_work(step, state);
    add_state(step, state);
    json["steps"].push_back(std::move(state));
  }
  json["time"] = Json::object();
  for (const char* stage :
       {"total", "mesh", "partition", "assembly", "contact", "factorization", "solve", "multiplication", "output"}) {
    const auto found = s.time.find(stage);
    json["time"][stage] = found == s.time.end() ? Json(0.0) : number(found->second);
  }
  json["peak_memory_bytes"] = std::llround(s.peak_memory_bytes);
  for (const char* stage : {"total", "set_up", "solve", "multiplication"}) {
    if (s.communication.empty()) break;  // not counted
    const auto found = s.communication.find(stage);
    const auto spread = found == s.communication.end() ? Summary::Spread{} : found->second;
    json["communication"][stage] = {{"largest", communication(spread.largest)}, {"mean", communication(spread.mean)}};
  }
  // A title need not be valid UTF-8; it must not cost the user the summary.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mortise::io
