#include "post/contact_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "contact/cyclic.hpp"
#include "post/bodies.hpp"
#include "post/model_checks.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double part_of_moment = 0.01, part_of_forces = 0.01, nothing_beside = 1e-6;

// Of each owned row what it feels of a turn about the axis e_k through the origin: with a multiplier of 1, the moment of its
// forces about that axis.
Eigen::VectorXd moments_of_rows(const feti::DualProblem& problem, const partition::Decomposition& decomposition, int k)
{
  const int dimension = problem.dimension();
  std::vector<Eigen::VectorXd> turn;
  for (const auto& subdomain : decomposition.subdomains) {
    auto& u = turn.emplace_back(dimension * static_cast<Eigen::Index>(subdomain.mesh.node_count()));
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      u.segment(dimension * static_cast<Eigen::Index>(n), dimension) =
          Point(Point::Unit(k).cross(subdomain.mesh.points[n])).head(dimension);
  }
  return view(problem.jump().apply(turn));
}

// Of each contact the sum over its points of x_n x (B' lambda)_n and of what goes straight into supports, of all ranks.
// Collective.
std::vector<double> moments(const feti::DualProblem& problem, const Vector& lambda, const partition::Decomposition& decomposition,
                            std::size_t contacts)
{
  const auto& nodes = problem.constraints().contacts.nodes;
  std::vector<double> sums(3 * contacts, 0.0);
  std::vector<int> contact_of_row(static_cast<std::size_t>(problem.jump().ranges().end), -1);
  const auto values = view(lambda);
  for (int k = problem.dimension() == 3 ? 0 : 2; k < 3; ++k) {
    const Eigen::VectorXd of_rows = moments_of_rows(problem, decomposition, k);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (Local row = problem.node_rows()[i].normal; row <= problem.node_rows()[i].normal + problem.node_rows()[i].tangents;
           ++row) {
        contact_of_row[static_cast<std::size_t>(row)] = nodes[i].contact;
        sums[static_cast<std::size_t>(3 * nodes[i].contact + k)] += values[row] * of_rows[row];
      }
  }
  const Eigen::VectorXd forces = problem.forces(lambda);
  for (const auto& entry : problem.constraints().contacts.prescribed) {
    const Local row = problem.jump().ranges().contacts + static_cast<Local>(entry.row);
    const int contact = contact_of_row[static_cast<std::size_t>(row)];
    const Point moment =
        Point(entry.at[0], entry.at[1], entry.at[2]).cross(entry.coefficient * forces[row] * Point::Unit(entry.component));
    for (int k = 0; contact >= 0 && k < 3; ++k) sums[static_cast<std::size_t>(3 * contact + k)] += moment[k];
  }
  problem.communicator().sum_in_place(sums);
  return sums;
}

// How wide the surroundings of a point are: a force there may act somewhere within them.
double width_of(const contact::ContactNodeState& point, const Point& at, fem::Kinematics kinematics)
{
  if (kinematics == fem::Kinematics::solid) return std::sqrt(point.area);
  const double thickness = fem::thickness(kinematics, at[0]);
  return thickness > 0 ? point.area / thickness : 0;
}

// Of each contact the sum of the sizes of the forces at its points, and what they could turn. Collective.
std::vector<ContactMoment> turning(std::span<const constraint::ContactNode> nodes,
                                   std::span<const contact::ContactNodeState> states, std::size_t contacts,
                                   fem::Kinematics kinematics, const Communicator& comm)
{
  std::vector<Found> widest(contacts, Found{0});
  std::vector<double> sums(4 * contacts, 0.0);  // size, size * place
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto c = static_cast<std::size_t>(states[i].contact);
    const double size = states[i].force_on_secondary.norm();
    sums[4 * c] += size;
    if (size > 0) widest[c].take(width_of(states[i], nodes[i].at, kinematics), nodes[i].at);
    for (int k = 0; k < 3; ++k) sums[4 * c + 1 + static_cast<std::size_t>(k)] += size * nodes[i].at[k];
  }
  comm.sum_in_place(sums);
  widest = largest_of_ranks(widest, comm);
  std::vector<double> second(contacts, 0.0);  // size * distance^2 from their centre
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto c = static_cast<std::size_t>(states[i].contact);
    const double* sum = &sums[4 * c];
    const Point centre = sum[0] > 0 ? Point(Point(sum[1], sum[2], sum[3]) / sum[0]) : Point::Zero();
    second[c] += states[i].force_on_secondary.norm() * (nodes[i].at - centre).squaredNorm();
  }
  comm.sum_in_place(second);
  std::vector<ContactMoment> result(contacts);
  for (std::size_t c = 0; c < contacts; ++c) {
    result[c].sizes = sums[4 * c];
    result[c].scale = std::max(std::sqrt(sums[4 * c] * second[c]), sums[4 * c] * widest[c].value);
  }
  return result;
}

Warning about(const contact::Pair& pair, const char* kind, std::string text, std::string cure, double value, double limit)
{
  Warning w{kind, std::move(text), std::move(cure)};
  w.boundary = pair.options.secondary;
  w.contact = pair.options.name;
  w.value = value;
  w.limit = limit;
  return w;
}

}  // namespace

std::vector<ContactMoment> contact_moments(const feti::DualProblem& problem, const Vector& lambda,
                                           const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                           std::span<const contact::Pair> pairs,
                                           std::span<const contact::ContactNodeState> states)
{
  const auto lost = moments(problem, lambda, decomposition, pairs.size());
  auto result = turning(problem.constraints().contacts.nodes, states, pairs.size(), kinematics, problem.communicator());
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (pairs[c].options.obstacle || contact::rotation_of(pairs[c].options))
      result[c] = {};
    else
      result[c].lost = std::hypot(lost[3 * c], lost[3 * c + 1], lost[3 * c + 2]);
  }
  return result;
}

std::vector<Warning> lost_moments(std::span<const ContactMoment> moments, std::span<const contact::Pair> pairs, double forces)
{
  std::vector<Warning> result;
  for (std::size_t c = 0; c < moments.size(); ++c) {
    const auto& m = moments[c];
    if (!(m.lost > part_of_moment * m.scale) || m.sizes < nothing_beside * forces) continue;
    result.push_back(about(
        pairs[c], "lost_moment",
        fmt::format("the two sides of contact {} feel moments that differ by {:.4g}, {:.2g} % of what its forces can turn: as "
                    "if they acted {:.3g} apart",
                    pairs[c].options.name, m.lost, 100 * m.lost / m.scale, m.lost / m.sizes),
        "let the sides lie on each other, or make the cells of curved sides smaller or alike", m.lost, part_of_moment * m.scale));
  }
  return worst(std::move(result), "contacts");
}

std::vector<Warning> loose_fits(std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                double modulus, double size, const Communicator& comm)
{
  constexpr double none = 1e-9;
  std::vector<double> pressure(pairs.size(), 0.0);
  for (const auto& p : states) {
    auto& largest = pressure[static_cast<std::size_t>(p.contact)];
    if (p.area > 0) largest = std::max(largest, p.force / p.area);
  }
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& options = pairs[c].options;
    const double limit = none * modulus * options.interference / size;
    const double largest = comm.max(pressure[c]);
    if (options.law != contact::Law::coulomb || !(options.interference > 0) || largest > limit) continue;
    result.push_back(about(pairs[c], "loose_fit",
                           fmt::format("contact {} presses nowhere, though its sides were to overlap by {:.3g}: they have come "
                                       "apart. Friction may hold them together as well, if it locks itself: then both are "
                                       "equilibria",
                                       options.name, options.interference),
                           "press the parts together by a small load, with which coming apart is no equilibrium, and compare",
                           largest, limit));
  }
  return worst(std::move(result), "contacts", [](const Warning& w) { return w.limit; });
}

std::vector<Warning> tied_preloads(std::span<const constraint::PretensionSection> sections, std::span<const double> shortenings,
                                   std::span<const double> areas, std::span<const contact::Pair> pairs, double modulus)
{
  constexpr double none = 1e-5;
  std::vector<Warning> result;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const auto& preload = sections[i].preload;
    const auto c = static_cast<std::size_t>(preload.contact);
    if (!preload.force || *preload.force == 0 || !(areas[c] > 0)) continue;
    const double limit = none * *preload.force / (modulus * std::sqrt(areas[c]));
    if (std::abs(shortenings[i]) > limit) continue;
    result.push_back(about(pairs[c], "tied_preload",
                           fmt::format("the preload {:.4g} of contact {} shortens nothing: the two parts of its bolt are tied to "
                                       "each other by other bonds at all nodes of the cut, and what it presses stays there",
                                       *preload.force, preload.name),
                           "cut the bolt where nothing else is bonded to it, or make the faces of the cut smaller",
                           std::abs(shortenings[i]), limit));
  }
  return worst(std::move(result), "contacts", [](const Warning& w) { return w.limit; });
}

std::vector<Warning> frictions_across_gaps(std::span<const contact::ContactNodeState> states,
                                           std::span<const contact::Pair> pairs, double forces, const Communicator& comm)
{
  std::vector<double> sums(2 * pairs.size(), 0.0);  // forces at open points, at all points
  std::vector<Found> gaps(pairs.size());
  for (const auto& p : states) {
    const auto c = static_cast<std::size_t>(p.contact);
    const double force = p.force_on_secondary.norm();
    sums[2 * c + 1] += force;
    if (p.status != contact::Status::open) continue;
    sums[2 * c] += force;
    if (force > 0) gaps[c].take(p.gap, Point::Zero());
  }
  comm.sum_in_place(sums);
  gaps = largest_of_ranks(gaps, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const double across = sums[2 * c], all = sums[2 * c + 1];
    if (pairs[c].options.law != contact::Law::tresca || !(across > part_of_forces * all) || all < nothing_beside * forces)
      continue;
    result.push_back(
        about(pairs[c], "friction_across_gap",
              fmt::format(
                  "{:.4g} of {:.4g} of the forces of contact {} act at points that are open, over gaps of up to {:.3g}: Tresca's "
                  "bound holds whether the sides touch or not",
                  across, all, pairs[c].options.name, gaps[c].value),
              "take Coulomb's law, or a boundary that stays closed", across, part_of_forces * all));
  }
  return worst(std::move(result), "contacts");
}

std::vector<Warning> pressing_overlaps(const StartedContacts& all, double work, double modulus, const Communicator& comm)
{
  constexpr double most_of_work = 0.5, least_pressure = 1e-6;
  const auto count = all.pairs.size();
  std::vector<double> works(count, 0.0);
  std::vector<Found> overlaps(count), pressures(count);
  for (std::size_t i = 0; i < std::min(all.nodes.size(), all.states.size()); ++i) {
    const auto& node = all.nodes[i];
    const auto c = static_cast<std::size_t>(node.contact);
    const double asked = all.pairs[c].options.interference;
    const double overlap = -(node.gap / node.weight + std::max(asked, 0.0));
    if (!(overlap > 0) || !(all.states[i].force > 0)) continue;
    works[c] += overlap * all.states[i].force;
    overlaps[c].take(overlap, node.at);
  }
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t i = 0; i < all.surfaces[c].recovered_pressure.size(); ++i)
      pressures[c].take(all.surfaces[c].recovered_pressure[i], all.pairs[c].secondary.points[i]);
  comm.sum_in_place(works);
  overlaps = largest_of_ranks(overlaps, comm);
  pressures = largest_of_ranks(pressures, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < count; ++c) {
    const auto& options = all.pairs[c].options;
    if (options.law == contact::Law::bonded || !(works[c] > most_of_work * work)) continue;
    if (!(pressures[c].value > least_pressure * modulus)) continue;
    if (!unasked_overlaps({&all.gaps[c], 1}, {&options, 1}).empty()) continue;
    auto warning = about(
        all.pairs[c], "overlap",
        fmt::format(
            "contact {}: the two sides overlap by {:.3g} at {} before any load, which `interference` does not ask for and "
            "which does {:.3g} % of all work: it presses with up to {:.3g}, more than the loads do",
            options.name, overlaps[c].value, spell(overlaps[c].at), 100 * works[c] / work, pressures[c].value),
        fmt::format("if it is the meshes' error: `adjust: {:.2g}`, or `clearance: 0` where the two fit", 1.1 * overlaps[c].value),
        overlaps[c].value, 0);
    warning.at = overlaps[c].at;
    result.push_back(std::move(warning));
  }
  return result;
}

}  // namespace mortise::post
