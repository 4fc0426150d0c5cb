#include "free_motion_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/dense.hpp"
#include "qp/equality.hpp"
#include "sliding_modes.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

namespace {

// A motion is nearly free if the rows feel at most this of it in the root mean square, and three times it anywhere. The normals
// of a faceted cylinder are wrong by about half the difference of neighbouring facet angles.
constexpr double nearly = 0.02;
constexpr double exactly = 1e-7;

// Near-null vectors of the rows of one body, unit in the amplitudes; `rows` is (rows of this rank) x modes.
std::vector<Eigen::VectorXd> unfelt(const Eigen::MatrixXd& rows, double tolerance, const Communicator& comm)
{
  const auto modes = rows.cols();
  Eigen::MatrixXd gram = rows.transpose() * rows;
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  double count = 0;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) count += rows.row(r).squaredNorm() > 0;
  count = std::max(comm.sum(count), 1.0);
  const auto eigen = dense::symmetric_eigenpairs(gram);
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index k = 0; k < modes; ++k) {
    if (eigen.values[k] > tolerance * tolerance * count) break;
    result.emplace_back(eigen.vectors.col(k));
  }
  return result;
}

// Of the space of `basis`, orthonormal columns, what the rows that `counts` marks with 1 do not feel. Collective.
Eigen::MatrixXd unfelt_by(const Eigen::VectorXd& counts, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& basis,
                          double tolerance, const Communicator& comm)
{
  Eigen::MatrixXd result(basis.rows(), 0);
  if (basis.cols() == 0) return result;
  for (const auto& v : unfelt(counts.asDiagonal() * rows * basis, tolerance, comm)) {
    result.conservativeResize(Eigen::NoChange, result.cols() + 1);
    result.rightCols(1) = basis * v;
  }
  return result;
}

double largest(const Eigen::VectorXd& values, const Communicator& comm)
{
  return comm.max(values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0);
}

// Whether all eigenvalues are above this. By Cholesky's factors, whose rounding makes small ones uncertain.
bool all_above(double value, SparseMatrix lower)
{
  for (int j = 0; j < lower.cols(); ++j) lower.coeffRef(j, j) -= value;
  return Cholesky(lower).factorize(lower);
}

}  // namespace

FreeMotionSearch::FreeMotionSearch(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts,
                                   std::span<const constraint::SlidingSurface> sliding_surfaces, const Communicator& comm)
    : bodies_(bodies),
      rows_(rows),
      contacts_(contacts),
      sliding_surfaces_(sliding_surfaces),
      comm_(comm),
      body_count_(static_cast<int>(bodies.frames.size())),
      node_of_row_(static_cast<std::size_t>(rows.values.rows()), -1),
      fixed_(rows.fixed)
{
  for (std::size_t i = 0; i < sliding_surfaces.size(); ++i) {
    at_[sliding_surfaces[i].contact].push_back(i);
    contacts_of_body_[sliding_surfaces[i].body].push_back(sliding_surfaces[i].contact);
  }
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto row = rows.first_contact + static_cast<Local>(contacts.nodes[i].row);
    node_of_row_[static_cast<std::size_t>(row)] = static_cast<int>(i);
    if (!at_.contains(contacts.nodes[i].contact)) fixed_[row] = 1;
  }
}

// From amplitudes of the first body of a unit to those of all its bodies, one below the other.
Eigen::MatrixXd FreeMotionSearch::spread(const std::vector<int>& unit) const
{
  const int modes = bodies_.modes;
  const auto& frame = bodies_.frames[static_cast<std::size_t>(unit.front())];
  Eigen::MatrixXd result(static_cast<Eigen::Index>(unit.size()) * modes, modes);
  for (std::size_t i = 0; i < unit.size(); ++i)
    for (int k = 0; k < modes; ++k)
      result.block(static_cast<Eigen::Index>(i) * modes, k, modes, 1) =
          amplitudes_of(unit_motion(unit.front(), frame, k, bodies_.kinematics),
                        bodies_.frames[static_cast<std::size_t>(unit[i])], bodies_.kinematics);
  return result;
}

FreeMotionSearch::Felt FreeMotionSearch::felt(const std::vector<int>& unit, const Eigen::MatrixXd& spread) const
{
  constexpr double nothing = 1e-14;
  const int modes = bodies_.modes;
  const auto each_entry = [&](const auto& visit) {
    for (std::size_t i = 0; i < unit.size(); ++i)
      for (int k = 0; k < modes; ++k)
        for (SparseMatrix::InnerIterator entry(rows_.values, unit[i] * modes + k); entry; ++entry)
          visit(static_cast<Local>(entry.row()), entry.value(), static_cast<Eigen::Index>(i) * modes + k);
  };
  Felt result;
  each_entry([&](Local row, double, Eigen::Index) { result.row.push_back(row); });
  std::sort(result.row.begin(), result.row.end());
  result.row.erase(std::unique(result.row.begin(), result.row.end()), result.row.end());
  result.values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(result.row.size()), modes);
  each_entry([&](Local row, double value, Eigen::Index amplitude) {
    const auto at = std::lower_bound(result.row.begin(), result.row.end(), row) - result.row.begin();
    for (Eigen::Index k = 0; k < modes; ++k)
      if (std::abs(spread(amplitude, k)) > nothing) result.values(at, k) += value * spread(amplitude, k);
  });
  result.values = rows_.weight(result.row).asDiagonal() * result.values;
  return result;
}

// Those of the contacts that have one on the unit, or whose rows feel it.
std::vector<constraint::SlidingSurface> FreeMotionSearch::surfaces_at(const std::vector<int>& unit, const Felt& felt) const
{
  std::set<int> contacts;
  for (const int body : unit)
    if (const auto own = contacts_of_body_.find(body); own != contacts_of_body_.end())
      contacts.insert(own->second.begin(), own->second.end());
  for (const Local row : felt.row)
    if (const int node = node_of_row_[static_cast<std::size_t>(row)]; node >= 0)
      contacts.insert(contacts_.nodes[static_cast<std::size_t>(node)].contact);
  std::set<std::size_t> surfaces;
  for (const int contact : contacts)
    if (const auto at = at_.find(contact); at != at_.end()) surfaces.insert(at->second.begin(), at->second.end());
  std::vector<constraint::SlidingSurface> result;
  for (const std::size_t surface : surfaces) result.push_back(sliding_surfaces_[surface]);
  return result;
}

double FreeMotionSearch::turning(const FreeMotion& motion) const
{
  double result = 0;
  for (const auto& part : motion.motions) {
    const auto& frame = bodies_.frames[static_cast<std::size_t>(part.body)];
    result = std::max(result, part.rotation.norm() * frame.radius / std::max(part.at(frame.centre).norm(), 1e-300));
  }
  return result;
}

// Whether the normal rows feel no more of a motion than the angles of facets explain: a small part of the velocity there. Flat
// sides have no such angles: what tilts a slender body on one is felt little, and truly.
bool FreeMotionSearch::along_surfaces(const Felt& rows, const Eigen::VectorXd& v, const RigidMotion& motion,
                                      std::span<const constraint::SlidingSurface> sliding_surfaces) const
{
  constexpr double flat = 1e-12, felt = 1e-6;
  std::map<int, double> tilts;  // of contacts
  for (const auto& surface : sliding_surfaces) {
    auto& tilt = tilts[surface.contact];
    tilt = std::max(tilt, surface.tilt_with_kinks);
  }
  double worst = 0;
  for (std::size_t r = 0; r < rows.row.size(); ++r) {
    const int i = node_of_row_[static_cast<std::size_t>(rows.row[r])];
    if (i < 0 || contacts_.bonded[static_cast<std::size_t>(i)]) continue;
    const auto& node = contacts_.nodes[static_cast<std::size_t>(i)];
    const double here = std::abs(rows.values.row(static_cast<Eigen::Index>(r)).dot(v));
    if (!(here > felt)) continue;
    const auto tilt = tilts.find(node.contact);
    const bool is_flat = tilt != tilts.end() && tilt->second < flat;
    worst =
        is_flat ? std::numeric_limits<double>::infinity() : std::max(worst, here / std::max(motion.at(node.at).norm(), 1e-12));
  }
  return comm_.max(worst) <= 3 * nearly;
}

void FreeMotionSearch::find(const std::vector<int>& unit)
{
  // Bodies of which one moves by itself are left to the joint motions.
  if (unit.size() > 1 && std::any_of(found.begin(), found.end(), [&](const FreeMotion& motion) {
        return std::find(unit.begin(), unit.end(), motion.motions.front().body) != unit.end();
      }))
    return;
  const Eigen::MatrixXd spread_unit = spread(unit);
  double force = 0;
  for (const int b : unit) force += bodies_.force[b];
  const Felt felt = this->felt(unit, spread_unit);
  const auto& rows = felt.values;
  Eigen::VectorXd drives = Eigen::VectorXd::Zero(bodies_.modes);
  for (std::size_t i = 0; i < unit.size(); ++i)
    drives += spread_unit.middleRows(static_cast<Eigen::Index>(i) * bodies_.modes, bodies_.modes).transpose() *
              bodies_.generalised.segment(unit[i] * bodies_.modes, bodies_.modes);
  const auto sliding_surfaces = surfaces_at(unit, felt);
  const SlidingModes sliding_modes(unit, bodies_.frames[static_cast<std::size_t>(unit.front())], bodies_.kinematics,
                                   sliding_surfaces);
  const auto add = [&](const Eigen::VectorXd& v, double motion_felt, bool sliding) {
    FreeMotion motion;
    motion.resistance = motion_felt;
    motion.sliding = sliding;
    if (sliding || sliding_modes.slides(v)) motion.sagitta = sliding_modes.sagitta();
    for (const int b : unit) {
      motion.motions.push_back(motion_of(unit, v));
      motion.motions.back().body = b;
    }
    motion.force = force;
    motion.work = force > 0 ? std::abs(drives.dot(v)) / force : 0;
    motion.turning = turning(motion);
    amplitudes_.push_back({unit, spread_unit * v});
    found.push_back(std::move(motion));
  };
  // Three kinds, each in what the ones before leave: what rows do not feel at all; what lets surfaces slide along themselves;
  // what rows hardly feel.
  Eigen::MatrixXd taken(bodies_.modes, 0);
  for (const auto& v : unfelt(rows, nearly, comm_)) {
    if (largest(rows * v, comm_) >= 1e-6) continue;
    taken.conservativeResize(Eigen::NoChange, taken.cols() + 1);
    taken.rightCols(1) = v;
  }
  const auto rotations = static_cast<Eigen::Index>(bodies_.modes - (bodies_.modes > 1 ? fem::dimension(bodies_.kinematics) : 1));
  align_apart(taken, drives, rotations, force);
  for (const auto& v : taken.colwise()) add(v, largest(rows * v, comm_), false);

  Eigen::MatrixXd sliding =
      sliding_modes.free(unfelt_by(fixed_(felt.row), rows, complement(taken), exactly * support_weight, comm_), taken);
  align_apart(sliding, drives, rotations, force);
  for (const auto& v : sliding.colwise()) add(v, sliding_modes.resistance(v), true);

  Eigen::MatrixXd all(bodies_.modes, taken.cols() + sliding.cols());
  all << taken, sliding;
  const Eigen::MatrixXd rest = complement(all);
  if (rest.cols() == 0) return;
  const Eigen::MatrixXd rows_of_rest = rows * rest;
  for (const auto& amplitude : unfelt(rows_of_rest, nearly, comm_)) {
    const Eigen::VectorXd v = rest * amplitude;
    const double worst = largest(rows * v, comm_);
    if (along_surfaces(felt, v, motion_of(unit, v), sliding_surfaces) && worst <= 3 * nearly) add(v, worst, false);
  }
}

// What stops the motions found so far, lower triangle.
SparseMatrix FreeMotionSearch::stops(double weight) const
{
  const Eigen::Index modes = bodies_.modes, size = body_count_ * modes;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < size; ++i) entries.emplace_back(i, i, 0.0);
  for (const auto& [unit, values] : amplitudes_) {
    const auto place = [&, &bodies = unit](Eigen::Index i) {
      return bodies[static_cast<std::size_t>(i / modes)] * modes + i % modes;
    };
    for (Eigen::Index j = 0; j < values.size(); ++j)
      for (Eigen::Index i = j; i < values.size(); ++i) entries.emplace_back(place(i), place(j), weight * values[i] * values[j]);
  }
  SparseMatrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void FreeMotionSearch::find_joint()
{
  constexpr int dense_limit = 3000;
  const int modes = bodies_.modes;
  if (body_count_ < 2 || body_count_ * modes > dense_limit) return;
  const SparseMatrix felt = rows_.values.transpose() * rows_.values;
  SparseMatrix lower = qp::sum_over_ranks(SparseMatrix(felt.triangularView<Eigen::Lower>()), comm_);
  const double weight = std::max(Eigen::VectorXd(lower.diagonal()).maxCoeff(), 1.0);
  const double unfelt = exactly * exactly * weight * 100;
  lower += stops(weight);
  if (all_above(2 * unfelt, lower)) return;
  const Eigen::MatrixXd gram = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  const auto eigen = dense::symmetric_eigenpairs(gram);
  Eigen::Index together = 0;
  while (together < gram.cols() && eigen.values[together] < unfelt) ++together;
  Eigen::MatrixXd basis = eigen.vectors.leftCols(together);
  align_with_loads(basis, bodies_.generalised);
  for (const auto& v : basis.colwise()) {
    FreeMotion motion;
    motion.resistance = largest(rows_.values * v, comm_);
    double force = 0;
    for (int b = 0; b < body_count_; ++b) {
      if (v.segment(b * modes, modes).norm() < 1e-6) continue;
      motion.motions.push_back(combine(b, bodies_.frames[b], v.segment(b * modes, modes), bodies_.kinematics));
      force += bodies_.force[b];
    }
    motion.force = force;
    motion.work = force > 0 ? std::abs(bodies_.generalised.dot(v)) / force : 0;
    motion.turning = turning(motion);
    found.push_back(std::move(motion));
  }
}

}  // namespace mortise::feti
