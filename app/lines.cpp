#include "lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mortise {

namespace {

std::string bytes(double count)
{
  const char* unit = "B";
  for (const char* larger : {"kB", "MB", "GB"})
    if (count >= 1000) {
      count /= 1000;
      unit = larger;
    }
  return fmt::format("{:.3g} {}", count, unit);
}

std::string count(long long n, const char* what)
{
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

void print_unresolved_contact(const io::StateSummary& summary, Log& log)
{
  for (const auto& c : summary.contacts) {
    if (!c.undecided) continue;
    const auto& [rim, edge] = *c.undecided;
    if (rim.points > 0)
      log.line("  contact {}: rim known to {}; {} may be open or closed", c.name, count(rim.cells, "cell"),
               count(rim.points, "point"));
    if (edge.points > 0)
      log.line("  contact {}: edge of stick known to {}; {} may stick or slip", c.name, count(edge.cells, "cell"),
               count(edge.points, "point"));
  }
  for (const auto& s : summary.stuck) {
    const auto place = fmt::format("({:.5g}, {:.5g}, {:.5g})", s.place[0], s.place[1], s.place[2]);
    std::string what = "forces that are still to change";
    if (s.states != "at rest")
      what = fmt::format("{} between {} (there {} in {})", s.turns > 1 ? "turns" : "changes", s.states, count(s.turns, "time"),
                         count(s.steps, "step"));
    else if (s.steps > 0)
      what += fmt::format(", though none changed its state in {}", count(s.steps, "step"));
    log.line("  stuck: contact {}: {}, the worst at {}: {}", s.contact, count(s.points, "point"), place, what);
  }
}

void print_couplings(const io::StateSummary& s, Log& log)
{
  // Components that are rounding beside the others are zero.
  const auto pair = [](const std::array<double, 3>& a, const char* between, const std::array<double, 3>& b) {
    double largest = 0;
    for (const auto& x : {a, b})
      for (const double c : x) largest = std::max(largest, std::abs(c));
    const auto print = [&](const std::array<double, 3>& x) {
      const auto clean = [&](double c) { return std::abs(c) < 1e-9 * largest ? 0.0 : c; };
      return fmt::format("({:.5g}, {:.5g}, {:.5g})", clean(x[0]), clean(x[1]), clean(x[2]));
    };
    return print(a) + between + print(b);
  };
  for (const auto& c : s.couplings) {
    log.line("  coupling {}: its point moves {}", c.name, pair(c.displacement, ", turns ", c.rotation));
    log.line("    force on the boundary {}{}", pair(c.force, ", moment about the point ", c.moment),
             c.prescribed ? "; supports react with " + pair(c.reaction_force, ", ", c.reaction_moment) : "");
  }
}

std::string vector(const std::array<double, 3>& x)
{
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", x[0], x[1], x[2]);
}

std::string place(const io::StateSummary::Location& p)
{
  return vector(p.coordinates) + (p.body.empty() ? "" : fmt::format(", body {}", p.body));
}

void print_contacts(const io::StateSummary& s, Log& log)
{
  print_couplings(s, log);
  for (const auto& spring : s.springs)
    log.line("  spring {}: {} with {:.5g}, {} by {:.5g}", spring.name, spring.force < 0 ? "pushes" : "pulls",
             std::abs(spring.force), spring.elongation < 0 ? "shortened" : "extended", std::abs(spring.elongation));
  for (const auto& c : s.contacts) {
    std::string pressure;
    if (c.max_pressure > 0 || !(c.max_tension > 0))
      pressure = fmt::format("largest pressure {:.5g} ({:.5g} at one node), ", c.max_recovered_pressure, c.max_pressure);
    if (c.max_tension > 0) pressure += fmt::format("largest tension {:.5g} at one node, ", c.max_tension);
    log.line("  contact {}: force on the secondary side ({:.5g}, {:.5g}, {:.5g}), {}area {:.4g}; {} open, {} stick, {} slip",
             c.name, c.force[0], c.force[1], c.force[2], pressure, c.area, c.open, c.stick, c.slip);
  }
  for (const auto& c : s.contacts)
    if (c.preload) log.line("  preload {}: force {:.6g}, shortened by {:.6g}", c.name, c.preload->force, c.preload->shortening);
  print_unresolved_contact(s, log);
}

}  // namespace

void print_header(const model::Deck& deck, const model::Contacts& contacts, const partition::Decomposition& decomposition,
                  const Context& context)
{
  const auto& catalogue = decomposition.catalogue;
  context.log.line("Mortise {}: {}", MORTISE_VERSION, deck.title.empty() ? "(no title)" : deck.title);
  context.log.line("  {} bodies, {} nodes, {} cells, {} unknowns; {} subdomains{} on {} ranks; {} contacts",
                   catalogue.bodies.size(), catalogue.node_count, catalogue.cell_count,
                   catalogue.node_count * catalogue.dimension, decomposition.subdomain_count(),
                   decomposition.clustered() ? fmt::format(" in {} clusters", decomposition.cluster_count()) : "",
                   context.comm.size(), contacts.size());
}

void print_check(const model::Model& model, const constraint::Constraints& constraints, const analysis::Memory& memory,
                 const Context& context)
{
  const auto& decomposition = model.decomposition();
  const auto& comm = context.comm;
  const auto& contacts = constraints.contacts;
  const auto& contact_names = model.contacts();
  long long unknowns = 0;
  for (const auto& subdomain : decomposition.subdomains)
    unknowns += static_cast<long long>(subdomain.mesh.node_count()) * model.deck().dimension();
  const auto total = comm.sum(unknowns);
  context.log.line("  {} unknowns in the subdomains, {} prescribed components, {} contact nodes with {} rows", total,
                   comm.sum(static_cast<long long>(constraints.prescribed.size() + constraints.skew_supports.size())),
                   comm.sum(static_cast<long long>(contacts.nodes.size())),
                   comm.sum(static_cast<long long>(contacts.rows.size())));
  std::vector<double> points(contact_names.size(), 0.0);
  for (const auto& point : contacts.nodes) points[static_cast<std::size_t>(point.contact)] += 1;
  comm.sum_in_place(points);
  for (std::size_t c = 0; c < points.size(); ++c) context.log.line("  contact {}: {} points", contact_names[c].name, points[c]);
  context.log.line("  memory expected: about {:.1f} GB, {:.1f} GB of it for the factors of the subdomains", memory.total / 1e9,
                   memory.factors / 1e9);
}

void print_copies(const std::vector<partition::CopyOf>& copies, const partition::Decomposition& decomposition,
                  const Context& context)
{
  long long originals = 0;
  for (std::size_t s = 0; s < copies.size(); ++s) originals += copies[s].original == s ? 1 : 0;
  originals = context.comm.sum(originals);
  if (originals < decomposition.subdomain_count())
    context.log.line("  {} subdomains are copies of {} others and share their factors",
                     decomposition.subdomain_count() - originals, originals);
}

void print_precision(const std::vector<partition::CopyOf>& copies, const feti::Subdomains& subdomains, const Context& context)
{
  struct Group {
    long long count = 0;
    double worst = 0;
    void add(double size, double limit)
    {
      count += size > limit ? 1 : 0;
      worst = std::max(worst, size);
    }
    void reduce(const Communicator& comm)
    {
      count = comm.sum(count);
      worst = comm.max(worst);
    }
  };
  long long originals = 0;
  Group rounded, refined;
  for (std::size_t s = 0; s < copies.size(); ++s) {
    if (copies[s].original != s) continue;
    originals += 1;
    rounded.add(subdomains[s]->rounding(), 0);
    refined.add(subdomains[s]->inaccuracy(), feti::inaccurate);
  }
  originals = context.comm.sum(originals);
  rounded.reduce(context.comm);
  refined.reduce(context.comm);
  if (rounded.count > 0)
    context.log.line("  factors in single precision: {} of {}, exact to {:.0e}", rounded.count, originals, rounded.worst);
  if (refined.count > 0)
    context.log.line("  slender subdomains: {} of {}; their solutions are refined, rounding would change them by {:.0e}",
                     refined.count, originals, refined.worst);
}

void print_state(const model::LoadState& state, std::size_t index, std::size_t count, double seconds_left, Log& log)
{
  constexpr double soon = 10;  // seconds that are not worth a word
  if (state.step.empty()) return;
  const auto left = seconds_left > soon ? fmt::format("; about {:.0f} s left", seconds_left) : "";
  log.line("Step {}, time {:.4g} ({} of {} states{})", state.step, state.time, index + 1, count, left);
}

void print_step(const io::Summary& summary, Log& log)
{
  const auto& s = summary.steps.back();
  print_contacts(s, log);
  log.line("  largest von Mises {:.5g}, largest displacement {:.5g}; {} products with F, {} friction steps", s.max_von_mises,
           s.max_displacement, s.hessian_multiplications, s.friction_steps);
}

// What each support does to the bodies; of many the summary tells. In axisymmetry what pushes a ring outwards needs no support.
void print_reactions(const io::StateSummary& s, Log& log)
{
  constexpr std::size_t most = 16;
  constexpr double rounding = 1e-10;
  double force = 0, moment = 0;  // the largest
  for (const auto& r : s.reactions)
    for (std::size_t c = 0; c < 3; ++c) {
      force = std::max(force, std::abs(r.force[c]));
      if (r.moment) moment = std::max(moment, std::abs((*r.moment)[c]));
    }
  const auto without_noise = [](std::array<double, 3> p, double noise) {
    for (auto& c : p)
      if (!(std::abs(c) > noise)) c = 0;
    return vector(p);
  };
  for (std::size_t i = 0; i < std::min(s.reactions.size(), most); ++i) {
    const auto& r = s.reactions[i];
    if (!r.moment)
      log.line("  support {}: axial force {:.5g}", r.name, r.force[1]);
    else
      log.line("  support {}: force {}, moment {} about {}", r.name, without_noise(r.force, rounding * force),
               without_noise(*r.moment, rounding * moment), vector(s.moments_about));
  }
  if (s.reactions.size() > most) log.line("  and {} supports more, in summary.json", s.reactions.size() - most);
}

void print_results(const post::Verdict& verdict, const post::Balance& b, const io::Summary& s, Log& log)
{
  const auto vector = [](const Point& p) { return fmt::format("({:.5g}, {:.5g}, {:.5g})", p[0], p[1], p[2]); };
  log.line("");
  log.line("{}", verdict.headline);
  if (!verdict.reason.empty()) log.line("  {}", verdict.reason);
  const auto part = [&](const char* name, const Point& force) {
    return force.isZero(0) ? "" : fmt::format("{} {}, ", name, vector(force));
  };
  log.line("  balance of forces   applied {}, supports {}, {}{}difference {:.1e} of the largest force", vector(b.applied),
           vector(b.supports), part("obstacles", b.obstacles),
           part("sectors beside", b.neighbours) + (b.push_of_facets > 1e-6 ? part("against facets", b.gauges) : ""),
           b.difference);
  log.line("  largest von Mises   {:.5g} at {}", s.max_von_mises, place(s.max_von_mises_place));
  log.line("  largest displacement {:.5g}, strain energy {:.6g}", s.max_displacement, s.strain_energy);
  const auto percent = [](double part) {
    return std::isfinite(part) ? fmt::format("about {:.2g} %", 100 * part) : "not estimated";
  };
  log.line("  error               of the mesh {}, of the solver {}, in the energy norm", percent(s.error_estimate.discretization),
           percent(s.error_estimate.algebraic));
  print_reactions(s, log);
  print_contacts(s, log);
  log.line(
      "  residuals           gradient {:.1e}, equality {:.1e}, equilibrium {:.1e}, penetration {:.1e}, complementarity {:.1e}, "
      "supports {:.1e}, interfaces {:.1e}",
      s.residuals.projected_gradient, s.residuals.equality, s.residuals.equilibrium, s.residuals.penetration,
      s.residuals.complementarity, s.residuals.supports, s.residuals.interfaces);
  log.line("  work                {} products with F, {} outer iterations, {} friction steps", s.hessian_multiplications,
           s.outer_iterations, s.friction_steps);
}

void print_probes(const io::StateSummary& summary, Log& log)
{
  for (const auto& p : summary.probes) {
    const auto along = p.axes.empty() ? "" : " along " + p.axes;
    if (p.path)
      log.line("  probe {}: {} points over a length of {:.6g} in {}", p.name, p.path->points, p.path->length, p.path->file);
    else if (p.at_point)
      log.line("  probe {}: displacement {}{}, von Mises {:.6g}, principal stresses {} at {}", p.name,
               vector(p.at_point->displacement), along, p.at_point->von_mises, vector(p.at_point->principal_stress),
               place(p.place));
    else
      log.line("  probe {}: {} {}{} {:.6g} at {}", p.name, p.largest.empty() ? "smallest" : "largest",
               p.largest.empty() ? p.smallest : p.largest, along, p.value, place(p.place));
  }
}

void print_communication(const io::Summary& summary, Log& log)
{
  if (summary.ranks == 1 || summary.communication.empty()) return;
  const auto& [total, mean] = summary.communication.at("total");
  const auto& product = summary.communication.at("multiplication").largest;
  const double products = std::max(summary.hessian_multiplications, 1);
  log.line("  sent by a rank      {} in {:.0f} messages, {} in {:.0f} collective calls; a product with F: {} in {:.3g} messages",
           bytes(total.bytes), total.messages, bytes(total.collective_bytes), total.collectives, bytes(product.bytes / products),
           product.messages / products);
}

void print_times(const std::vector<Timers::Spread>& spreads, Log& log)
{
  log.line("  seconds on the ranks       min     mean      max");
  for (const auto& spread : spreads)
    log.line("    {:<18} {:8.2f} {:8.2f} {:8.2f}", spread.stage, spread.min, spread.mean, spread.max);
}

void print_warnings(const analysis::Warnings& warnings, Log& log)
{
  for (const auto& w : warnings.all())
    log.warning("{}{}; {}", w.step.empty() ? "" : fmt::format("step {}: ", w.step), w.text, w.cure);
}

}  // namespace mortise
