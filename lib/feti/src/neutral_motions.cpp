#include "neutral_motions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

namespace {

// R'C R of the rows R of all ranks, C a diagonal matrix of ones and zeros that differs from call to call. Bodies that no row
// joins have no entry in common: what is not zero is looked up once, and added over the ranks alone.
class GramOfRows {
 public:
  // Collective.
  GramOfRows(const SparseMatrix& rows, const Communicator& comm) : rows_(rows), comm_(comm)
  {
    for_each_entry(lower_triangle(Eigen::VectorXd::Ones(rows.rows())), [&](int place, double) { places_.push_back(place); });
    places_ = comm.all_gather(places_);
    std::ranges::sort(places_);
    places_.erase(std::ranges::unique(places_).begin(), places_.end());
  }

  // The lower triangle, zeros above it. Collective.
  Eigen::MatrixXd of(const Eigen::VectorXd& closed) const
  {
    std::vector<double> values(places_.size(), 0.0);
    for_each_entry(lower_triangle(closed), [&](int place, double value) {
      values[static_cast<std::size_t>(std::ranges::lower_bound(places_, place) - places_.begin())] = value;
    });
    comm_.sum_in_place(values);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(rows_.cols(), rows_.cols());
    for (std::size_t i = 0; i < places_.size(); ++i) gram.data()[places_[i]] = values[i];
    return gram;
  }

 private:
  SparseMatrix lower_triangle(const Eigen::VectorXd& closed) const
  {
    const SparseMatrix felt = closed.asDiagonal() * rows_;
    return SparseMatrix(felt.transpose() * felt).triangularView<Eigen::Lower>();
  }
  // visit(place in the dense matrix, value).
  template <class Visit>
  void for_each_entry(const SparseMatrix& matrix, const Visit& visit) const
  {
    for (int column = 0; column < matrix.outerSize(); ++column)
      for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
        visit(static_cast<int>(column * matrix.rows() + entry.row()), entry.value());
  }

  const SparseMatrix& rows_;
  const Communicator& comm_;
  std::vector<int> places_;  // ascending
};

// The amplitudes `now` without what rows with `closed` feel, as a change that takes the rest away.
Eigen::VectorXd unfelt_change(const GramOfRows& rows, const Eigen::VectorXd& closed, const Eigen::VectorXd& now)
{
  constexpr double nothing = 1e-6;
  const Eigen::MatrixXd gram = rows.of(closed);
  const auto eigen = dense::symmetric_eigenpairs(gram);
  const double least = nothing * nothing * std::max(gram.diagonal().maxCoeff(), 1.0);
  const Eigen::Index neutral = (eigen.values.array() < least).count();
  const auto basis = eigen.vectors.leftCols(neutral);
  return -(basis * (basis.transpose() * now));
}

}  // namespace

Eigen::VectorXd largest_on_bodies(const SparseMatrix& rows, const Eigen::VectorXd& forces, const std::vector<bool>& left_out,
                                  const Communicator& comm)
{
  constexpr double unfelt = 1e-9;
  const auto modes = rows.cols() / static_cast<Eigen::Index>(left_out.size());
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(left_out.size()));
  const auto for_each_body = [&](const auto& visit) {
    for (Eigen::Index column = 0; column < rows.cols(); ++column)
      for (SparseMatrix::InnerIterator entry(rows, column); entry; ++entry)
        if (std::abs(entry.value()) > unfelt) visit(entry.row(), column / modes);
  };
  for_each_body([&](Eigen::Index row, Eigen::Index body) { largest[body] = std::max(largest[body], std::abs(forces[row])); });
  for (Eigen::Index b = 0; b < largest.size(); ++b)
    largest[b] = left_out[static_cast<std::size_t>(b)] ? 0.0 : comm.max(largest[b]);
  constexpr double none = std::numeric_limits<double>::infinity();
  Eigen::VectorXd result = Eigen::VectorXd::Constant(rows.rows(), none);
  for_each_body([&](Eigen::Index row, Eigen::Index body) { result[row] = std::min(result[row], largest[body]); });
  return (result.array() == none).select(0, result);
}

Eigen::VectorXd towards_rest(const FeltMotions& felt, const Eigen::VectorXd& now, const Communicator& comm)
{
  constexpr int most = 20;            // times that what stops a motion is taken for closed
  constexpr double rounding = 1e-10;  // of the change
  constexpr double whole = 0.999;     // of the way: what stops it there is where it was before it moved
  const GramOfRows gram(felt.rows, comm);
  Eigen::VectorXd closed = felt.closed, gap = felt.gap, way = Eigen::VectorXd::Zero(now.size());
  for (int pass = 0;; ++pass) {
    const Eigen::VectorXd change = unfelt_change(gram, closed, now + way);
    const Eigen::VectorXd closing = felt.rows * change;
    const double least = rounding * change.lpNorm<Eigen::Infinity>();
    double part = 1;
    for (Eigen::Index i = 0; i < closing.size(); ++i)
      if (closing[i] > least && gap[i] < part * closing[i]) part = std::max(gap[i], 0.0) / closing[i];
    part = -comm.max(-part);
    way += part * change;
    if (part >= whole || pass == most) return way;
    gap -= part * closing;
    for (Eigen::Index i = 0; i < closing.size(); ++i)
      if (closing[i] > least && gap[i] <= least) closed[i] = 1;
  }
}

std::vector<bool> travellers(const Eigen::VectorXd& change, const Bodies& bodies)
{
  constexpr double moves = 1e-6, turns = 1;  // over the largest change; radius times angle, over the way of the centre
  constexpr double no_work = 1e-6;           // over the forces on a body times its way
  std::vector<bool> result;
  bool driven = false;
  for (std::size_t b = 0; b < bodies.frames.size(); ++b) {
    const auto& frame = bodies.frames[b];
    const auto first = static_cast<Eigen::Index>(b) * bodies.modes;
    const auto own = change.segment(first, bodies.modes);
    const auto motion = combine(static_cast<int>(b), frame, own, bodies.kinematics);
    const bool on_its_way = own.norm() > moves * change.lpNorm<Eigen::Infinity>();
    const double work = std::abs(own.dot(bodies.generalised.segment(first, bodies.modes)));
    driven = driven || (on_its_way && work > no_work * bodies.force[static_cast<Eigen::Index>(b)] * own.norm());
    result.push_back(on_its_way && motion.rotation.norm() * frame.radius <= turns * motion.at(frame.centre).norm());
  }
  if (!driven) result.assign(result.size(), false);
  return result;
}

Eigen::VectorXd mean_amplitudes(const partition::Decomposition& decomposition, const Bodies& bodies,
                                const std::vector<Eigen::VectorXd>& u, const Communicator& comm)
{
  const int dimension = fem::dimension(bodies.kinematics), modes = bodies.modes;
  const auto count = static_cast<Eigen::Index>(bodies.frames.size());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(count * (modes + 1));  // of each body its modes, then its nodes
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto body = static_cast<Eigen::Index>(subdomain.body);
    for (int k = 0; k < modes; ++k)
      sums[body * (modes + 1) + k] +=
          u[s].dot(sample(unit_motion(subdomain.body, bodies.frames[static_cast<std::size_t>(body)], k, bodies.kinematics),
                          subdomain.mesh.points, dimension));
    sums[body * (modes + 1) + modes] += static_cast<double>(subdomain.mesh.points.size());
  }
  comm.sum_in_place({sums.data(), static_cast<std::size_t>(sums.size())});
  Eigen::VectorXd result(count * modes);
  for (Eigen::Index b = 0; b < count; ++b)
    result.segment(b * modes, modes) = sums.segment(b * (modes + 1), modes) / std::max(sums[b * (modes + 1) + modes], 1.0);
  return result;
}

}  // namespace mortise::feti
