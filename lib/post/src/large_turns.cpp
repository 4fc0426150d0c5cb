#include "post/large_turns.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "feti/rigid_modes.hpp"
#include "post/drift.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

using NodalVectors = std::vector<Eigen::VectorXd>;  // of each subdomain of this rank

constexpr double much = 0.02;  // of forces

// field(b, x) at each node of body b.
template <class Field>
NodalVectors fields(const partition::Decomposition& decomposition, const Field& field)
{
  const int dimension = decomposition.catalogue.dimension;
  NodalVectors result;
  for (const auto& subdomain : decomposition.subdomains) {
    auto& u = result.emplace_back(static_cast<Eigen::Index>(subdomain.mesh.node_count()) * dimension);
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      u.segment(static_cast<Eigen::Index>(n) * dimension, dimension) =
          Point(field(static_cast<std::size_t>(subdomain.body), subdomain.mesh.points[n])).head(dimension);
  }
  return result;
}

// Of each body the sum of the lengths of nodal forces. Collective.
std::vector<double> sizes_on_bodies(const partition::Decomposition& decomposition, const NodalVectors& force,
                                    const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  std::vector<double> result(decomposition.catalogue.bodies.size(), 0.0);
  for (std::size_t s = 0; s < force.size(); ++s)
    for (Eigen::Index i = 0; i < force[s].size(); i += dimension)
      result[static_cast<std::size_t>(decomposition.subdomains[s].body)] += force[s].segment(i, dimension).norm();
  comm.sum_in_place(result);
  return result;
}

// Of each owned row what it presses with, where it is a contact's.
Eigen::VectorXd pressing_forces(const feti::DualProblem& problem, const Eigen::VectorXd& forces)
{
  const auto& bonded = problem.constraints().contacts.bonded;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(forces.size());
  for (std::size_t i = 0; i < bonded.size(); ++i)
    if (const auto row = problem.node_rows()[i].normal; !bonded[i]) result[row] = std::max(forces[row], 0.0);
  return result;
}

// How firmly each owned row holds: supports and bonds more than contacts, these by their forces, along themselves where they
// stick; gluing rows and gauges feel no rigid motion or are none, what lets a body move along (springs, motions that are unknown)
// holds nothing. Collective.
Eigen::VectorXd firmness(const feti::DualProblem& problem, const Eigen::VectorXd& pressing,
                         std::span<const contact::ContactNodeState> states)
{
  constexpr double firm = 100;  // a hundredth of what contacts feel is left to supports
  const auto& constraints = problem.constraints();
  const auto& ranges = problem.jump().ranges();
  const auto& contacts = constraints.contacts;
  const double largest = problem.communicator().max(pressing.size() > 0 ? pressing.maxCoeff() : 0.0);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(pressing.size());
  result.segment(ranges.dirichlet, ranges.springs - ranges.dirichlet).setConstant(firm);
  for (std::size_t i = 0; i < constraints.prescribed.size(); ++i)
    if (constraints.prescribed[i].unknown) result[ranges.dirichlet + static_cast<Local>(i)] = 0;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (contacts.bonded[i])
      result.segment(rows.normal, rows.tangents + 1).setConstant(firm);
    else if (largest > 0)
      result.segment(rows.normal, states[i].status == contact::Status::stick ? rows.tangents + 1 : 1)
          .setConstant(pressing[rows.normal] / largest);
  }
  for (const auto& section : constraints.pretension_sections)
    if (section.preload.force)
      for (const auto& row : section.rows) result[ranges.contacts + static_cast<Local>(row.row)] = 0;
  return result;
}

// Which part of the second order each contact feels: 1 on flats, 1 - r / R of what is round by r and turns in what is round by R,
// nothing of a turn about the axis of the surface that both share. Of the normals n at pressed points x, of forces lambda, along
// the turn omega of each contact it is how much of omega x (x - mean x) . n rows feel of the rigid motions of first order.
// `length`: of the bodies. Collective.
std::vector<double> felt_of_flats(const feti::DualProblem& problem, const Eigen::VectorXd& pressing, const Eigen::VectorXd& felt,
                                  std::span<const Point> turn, double length)
{
  constexpr double none = 1e-12, conformal = 0.02;  // of the squared way that a turn takes a body, and pressed points apart
  const std::size_t contacts = turn.size();
  struct Sums {
    double force = 0, felt = 0, tilt = 0, across = 0, square = 0, spread = 0;  // the last three of deviations from means
    Point at = Point::Zero();
  };
  static_assert(sizeof(Sums) == sizeof(double) * 9);
  const auto& nodes = problem.constraints().contacts.nodes;
  const auto& comm = problem.communicator();
  std::vector<Sums> sums(contacts);
  const auto for_each = [&](const auto& visit) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Local row = problem.node_rows()[i].normal;
      if (pressing[row] > 0) visit(sums[static_cast<std::size_t>(nodes[i].contact)], nodes[i], pressing[row], felt[row]);
    }
  };
  const auto sum = [&] { comm.sum_in_place({reinterpret_cast<double*>(sums.data()), sums.size() * 9}); };
  for_each([](Sums& s, const auto& node, double force, double feels) {
    s.force += force, s.felt += force * feels, s.at += force * node.at;
  });
  sum();
  auto means = sums;
  for (auto& mean : means)
    if (mean.force > 0) mean.felt /= mean.force, mean.at /= mean.force;
  const auto tilt_of = [&](const constraint::ContactNode& node) {
    const auto c = static_cast<std::size_t>(node.contact);
    return Point(turn[c].cross(node.at - means[c].at));
  };
  sums.assign(contacts, {});
  for_each([&](Sums& s, const auto& node, double force, double) { s.tilt += force * tilt_of(node).dot(node.normal); });
  sum();
  for (std::size_t c = 0; c < contacts; ++c)
    if (means[c].force > 0) means[c].tilt = sums[c].tilt / means[c].force;
  sums.assign(contacts, {});
  for_each([&](Sums& s, const auto& node, double force, double feels) {
    const auto& mean = means[static_cast<std::size_t>(node.contact)];
    const Point way = tilt_of(node);
    const double tilt = way.dot(node.normal) - mean.tilt;
    s.across += force * tilt * (feels - mean.felt), s.square += force * tilt * tilt, s.spread += force * way.squaredNorm();
  });
  sum();
  std::vector<double> result;
  for (std::size_t c = 0; c < contacts; ++c) {
    const auto& s = sums[c];
    const bool spread = s.spread > none * means[c].force * turn[c].squaredNorm() * length * length;  // else a single node
    const bool round = spread && s.square <= conformal * s.spread;
    result.push_back(!spread ? 1 : round ? 0 : std::clamp(std::abs(s.across) / s.square, 0.0, 1.0));
  }
  return result;
}

// How far a body grows by its turn.
double growth_of(const BodyMotion& motion)
{
  return motion.rigid.rotation.norm() * motion.turning / 2;
}

// What each row feels of 1/2 omega x (omega x r), contacts the part that felt_of_flats() says. `length`: of the bodies.
// Collective.
Eigen::VectorXd second_order_felt(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                                  const std::vector<BodyMotion>& turns, std::span<const contact::Pair> pairs,
                                  const Eigen::VectorXd& pressing, double length)
{
  const NodalVectors second_order = fields(decomposition, [&](std::size_t b, const Point& x) {
    const Point& omega = turns[b].rigid.rotation;
    return Point(0.5 * omega.cross(omega.cross(x - turns[b].rigid.centre)));
  });
  const NodalVectors first_order = fields(decomposition, [&](std::size_t b, const Point& x) { return turns[b].rigid.at(x); });
  std::vector<Point> turn;  // of each contact
  for (const auto& bodies : bodies_of_contacts(pairs, problem.communicator())) {
    const auto fastest =
        std::ranges::max_element(bodies, {}, [&](int b) { return growth_of(turns[static_cast<std::size_t>(b)]); });
    turn.push_back(fastest == bodies.end() ? Point(Point::Zero()) : turns[static_cast<std::size_t>(*fastest)].rigid.rotation);
  }
  const auto part = felt_of_flats(problem, pressing, problem.jumps(first_order), turn, length);
  Eigen::VectorXd result = problem.jumps(second_order);
  const auto& contacts = problem.constraints().contacts;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i]) result[problem.node_rows()[i].normal] *= part[static_cast<std::size_t>(contacts.nodes[i].contact)];
  return result;
}

// e + rows v for the amplitudes v that make the sum of its squares, times `weight`, least: by conjugate gradients on the normal
// equations. Collective.
Eigen::VectorXd least_felt(const SparseMatrix& rows, const Eigen::VectorXd& weight, Eigen::VectorXd e, const Communicator& comm)
{
  constexpr int most = 300;
  constexpr double small = 1e-6, rounding = 1e-9;  // of the first descent, and of what it is the sum of: beyond is no motion
  const auto pull = [&](const Eigen::VectorXd& felt) {
    Eigen::VectorXd result = -(rows.transpose() * weight.cwiseProduct(felt));
    comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
    return result;
  };
  Eigen::VectorXd descent = pull(e), direction = descent;
  double square = descent.squaredNorm();
  const double enough = std::max(small * small * square, std::pow(rounding * comm.sum(weight.dot(e.cwiseAbs())), 2));
  for (int k = 0; k < most && square > enough; ++k) {
    const Eigen::VectorXd felt = rows * direction;
    const double curvature = comm.sum(felt.dot(weight.cwiseProduct(felt)));
    if (!(curvature > 0)) break;
    e += square / curvature * felt;
    descent = pull(e);
    const double next = descent.squaredNorm();
    direction = descent + next / square * direction;
    square = next;
  }
  return e;
}

}  // namespace

LargeTurn large_turn(const feti::DualProblem& problem, const Vector& lambda, const partition::Decomposition& decomposition,
                     fem::Kinematics kinematics, const NodalVectors& displacement, std::span<const contact::Pair> pairs,
                     std::span<const contact::ContactNodeState> states, std::span<const double> strain_energy)
{
  // Of all energy, at least, where it is looked at; a point of a body from its centre, over the radius, at most; of the body
  // that feels most of it; of all that contacts feel, what rigid motions leave where nothing holds the bodies, as facets are no
  // curves.
  constexpr double least = 0.1, farthest = 5, concerned = 0.01, rigid = 0.1;
  if (kinematics == fem::Kinematics::axisymmetric) return {};
  const auto& comm = problem.communicator();
  const auto& contacts = problem.constraints().contacts;
  const Eigen::VectorXd forces = problem.forces(lambda), pressing = pressing_forces(problem, forces);
  const double all = comm.sum(pressing.sum());
  if (!(all > 0)) return {};
  const auto turns = rigid_motions(decomposition, kinematics, displacement, comm);
  const auto growth = [&](std::size_t b) { return growth_of(turns[b]); };
  double most = 0, total = 0;
  for (std::size_t b = 0; b < turns.size(); ++b) most = std::max(most, growth(b)), total += strain_energy[b];
  if (!(farthest * most * all > least * much * total)) return {};

  const auto bodies = feti::rigid_modes(decomposition, problem.system().clusters(), kinematics, comm);
  double length = 0;
  for (const auto& frame : bodies.frames) length = std::max(length, frame.radius);
  const Eigen::VectorXd whole = second_order_felt(problem, decomposition, turns, pairs, pressing, length);
  const SparseMatrix rows = feti::rows_of_bodies(problem.jump(), problem.equality().local(), bodies);
  Eigen::VectorXd lacks = whole;
  lacks.tail(rows.rows()) =
      least_felt(rows, firmness(problem, pressing, states).tail(rows.rows()), whole.tail(rows.rows()), comm);
  const Eigen::VectorXd work = pressing.cwiseProduct(lacks), size = work.cwiseAbs();
  const auto of_bodies = sizes_on_bodies(decomposition, problem.jump().apply_transpose(problem.multipliers(size)), comm);
  if (!(comm.sum(size.sum()) > rigid * comm.sum(pressing.dot(whole.cwiseAbs())))) return {};
  LargeTurn result;
  double energy = 0;
  for (std::size_t b = 0; b < of_bodies.size(); ++b) {
    if (!(of_bodies[b] > concerned * *std::ranges::max_element(of_bodies))) continue;
    energy += strain_energy[b];
    if (result.body < 0 || growth(b) > growth(static_cast<std::size_t>(result.body))) result.body = static_cast<int>(b);
  }
  if (result.body < 0) return {};
  result.angle = turns[static_cast<std::size_t>(result.body)].rigid.rotation.norm();
  result.change = comm.sum(size.sum()) / (2 * std::max(energy, 1e-300));
  result.sign = comm.sum(work.sum()) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i])
      result.largest.take(size[problem.node_rows()[i].normal], contacts.nodes[i].at, contacts.nodes[i].contact);
  result.largest = largest_of_ranks({result.largest}, comm).front();
  return result;
}

std::vector<Warning> large_turns(const LargeTurn& turn, std::span<const contact::Pair> pairs,
                                 const std::vector<std::string>& names)
{
  if (!(turn.change > much)) return {};
  const auto& body = names[static_cast<std::size_t>(turn.body)];
  const auto& contact = pairs[static_cast<std::size_t>(turn.largest.body)].options.name;
  Warning w{
      "large_turn",
      fmt::format("body \"{}\" turns by {:.3g} degrees: displacements that are linear in a turn make what turns grow, which "
                  "changes the forces of contacts by {}, most in {} at {}: they are too {}",
                  body, turn.angle * 180 / std::numbers::pi,
                  turn.change < 1 ? fmt::format("about {:.2g} %", 100 * turn.change) : "more than they are", contact,
                  spell(turn.largest.at), turn.sign < 0 ? "large" : "small"),
      "press by forces rather than by given distances, or draw the bodies nearer to where they come to rest"};
  w.at = turn.largest.at;
  w.body = body;
  w.contact = contact;
  w.value = turn.change;
  w.limit = much;
  return {w};
}

}  // namespace mortise::post
