#include "feti/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "contact_gram.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

constexpr std::size_t block_columns = 64;    // copies that go through one matrix together
constexpr int relaxations = 100;             // steps at most that look for the least energy inside
constexpr double relaxed = 0.01;             // of that energy: gain of a step that ends them
constexpr std::size_t most_interfaces = 32;  // of the copies of one subdomain; where they differ more all get what any needs

using Nodes = std::vector<Local>;

// The nodes of a subdomain that a row of B touches, in ascending order.
Nodes interface_nodes(const JumpOperator::Block& block, int dimension)
{
  std::set<Local> nodes;
  for (const Local unknown : block.unknown) nodes.insert(unknown / dimension);
  return {nodes.begin(), nodes.end()};
}

// Subdomains that share a matrix and the nodes of their interfaces: {nodes, members}.
std::vector<std::pair<Nodes, std::vector<std::size_t>>> by_interface(const JumpOperator& jump, const Subdomains& subdomains,
                                                                     int dimension)
{
  std::vector<std::pair<Nodes, std::vector<std::size_t>>> groups;
  for (const auto& [original, members] : by_original(subdomains)) {
    std::map<Nodes, std::vector<std::size_t>> alike;
    for (const std::size_t s : members) alike[interface_nodes(jump.blocks()[s], dimension)].push_back(s);
    if (alike.size() <= most_interfaces) {
      groups.insert(groups.end(), alike.begin(), alike.end());
      continue;
    }
    std::set<Local> any;
    for (const auto& [nodes, list] : alike) any.insert(nodes.begin(), nodes.end());
    groups.emplace_back(Nodes(any.begin(), any.end()), members);
  }
  return groups;
}

// u'K u once conjugate gradients have moved what is not prescribed towards where that is least: an upper bound of the least one.
double relaxed_energy(const SubdomainOperator& subdomain, const std::vector<bool>& fixed, Eigen::VectorXd u)
{
  if (u.isZero(0)) return 0;
  const Eigen::VectorXd diagonal = subdomain.diagonal();
  const auto release = [&](Eigen::VectorXd v) {
    for (Eigen::Index i = 0; i < v.size(); ++i)
      if (fixed[static_cast<std::size_t>(i)]) v[i] = 0;
    return v;
  };
  const Eigen::VectorXd force = subdomain.apply(u);
  double energy = u.dot(force);
  Eigen::VectorXd residual = release(-force), z = residual.cwiseQuotient(diagonal), direction = z;
  double product = residual.dot(z);
  for (int step = 0; step < relaxations && product > 0; ++step) {
    const Eigen::VectorXd image = release(subdomain.apply(direction));
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) break;
    const double length = product / curvature;
    energy -= length * product;
    if (length * product < relaxed * energy) break;
    residual -= length * image;
    z = residual.cwiseQuotient(diagonal);
    const double next = residual.dot(z);
    direction = z + next / product * direction;
    product = next;
  }
  return energy;
}

}  // namespace

Preconditioner::Preconditioner(Kind kind, const partition::Decomposition& decomposition, const JumpOperator& jump,
                               const Subdomains& subdomains, const std::vector<std::vector<double>>& nodal_stiffness,
                               std::span<const qp::Disc> discs, const std::string& factorization, Timers& timers,
                               const Communicator& comm, const ElasticRows* springs)
    : jump_(jump),
      nodal_stiffness_(nodal_stiffness),
      dimension_(decomposition.catalogue.dimension),
      subdomains_(subdomains),
      discs_(discs.begin(), discs.end()),
      springs_(springs),
      comm_(comm),
      timers_(timers)
{
  const int dimension = dimension_;
  collectively(comm, [&] {
    for (auto& [nodes, members] : by_interface(jump, subdomains, dimension)) {
      const std::size_t s = members.front();
      Surface surface;
      for (const Local node : nodes)
        for (int c = 0; c < dimension; ++c) surface.unknowns.push_back(dimension * node + c);
      const auto size = static_cast<int>(surface.unknowns.size());
      surface.weight.resize(size);
      for (int i = 0; i < size; ++i)
        surface.weight[i] =
            1 / nodal_stiffness[s][static_cast<std::size_t>(surface.unknowns[static_cast<std::size_t>(i)] / dimension)];
      surface.stiffness = subdomains[s]->original().interface_stiffness(surface.unknowns, kind == Kind::dirichlet, factorization);
      groups_.push_back({std::move(surface), std::move(members)});
    }
  });
  gram_ = std::make_unique<ContactGram>(jump_, nodal_stiffness, dimension, std::span<const qp::Disc>(), comm_);
  contact_ = gram_.get();
}

Preconditioner::~Preconditioner() = default;

void Preconditioner::fix(std::span<const Local> fixed, std::span<const qp::SlipDirection> slips)
{
  const auto scope = timers_.scope("preconditioner");
  if (comm_.any(!slips.empty())) {
    if (!with_slip_) with_slip_ = std::make_unique<ContactGram>(jump_, nodal_stiffness_, dimension_, discs_, comm_);
    contact_ = with_slip_.get();
    contact_->fix(fixed, slips);
    if (contact_->usable()) return;
  }
  contact_ = gram_.get();
  contact_->fix(fixed, {});
}

double Preconditioner::energy(const Vector& r)
{
  const auto scope = timers_.scope("preconditioner");
  Vector right(r, Teuchos::Copy);
  contact_->apply_inverse(right);
  auto u = jump_.apply_transpose(right);
  double sum = 0;
  for (std::size_t s = 0; s < u.size(); ++s) {
    subdomains_[s]->rotate_back(u[s]);
    for (Eigen::Index i = 0; i < u[s].size(); ++i) u[s][i] /= nodal_stiffness_[s][static_cast<std::size_t>(i / dimension_)];
    std::vector<bool> fixed(static_cast<std::size_t>(u[s].size()), false);
    const bool rotated = subdomains_[s].get() != &subdomains_[s]->original();
    for (const Local i : jump_.blocks()[s].unknown)
      for (Local k = rotated ? i / dimension_ * dimension_ : i; k < (rotated ? (i / dimension_ + 1) * dimension_ : i + 1); ++k)
        fixed[static_cast<std::size_t>(k)] = true;
    sum += relaxed_energy(subdomains_[s]->original(), fixed, std::move(u[s]));
  }
  sum += view(right).cwiseAbs2().dot(RowScaling::compliance_of(jump_));
  return comm_.sum(sum) + (springs_ ? springs_->energy(r) : 0);
}

void Preconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("preconditioner");
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    Vector right(*in, Teuchos::Copy);
    contact_->apply_inverse(right);
    auto forces = jump_.apply_transpose(right);
    for (const auto& [surface, members] : groups_)
      for (std::size_t first = 0; first < members.size(); first += block_columns) {
        const auto count = std::min(block_columns, members.size() - first);
        Eigen::MatrixXd u(surface.weight.size(), static_cast<Eigen::Index>(count));
        for (std::size_t c = 0; c < count; ++c) {
          const std::size_t s = members[first + c];
          subdomains_[s]->rotate_back(forces[s]);
          u.col(static_cast<Eigen::Index>(c)) = forces[s](surface.unknowns).cwiseProduct(surface.weight);
        }
        const Eigen::MatrixXd f = surface.stiffness->apply(u);
        for (std::size_t c = 0; c < count; ++c) {
          const std::size_t s = members[first + c];
          forces[s].setZero();
          forces[s](surface.unknowns) = f.col(static_cast<Eigen::Index>(c)).cwiseProduct(surface.weight);
          subdomains_[s]->rotate(forces[s]);
        }
      }
    Vector result = jump_.apply(forces);
    view(result) += RowScaling::compliance_of(jump_).cwiseProduct(view(right));
    contact_->add_curvature(right, result);
    contact_->apply_inverse(result);
    if (springs_) springs_->add_stiffness(1, *in, result);
    const auto extra = jump_.ranges().end - jump_.ranges().extra;
    view(result).segment(jump_.ranges().extra, extra) = view(*in).segment(jump_.ranges().extra, extra);
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

}  // namespace mortise::feti
