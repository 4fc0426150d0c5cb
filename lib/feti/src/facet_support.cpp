#include "feti/facet_support.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/dense.hpp"
#include "body_rows.hpp"
#include "feti/coarse_problem.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

namespace {

// Of what rows feel differently from node to node, what facets may be the cause of: a part of the root of FreeMotion::sagitta,
// and rounding. More is a shape; but not what round bodies feel of a turn beside the middle of where they press on flat ones,
// whose normals rows have there: less than half, weighted by forces.
constexpr double of_facets = 0.15, rounding = 1e-6, of_rolling = 0.5;

struct Search {
  const DualProblem& problem;
  const std::vector<mesh::Body>& catalogue;
  const Bodies& bodies;
  const BodyRows& rows;
  std::span<const constraint::SlidingSurface> sliding_surfaces;
  Eigen::VectorXd force, slid;  // of each row of this rank: its force, and the jump since the state before
  std::span<const double> bounds;
  double slack;

  Local first() const { return problem.jump().ranges().dirichlet; }
};

// The rows without the tangential ones of the nodes that `slips` marks.
BodyRows without_friction(const Search& search, const std::vector<bool>& slips)
{
  BodyRows result = search.rows;
  Eigen::VectorXd kept = Eigen::VectorXd::Ones(result.values.rows());
  for (std::size_t i = 0; i < slips.size(); ++i) {
    if (!slips[i]) continue;
    const auto& rows = search.problem.node_rows()[i];
    kept.segment(rows.normal + 1 - search.first(), rows.tangents).setZero();
    result.fixed.segment(rows.normal + 1 - search.first(), rows.tangents).setZero();
  }
  result.values = SparseMatrix(kept.asDiagonal() * search.rows.values);
  return result;
}

// What friction holds at most along a motion, the work of normal forces on it, and that of what all normals of a contact feel of
// it alike.
struct Felt {
  double friction = 0, normal = 0, alike = 0;
  bool facets = false;  // the rest is no more than what facets may feel
  bool rolls = false;   // or no more than what round bodies feel beside the middle of where they press
};

Felt feel(const Search& search, const Eigen::VectorXd& amplitudes, double sagitta)
{
  const auto& problem = search.problem;
  const auto& contacts = problem.constraints().contacts;
  const Eigen::VectorXd felt = search.rows.values * amplitudes;
  double last = -1;
  for (const auto& node : contacts.nodes) last = std::max(last, static_cast<double>(node.contact));
  const auto count = static_cast<std::size_t>(problem.communicator().max(last) + 1);
  constexpr std::size_t sums_each = 7;  // friction; area, area * n.v, area * (n.v)^2; normal force, times n.v, (n.v)^2
  std::vector<double> sums(count * sums_each, 0.0);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    if (contacts.bonded[i]) continue;
    const auto& rows = problem.node_rows()[i];
    double* sum = &sums[static_cast<std::size_t>(contacts.nodes[i].contact) * sums_each];
    const double normal = felt[rows.normal - search.first()], area = contacts.nodes[i].area;
    if (rows.disc >= 0)
      sum[0] += search.bounds[static_cast<std::size_t>(rows.disc)] *
                felt.segment(rows.normal + 1 - search.first(), rows.tangents).norm();
    sum[1] += area;
    sum[2] += area * normal;
    sum[3] += area * normal * normal;
    sum[4] += search.force[rows.normal];
    sum[5] += search.force[rows.normal] * normal;
    sum[6] += search.force[rows.normal] * normal * normal;
  }
  problem.communicator().sum_in_place(sums);
  Felt result;
  double scatter = 0, rolling = 0;
  for (std::size_t c = 0; c < count; ++c) {
    const double* sum = &sums[c * sums_each];
    result.friction += sum[0];
    result.normal += sum[5];
    if (!(sum[1] > 0)) continue;
    const double mean = sum[2] / sum[1];
    result.alike += mean * sum[4];
    scatter = std::max(scatter, std::sqrt(std::max(sum[3] / sum[1] - mean * mean, 0.0)));
    if (sum[4] > 0) rolling = std::max(rolling, std::sqrt(std::max(sum[6] / sum[4], 0.0)));
  }
  result.facets = scatter < of_facets * std::sqrt(sagitta) + rounding;
  result.rolls = rolling < of_rolling;
  return result;
}

// The motion in the space of `basis`, columns of amplitudes, that comes nearest to what contact nodes slid, weighted with what
// friction holds there.
Eigen::VectorXd slid_along(const Search& search, const Eigen::MatrixXd& basis)
{
  const auto& problem = search.problem;
  const Eigen::MatrixXd felt = search.rows.values * basis;
  const auto count = basis.cols();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, count + 1);
  for (const auto& rows : problem.node_rows()) {
    if (rows.disc < 0) continue;
    const double bound = search.bounds[static_cast<std::size_t>(rows.disc)];
    const auto there = felt.middleRows(rows.normal + 1 - search.first(), rows.tangents);
    sums.leftCols(count) += bound * there.transpose() * there;
    sums.col(count) += bound * there.transpose() * search.slid.segment(rows.normal + 1, rows.tangents);
  }
  problem.communicator().sum_in_place({sums.data(), static_cast<std::size_t>(sums.size())});
  return basis * dense::minimum_norm(sums.leftCols(count), sums.col(count));
}

// Whether every contact node that presses and feels the motion slid along it.
bool all_slid(const Search& search, const Eigen::VectorXd& amplitudes)
{
  constexpr double presses = 1e-3, feels = 0.1, most_of_it = 0.5;
  const auto& problem = search.problem;
  const Eigen::VectorXd felt = search.rows.values * amplitudes;
  struct Node {
    double bound, speed, slid;
  };
  std::vector<Node> nodes;
  double hardest = 0, fastest = 0;
  for (const auto& rows : problem.node_rows()) {
    if (rows.disc < 0) continue;
    const auto there = felt.segment(rows.normal + 1 - search.first(), rows.tangents);
    nodes.push_back({search.bounds[static_cast<std::size_t>(rows.disc)], there.norm(),
                     there.dot(search.slid.segment(rows.normal + 1, rows.tangents))});
    hardest = std::max(hardest, nodes.back().bound);
    fastest = std::max(fastest, nodes.back().speed);
  }
  const auto& comm = problem.communicator();
  hardest = comm.max(hardest), fastest = comm.max(fastest);
  return hardest > 0 && fastest > 0 && !comm.any(std::any_of(nodes.begin(), nodes.end(), [&](const Node& node) {
    return node.bound > presses * hardest && node.speed > feels * fastest && node.slid < most_of_it * node.speed * node.speed;
  }));
}

constexpr double of_forces = 1e-3;  // what facets make of a weight may work on a motion

// The motions of bodies that move as one, and the loads on them.
struct Unit {
  std::vector<FreeMotion> motions;
  Eigen::MatrixXd amplitudes;  // a column for each motion
  double forces = 0, size = 0;
  double sagitta = 0;
};

Unit unit_of(const Search& search, const BodyRows& rows, const std::vector<int>& members)
{
  const auto& bodies = search.bodies;
  Unit unit{motions_of_unit(bodies, rows, search.problem.constraints().contacts, members, search.sliding_surfaces,
                            search.problem.communicator()),
            {}};
  unit.amplitudes = Eigen::MatrixXd::Zero(bodies.generalised.size(), static_cast<Eigen::Index>(unit.motions.size()));
  for (std::size_t k = 0; k < unit.motions.size(); ++k) {
    for (const auto& part : unit.motions[k].motions)
      unit.amplitudes.col(static_cast<Eigen::Index>(k)).segment(part.body * bodies.modes, bodies.modes) =
          amplitudes_of(part, bodies.frames[static_cast<std::size_t>(part.body)], bodies.kinematics);
    unit.sagitta = std::max(unit.sagitta, unit.motions[k].sagitta);
  }
  for (const int body : members) {
    unit.forces += bodies.force[body];
    unit.size = std::max(unit.size, bodies.frames[static_cast<std::size_t>(body)].radius);
  }
  return unit;
}

std::string name(const Search& search, const RigidMotion& motion)
{
  return fmt::format("body \"{}\" {}", search.catalogue[static_cast<std::size_t>(motion.body)].name,
                     describe(motion, search.bodies.frames[static_cast<std::size_t>(motion.body)].radius));
}

// The first of the motions of a unit that the bounds of friction do not hold.
std::optional<std::string> more_than_friction(const Search& search, const Unit& unit)
{
  for (std::size_t k = 0; k < unit.motions.size(); ++k) {
    Eigen::VectorXd amplitudes = unit.amplitudes.col(static_cast<Eigen::Index>(k));
    double drive = search.bodies.generalised.dot(amplitudes);
    if (std::abs(drive) <= of_forces * unit.forces) continue;
    if (drive < 0) amplitudes *= -1, drive *= -1;
    const Felt felt = feel(search, amplitudes, unit.motions[k].sagitta);
    if (!felt.facets && !felt.rolls) continue;
    const double missing = drive - felt.friction - (felt.facets ? felt.alike : 0);
    if (missing <= std::max(search.slack * felt.friction, of_forces * unit.forces)) continue;
    return name(search, unit.motions[k].motions.front()) + fmt::format(
                                                               "; friction holds {:.3g} % of what drives it, and facets of the "
                                                               "mesh are no support, nor is pressure that turned aside",
                                                               100 * felt.friction / drive);
  }
  return {};
}

// A motion along which all that rubs slid by a good part of the unit's size, and on which pressure does no work, as it does in a
// taper. Friction does not grow with the way: where it held in the end, the tilts of facets, were they of rounding alone, have
// wedged the surfaces together, or turns that are no longer small have moved where round ends press and shortened the loads'
// levers; pressure then works on the motion by a part of the drive that grows with the way.
std::optional<std::string> slid_away(const Search& search, const Unit& unit)
{
  constexpr double of_drive = 5e-3, of_size = 0.1, of_way = 0.2;
  if (unit.motions.empty()) return {};
  const Eigen::VectorXd amplitudes = slid_along(search, unit.amplitudes);
  const double way = amplitudes.norm(), drive = search.bodies.generalised.dot(amplitudes);
  if (way <= of_size * unit.size || drive <= of_forces * unit.forces * way || !all_slid(search, amplitudes)) return {};
  const Felt felt = feel(search, amplitudes / way, unit.sagitta);
  const double least = of_drive * drive / way;
  const double turned = std::max(least, of_way * std::min(1.0, way / unit.size) * drive / way);
  if (felt.normal > least && (felt.alike > least || felt.normal - felt.alike > turned)) return {};
  const auto body = static_cast<int>(unit.motions.front().motions.front().body);
  const auto& bodies = search.bodies;
  return name(search, combine(body, bodies.frames[static_cast<std::size_t>(body)],
                              amplitudes.segment(body * bodies.modes, bodies.modes) / way, bodies.kinematics)) +
         fmt::format(", {:.2g} of its size; friction alone resists, and does not hold it", way / unit.size);
}

std::optional<std::string> beyond_friction(const Search& search, const BodyRows& rows, const std::vector<std::vector<int>>& units)
{
  for (const auto& members : units) {
    const Unit unit = unit_of(search, rows, members);
    if (auto found = more_than_friction(search, unit)) return found;
    if (auto found = slid_away(search, unit)) return found;
  }
  return {};
}

}  // namespace

std::optional<std::string> supported_by_facets(const DualProblem& problem, const partition::Decomposition& decomposition,
                                               fem::Kinematics kinematics,
                                               std::span<const constraint::SlidingSurface> sliding_surfaces, const Vector& lambda,
                                               const std::vector<Eigen::VectorXd>& displacement, std::span<const double> bounds,
                                               double slack)
{
  constexpr double at_bound = 1 - 1e-3;
  const auto& comm = problem.communicator();
  const auto& contacts = problem.constraints().contacts;
  if (!comm.any(!bounds.empty())) return {};
  Bodies bodies = loaded_bodies(decomposition, problem.system().clusters(), kinematics, problem.load(), comm);
  const BodyRows rows = body_rows(problem.jump(), bodies, problem.equality().local(), problem.constraints(),
                                  unknowns(problem.constraints(), problem.jump(), problem.dimension()), comm);
  Eigen::VectorXd slid = problem.jumps(displacement);
  for (std::size_t r = 0; r < contacts.rows.bound.size(); ++r)
    slid[problem.jump().ranges().contacts + static_cast<Local>(r)] -= contacts.rows.bound[r];
  const Search search{
      problem, decomposition.catalogue.bodies, bodies, rows, sliding_surfaces, problem.forces(lambda), std::move(slid), bounds,
      slack};

  std::vector<bool> rubs(contacts.nodes.size()), slips(contacts.nodes.size()), joins = contacts.bonded;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = problem.node_rows()[i];
    rubs[i] = node.disc >= 0;
    if (!rubs[i]) continue;
    const double bound = bounds[static_cast<std::size_t>(node.disc)];
    const double force = search.force.segment(node.normal + 1, node.tangents).norm();
    slips[i] = force >= at_bound * bound;
    joins[i] = !slips[i];
  }
  if (auto found = beyond_friction(search, without_friction(search, rubs), units(rows, contacts, contacts.bonded, bodies, comm)))
    return found;
  auto joined = units(rows, contacts, joins, bodies, comm);
  std::erase_if(joined, [](const auto& unit) { return unit.size() < 2; });
  return beyond_friction(search, without_friction(search, slips), joined);
}

}  // namespace mortise::feti
