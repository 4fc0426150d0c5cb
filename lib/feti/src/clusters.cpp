#include "feti/clusters.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <tuple>

#include "base/error.hpp"
#include "cluster_constraints.hpp"

namespace mortise::feti {

namespace {

constexpr std::size_t clusters_at_once = 64;  // clusters that go through one factor together
constexpr double same = 1e-8;                 // of the entries of B0, by which those of copies may differ

bool agree(const SparseMatrix& a, const SparseMatrix& b)
{
  if (a.rows() != b.rows() || a.cols() != b.cols() || a.nonZeros() != b.nonZeros()) return false;
  if (!std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr())) return false;
  if (!std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize(), b.outerIndexPtr())) return false;
  const Eigen::Map<const Eigen::VectorXd> x(a.valuePtr(), a.nonZeros()), y(b.valuePtr(), b.nonZeros());
  return a.nonZeros() == 0 || (x - y).cwiseAbs().maxCoeff() <= same * x.cwiseAbs().maxCoeff();
}

}  // namespace

// One cluster; all that are copies of it use the same.
struct Clusters::Shape {
  struct Member {
    ClusterConstraint constraint;  // rows of B0, the dependent ones left out
    Eigen::MatrixXd response;      // K^+ B0' of them
    Eigen::MatrixXd g0;            // R'B0' of them
    int first = 0;                 // of its kernel among those of the members
    int modes = 0;
  };
  std::vector<const SubdomainOperator*> operators;
  std::vector<SparseMatrix> constraints;  // all rows, to compare with
  std::vector<Member> members;
  int rows = 0, kernels = 0;
  std::unique_ptr<Cholesky> f0;
  Eigen::LLT<Eigen::MatrixXd> s0;  // G0 F0^-1 G0' + rho A A'

  void respond(const Subdomains& subdomains, std::size_t start);
  void factorize(const std::vector<Eigen::MatrixXd>& part);
  Eigen::MatrixXd solve_f0(Eigen::MatrixXd x) const
  {
    if (rows > 0) f0->solve(x.data(), x.data(), static_cast<int>(x.cols()), rows);
    return x;
  }
  // G0 x and G0' x.
  Eigen::MatrixXd times_g0(const Eigen::MatrixXd& x) const;
  Eigen::MatrixXd times_g0_transpose(const Eigen::MatrixXd& x) const;
};

// K^+ B0' and R'B0' of the members, the subdomains `start` ... .
void Clusters::Shape::respond(const Subdomains& subdomains, std::size_t start)
{
  for (std::size_t i = 0; i < members.size(); ++i) {
    auto& member = members[i];
    const auto& subdomain = *subdomains[start + i];
    member.g0 = subdomain.kernel().transpose() * member.constraint.columns;
    member.modes = static_cast<int>(subdomain.kernel().cols());
    member.first = kernels;
    kernels += member.modes;
    member.response = member.constraint.columns;
    std::vector<double*> columns;
    for (auto column : member.response.colwise()) columns.push_back(column.data());
    subdomain.apply_inverse(columns);
  }
}

void Clusters::Shape::factorize(const std::vector<Eigen::MatrixXd>& part)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [constraint, response, g0, first, modes] : members) {
    const Eigen::MatrixXd own = constraint.columns.transpose() * response;
    for (std::size_t c = 0; c < constraint.row.size(); ++c)
      for (std::size_t r = c; r < constraint.row.size(); ++r)
        entries.emplace_back(constraint.row[r], constraint.row[c],
                             own(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
  }
  SparseMatrix lower(rows, rows);
  lower.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd transpose = Eigen::MatrixXd::Zero(rows, kernels);  // G0'
  for (const auto& member : members)
    for (std::size_t r = 0; r < member.constraint.row.size(); ++r)
      transpose.row(member.constraint.row[r]).segment(member.first, member.modes) =
          member.g0.col(static_cast<Eigen::Index>(r)).transpose();
  f0 = std::make_unique<Cholesky>(lower);
  bool done = f0->factorize(lower);
  if (done) {
    f0->prepare_for_many_solves();
    Eigen::MatrixXd schur = times_g0(solve_f0(std::move(transpose)));
    Eigen::MatrixXd kernel(kernels, part.front().cols());
    for (std::size_t i = 0; i < members.size(); ++i) kernel.middleRows(members[i].first, members[i].modes) = part[i];
    schur += schur.trace() / kernels * kernel * kernel.transpose();
    s0.compute(schur);
    done = s0.info() == Eigen::Success;
  }
  if (!done)
    throw Error(
        ExitStatus::machine,
        "the constraints between the subdomains of a cluster cannot be factorized; look for cells without volume and for extreme "
        "material data, or set decomposition.subdomains_per_cluster to 1");
}

Eigen::MatrixXd Clusters::Shape::times_g0(const Eigen::MatrixXd& x) const
{
  Eigen::MatrixXd result(kernels, x.cols());
  for (const auto& member : members) {
    const Eigen::MatrixXd own = x(member.constraint.row, Eigen::all);
    result.middleRows(member.first, member.modes) = member.g0 * own;
  }
  return result;
}

Eigen::MatrixXd Clusters::Shape::times_g0_transpose(const Eigen::MatrixXd& x) const
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, x.cols());
  for (const auto& member : members) {
    const Eigen::MatrixXd part = member.g0.transpose() * x.middleRows(member.first, member.modes);
    result(member.constraint.row, Eigen::all) += part;
  }
  return result;
}

Clusters::Clusters(const partition::Decomposition& decomposition, const partition::Interface& interface, Subdomains subdomains,
                   const std::vector<std::vector<double>>& nodal_stiffness, fem::Kinematics kinematics)
    : subdomains_(std::move(subdomains)), modes_(fem::rigid_motion_count(kinematics)), part_(subdomains_.size())
{
  kernel_dimension_ = static_cast<int>(decomposition.cluster_count()) * modes_;
  const auto& starts = decomposition.clusters;
  for (std::size_t s = 0; s < subdomains_.size();) {
    const auto next = std::upper_bound(starts.begin(), starts.end(), decomposition.subdomains[s].id);
    const std::size_t end = s + static_cast<std::size_t>(*next - decomposition.subdomains[s].id);
    first_.resize(end, static_cast<int>(next - starts.begin() - 1) * modes_);
    if (end > s + 1) add(decomposition, interface, nodal_stiffness, kinematics, s, end);
    s = end;
  }
}

// The cluster of the subdomains `start` .. `end`-1.
void Clusters::add(const partition::Decomposition& decomposition, const partition::Interface& interface,
                   const std::vector<std::vector<double>>& nodal_stiffness, fem::Kinematics kinematics, std::size_t start,
                   std::size_t end)
{
  auto constraints = cluster_constraints(decomposition, interface, nodal_stiffness, kinematics, start, end);
  const auto copy = std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) {
    const auto& [operators, rows] = std::tie(group.shape->operators, group.shape->constraints);
    if (operators.size() != constraints.size()) return false;
    for (std::size_t i = 0; i < constraints.size(); ++i)
      if (operators[i] != subdomains_[start + i].get() || !agree(rows[i], constraints[i].columns)) return false;
    return true;
  });
  if (copy != groups_.end()) {
    for (std::size_t i = 0; i < constraints.size(); ++i) part_[start + i] = part_[copy->clusters.front() + i];
    copy->clusters.push_back(start);
    return;
  }
  std::vector<Point> points;
  for (std::size_t s = start; s < end; ++s) {
    const auto& own = decomposition.subdomains[s].mesh.points;
    points.insert(points.end(), own.begin(), own.end());
  }
  const Eigen::MatrixXd motions = fem::rigid_motions(points, kinematics);
  Eigen::Index at = 0;
  for (std::size_t s = start; s < end; ++s) {
    const auto& kernel = subdomains_[s]->kernel();
    part_[s] = kernel.transpose() * motions.middleRows(at, kernel.rows());
    at += kernel.rows();
  }
  auto shape = std::make_unique<Shape>();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    shape->operators.push_back(subdomains_[start + i].get());
    shape->constraints.push_back(constraints[i].columns);
  }
  shape->rows = drop_dependent(constraints, nodal_stiffness, fem::dimension(kinematics), start);
  for (auto& constraint : constraints) shape->members.emplace_back().constraint = std::move(constraint);
  shape->respond(subdomains_, start);
  shape->factorize({part_.begin() + static_cast<std::ptrdiff_t>(start), part_.begin() + static_cast<std::ptrdiff_t>(end)});
  groups_.push_back({std::move(shape), {start}});
}

Clusters::Clusters() = default;
Clusters::Clusters(Clusters&&) noexcept = default;
Clusters& Clusters::operator=(Clusters&&) noexcept = default;
Clusters::~Clusters() = default;

Eigen::MatrixXd Clusters::kernel(std::size_t s) const
{
  const auto& own = subdomains_[s]->kernel();
  return part_[s].size() == 0 ? own : Eigen::MatrixXd(own * part_[s]);
}

Eigen::VectorXd Clusters::coordinates(std::size_t s, const Eigen::VectorXd& v) const
{
  const Eigen::VectorXd own = subdomains_[s]->kernel().transpose() * v;
  return part_[s].size() == 0 ? own : Eigen::VectorXd(part_[s].transpose() * own);
}

Eigen::VectorXd Clusters::own_coordinates(std::size_t s, const Eigen::VectorXd& c) const
{
  return part_[s].size() == 0 ? c : Eigen::VectorXd(part_[s] * c);
}

Eigen::VectorXd Clusters::motion(std::size_t s, const Eigen::VectorXd& c) const
{
  return subdomains_[s]->kernel() * own_coordinates(s, c);
}

// take(s, member, B0' mu, alpha) for every subdomain of a cluster.
template <class Take>
void Clusters::balance(const std::vector<Eigen::VectorXd>& f, const Take& take) const
{
  for (const auto& [shape, clusters] : groups_)
    for (std::size_t begin = 0; begin < clusters.size(); begin += clusters_at_once) {
      const auto count = std::min(clusters_at_once, clusters.size() - begin);
      const auto columns = static_cast<Eigen::Index>(count);
      Eigen::MatrixXd right = Eigen::MatrixXd::Zero(shape->rows, columns), moved(shape->kernels, columns);
      Eigen::MatrixXd own;
      for (std::size_t i = 0; i < shape->members.size(); ++i) {
        const auto& member = shape->members[i];
        own.resize(member.response.rows(), columns);
        for (std::size_t c = 0; c < count; ++c) own.col(static_cast<Eigen::Index>(c)) = f[clusters[begin + c] + i];
        const Eigen::MatrixXd part = member.response.transpose() * own;
        right(member.constraint.row, Eigen::all) += part;
        moved.middleRows(member.first, member.modes) = subdomains_[clusters[begin] + i]->kernel().transpose() * own;
      }
      const Eigen::MatrixXd alpha = shape->s0.solve(moved - shape->times_g0(shape->solve_f0(right)));
      const Eigen::MatrixXd mu = shape->solve_f0(right + shape->times_g0_transpose(alpha));
      for (std::size_t i = 0; i < shape->members.size(); ++i) {
        const auto& member = shape->members[i];
        const Eigen::MatrixXd forces = member.constraint.columns * Eigen::MatrixXd(mu(member.constraint.row, Eigen::all));
        for (std::size_t c = 0; c < count; ++c)
          take(clusters[begin + c] + i, forces.col(static_cast<Eigen::Index>(c)),
               alpha.col(static_cast<Eigen::Index>(c)).segment(member.first, member.modes));
      }
    }
}

void Clusters::apply_inverse(std::vector<Eigen::VectorXd>& v, bool rounded) const
{
  std::vector<Eigen::VectorXd> alpha(groups_.empty() ? 0 : v.size());
  balance(v, [&](std::size_t s, const auto& force, const auto& amplitudes) {
    v[s] -= force;
    alpha[s] = amplitudes;
  });
  feti::apply_inverse(subdomains_, v, rounded);
  for (std::size_t s = 0; s < alpha.size(); ++s)
    if (alpha[s].size() > 0) v[s] += subdomains_[s]->kernel() * alpha[s];
}

std::vector<Eigen::VectorXd> Clusters::inner_forces(const std::vector<Eigen::VectorXd>& f) const
{
  std::vector<Eigen::VectorXd> result;
  for (const auto& own : f) result.emplace_back(Eigen::VectorXd::Zero(own.size()));
  balance(f, [&](std::size_t s, const auto& force, const auto&) { result[s] = force; });
  return result;
}

}  // namespace mortise::feti
