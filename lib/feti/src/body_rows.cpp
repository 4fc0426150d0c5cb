#include "body_rows.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <numeric>

#include "base/dense.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

Bodies loaded_bodies(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                     const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  Bodies bodies{rigid_modes(decomposition, clusters, kinematics, comm), {}, {}};
  const int dimension = fem::dimension(kinematics);
  const auto body_count = static_cast<Eigen::Index>(bodies.frames.size());
  bodies.force = Eigen::VectorXd::Zero(body_count);
  bodies.generalised = Eigen::VectorXd::Zero(body_count * bodies.modes);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (int k = 0; k < bodies.modes; ++k)
      bodies.generalised[subdomain.body * bodies.modes + k] += load[s].dot(
          sample(unit_motion(subdomain.body, bodies.frames[subdomain.body], k, kinematics), subdomain.mesh.points, dimension));
    for (Eigen::Index n = 0; n < load[s].size() / dimension; ++n)
      bodies.force[subdomain.body] += load[s].segment(n * dimension, dimension).norm();
  }
  comm.sum_in_place({bodies.force.data(), static_cast<std::size_t>(bodies.force.size())});
  comm.sum_in_place({bodies.generalised.data(), static_cast<std::size_t>(bodies.generalised.size())});
  return bodies;
}

namespace {

// Takes out of `row_values` what the unknowns of one group give way to, part * s with the s that are nearest to each motion, and
// adds what their forces work on it. `first`: the first owned row of `row_values`.
void release(std::span<const Unknown> group, Local first, Bodies& bodies, SparseMatrix& row_values, const Communicator& comm)
{
  const auto count = static_cast<Eigen::Index>(group.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < count; ++k)
    for (const auto& [row, part] : group[static_cast<std::size_t>(k)].parts) entries.emplace_back(row - first, k, part);
  SparseMatrix parts(row_values.rows(), count);
  parts.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd nearest(count, row_values.cols()), gram = Eigen::MatrixXd(SparseMatrix(parts.transpose() * parts));
  nearest = Eigen::MatrixXd(SparseMatrix(parts.transpose() * row_values));
  comm.sum_in_place({nearest.data(), static_cast<std::size_t>(nearest.size())});
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  nearest = dense::solve_symmetric(gram, nearest);
  row_values -= SparseMatrix(parts * SparseMatrix(nearest.sparseView(1.0, 1e-12)));
  for (Eigen::Index k = 0; k < count; ++k) {
    const double force = group[static_cast<std::size_t>(k)].force;
    const Eigen::VectorXd motion = nearest.row(k);
    bodies.generalised += force * motion;
    for (Eigen::Index b = 0; b < bodies.force.size(); ++b)
      if (motion.segment(b * bodies.modes, bodies.modes).norm() > 1e-6) bodies.force[b] += std::abs(force);
  }
}

}  // namespace

BodyRows body_rows(const JumpOperator& jump, Bodies& bodies, const SparseMatrix& g, const constraint::Constraints& constraints,
                   std::span<const Unknown> unknowns, const Communicator& comm)
{
  const auto& contacts = constraints.contacts;
  const Local first = jump.ranges().dirichlet, count = jump.ranges().extra - first;
  BodyRows rows;
  rows.values = rows_of_bodies(jump, g, bodies).topRows(count);
  rows.first_contact = jump.ranges().contacts - first;
  for (std::size_t begin = 0, end = 0; begin < unknowns.size(); begin = end) {
    while (end < unknowns.size() && unknowns[end].group == unknowns[begin].group) ++end;
    release(unknowns.subspan(begin, end - begin), first, bodies, rows.values, comm);
  }
  rows.weight = Eigen::VectorXd::Constant(count, support_weight);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i]) rows.weight[rows.first_contact + static_cast<Local>(contacts.nodes[i].row)] /= support_weight;
  rows.fixed = (rows.weight.array() > 1).cast<double>();
  // What acts along normals of a surface feels facets, too, of motions that let it slide along itself.
  const auto skew = static_cast<Local>(constraints.prescribed.size());
  for (std::size_t i = 0; i < constraints.skew_supports.size(); ++i)
    if (constraints.skew_supports[i].along_normals) rows.fixed[skew + static_cast<Local>(i)] = 0;
  const auto& springs = constraints.springs;
  for (std::size_t i = 0; i < springs.own.size(); ++i)
    if (springs.rows[springs.own[i]].along_normal) rows.fixed[jump.ranges().springs - first + static_cast<Local>(i)] = 0;
  return rows;
}

std::vector<std::vector<int>> units(const BodyRows& rows_of_bodies, const constraint::Contacts& contacts,
                                    const std::vector<bool>& joins, const Bodies& bodies, const Communicator& comm)
{
  struct BodyPair {
    int one, other;
  };
  std::vector<BodyPair> pairs;
  const Eigen::SparseMatrix<double, Eigen::RowMajor, int> rows(rows_of_bodies.values);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    if (!joins[i]) continue;
    int before = -1;
    for (decltype(rows)::InnerIterator entry(rows, rows_of_bodies.first_contact + static_cast<Local>(contacts.nodes[i].row));
         entry; ++entry) {
      const int body = static_cast<int>(entry.col()) / bodies.modes;
      if (std::abs(entry.value()) < 1e-9 || body == before) continue;
      if (before >= 0 && (pairs.empty() || pairs.back().one != before || pairs.back().other != body))
        pairs.push_back({before, body});
      before = body;
    }
  }
  std::vector<int> root(bodies.frames.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int b) {
    while (root[static_cast<std::size_t>(b)] != b) b = root[static_cast<std::size_t>(b)];
    return b;
  };
  for (const auto& pair : comm.all_gather(pairs)) {
    const int a = find(pair.one), b = find(pair.other);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::map<int, std::vector<int>> sets;
  std::vector<std::vector<int>> result;
  for (int b = 0; b < static_cast<int>(root.size()); ++b) {
    result.push_back({b});
    sets[find(b)].push_back(b);
  }
  for (auto& [first, set] : sets)
    if (set.size() > 1) result.push_back(std::move(set));
  return result;
}

}  // namespace mortise::feti
