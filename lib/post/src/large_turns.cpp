#include "post/large_turns.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "post/drift.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

using Fields = std::vector<Eigen::VectorXd>;  // of each subdomain of this rank

constexpr double much = 0.02;  // of forces

// Rigid motions of all bodies: of each a translation and a rotation about its centre, times its radius. Motions that a model does
// not have, as those out of a plane, are columns of zeros.
class RigidMotions {
 public:
  RigidMotions(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const Communicator& comm)
      : decomposition_(decomposition),
        dimension_(fem::dimension(kinematics)),
        frames_(feti::body_frames(decomposition, comm)),
        comm_(comm)
  {
  }

  Eigen::Index size() const { return 6 * static_cast<Eigen::Index>(frames_.size()); }
  const std::vector<feti::BodyFrame>& frames() const { return frames_; }

  // field(b, r) at each node of body b, r from its centre.
  template <class Field>
  Fields fields(const Field& field) const
  {
    Fields result;
    for (const auto& subdomain : decomposition_.subdomains) {
      auto& u = result.emplace_back(static_cast<Eigen::Index>(subdomain.mesh.node_count()) * dimension_);
      const auto b = static_cast<std::size_t>(subdomain.body);
      for (Eigen::Index n = 0; n * dimension_ < u.size(); ++n)
        u.segment(n * dimension_, dimension_) = Point(field(b, arm(subdomain, n))).head(dimension_);
    }
    return result;
  }
  Fields of(const Eigen::VectorXd& motion) const
  {
    return fields([&](std::size_t b, const Point& r) {
      const auto v = motion.segment<6>(6 * static_cast<Eigen::Index>(b));
      return Point(v.head<3>() + rotation(v).cross(r) / frames_[b].radius);
    });
  }
  // The transpose: of each body the force and the moment, over its radius. Collective.
  Eigen::VectorXd resultants(const Fields& force) const
  {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size());
    for (std::size_t s = 0; s < force.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      const auto b = static_cast<std::size_t>(subdomain.body);
      auto sum = result.segment<6>(6 * static_cast<Eigen::Index>(b));
      for (Eigen::Index n = 0; n * dimension_ < force[s].size(); ++n) {
        const Point f = at(force[s], n), moment = arm(subdomain, n).cross(f) / frames_[b].radius;
        sum.head<3>() += f;
        if (dimension_ == 3)
          sum.tail<3>() += moment;
        else
          sum[5] += moment[2];
      }
    }
    comm_.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
    return result;
  }
  // Of each body the sum of the lengths of nodal forces. Collective.
  std::vector<double> sizes(const Fields& force) const
  {
    std::vector<double> result(frames_.size(), 0.0);
    for (std::size_t s = 0; s < force.size(); ++s)
      for (Eigen::Index n = 0; n * dimension_ < force[s].size(); ++n)
        result[static_cast<std::size_t>(decomposition_.subdomains[s].body)] += at(force[s], n).norm();
    comm_.sum_in_place(result);
    return result;
  }

 private:
  Point at(const Eigen::VectorXd& field, Eigen::Index n) const
  {
    Point result = Point::Zero();
    result.head(dimension_) = field.segment(n * dimension_, dimension_);
    return result;
  }
  Point arm(const partition::Subdomain& subdomain, Eigen::Index n) const
  {
    return subdomain.mesh.points[static_cast<std::size_t>(n)] - frames_[static_cast<std::size_t>(subdomain.body)].centre;
  }
  template <class Six>
  Point rotation(const Six& v) const
  {
    return dimension_ == 3 ? Point(v.template tail<3>()) : Point(0, 0, v[5]);
  }

  const partition::Decomposition& decomposition_;
  int dimension_;
  std::vector<feti::BodyFrame> frames_;
  const Communicator& comm_;
};

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

// e + row . v of each row for the rigid motions v that make the sum of its squares, times `weight`, least: by conjugate gradients
// on the normal equations. Collective.
Eigen::VectorXd least_felt(const feti::DualProblem& problem, const RigidMotions& motions, const Eigen::VectorXd& weight,
                           Eigen::VectorXd e)
{
  constexpr int most = 300;
  constexpr double small = 1e-6;
  const auto pull = [&](const Eigen::VectorXd& rows) -> Eigen::VectorXd {
    return -motions.resultants(problem.jump().apply_transpose(problem.multipliers(weight.cwiseProduct(rows))));
  };
  Eigen::VectorXd descent = pull(e), direction = descent;
  const double first = descent.squaredNorm();
  double square = first;
  for (int k = 0; k < most && square > small * small * first; ++k) {
    const Eigen::VectorXd felt = problem.jumps(motions.of(direction));
    const double curvature = problem.communicator().sum(felt.dot(weight.cwiseProduct(felt)));
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
                     fem::Kinematics kinematics, const Fields& displacement, std::span<const contact::ContactNodeState> states,
                     std::span<const double> strain_energy)
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
  const auto growth = [&](std::size_t b) { return turns[b].rigid.rotation.norm() * turns[b].turning / 2; };
  double most = 0, total = 0;
  for (std::size_t b = 0; b < turns.size(); ++b) most = std::max(most, growth(b)), total += strain_energy[b];
  if (!(farthest * most * all > least * much * total)) return {};

  const RigidMotions motions(decomposition, kinematics, comm);
  const Fields second_order = motions.fields([&](std::size_t b, const Point& r) {
    const Point& omega = turns[b].rigid.rotation;
    return Point(0.5 * omega.cross(omega.cross(r)));
  });
  const Eigen::VectorXd whole = problem.jumps(second_order);
  const Eigen::VectorXd lacks = least_felt(problem, motions, firmness(problem, pressing, states), whole);
  const Eigen::VectorXd work = pressing.cwiseProduct(lacks), size = work.cwiseAbs();
  const auto of_bodies = motions.sizes(problem.jump().apply_transpose(problem.multipliers(size)));
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
