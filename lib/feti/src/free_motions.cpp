#include "feti/free_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/dense.hpp"
#include "body_rows.hpp"
#include "sliding_modes.hpp"

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

}  // namespace

std::string describe(const RigidMotion& motion, double size)
{
  const auto print = [](const Point& p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p[0], p[1], p[2]); };
  const auto clean = [](Point p) { return Point((p.array().abs() < 1e-4 * p.cwiseAbs().maxCoeff()).select(0.0, p)); };
  const double rotation_part = motion.rotation.norm() * size;
  if (rotation_part < 2e-2 * motion.translation.norm() || rotation_part == 0)
    return "moves along " + print(clean(motion.translation.normalized()));
  if (rotation_part < 0.5 * motion.translation.norm())
    return "moves along " + print(clean(motion.translation.normalized())) + ", turning as it goes";
  const Point axis = motion.centre + motion.rotation.cross(motion.translation) / motion.rotation.squaredNorm();
  return "rotates about the axis through " + print(clean(axis)) + " along " + print(clean(motion.rotation.normalized()));
}

std::vector<BodyFrame> body_frames(const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto count = decomposition.catalogue.bodies.size();
  std::vector<double> sums(count * 5, 0.0);  // nodes, x, y, z, |x|^2 about the body's mean in a second pass
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& p : subdomain.mesh.points) {
      double* sum = &sums[static_cast<std::size_t>(subdomain.body) * 5];
      sum[0] += 1;
      for (int c = 0; c < 3; ++c) sum[1 + c] += p[c];
    }
  comm.sum_in_place(sums);
  std::vector<BodyFrame> frames(count);
  std::vector<double> squares(count * 9, 0.0);  // sums of (x - centre)(x - centre)'
  for (std::size_t b = 0; b < count; ++b)
    frames[b].centre = Point(sums[b * 5 + 1], sums[b * 5 + 2], sums[b * 5 + 3]) / std::max(sums[b * 5], 1.0);
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& p : subdomain.mesh.points) {
      const auto b = static_cast<std::size_t>(subdomain.body);
      const Point x = p - frames[b].centre;
      Eigen::Map<Eigen::Matrix3d>(&squares[b * 9]) += x * x.transpose();
    }
  comm.sum_in_place(squares);
  const bool solid = decomposition.catalogue.dimension == 3;
  for (std::size_t b = 0; b < count; ++b) {
    const Eigen::Matrix3d moments = Eigen::Map<Eigen::Matrix3d>(&squares[b * 9]) / std::max(sums[b * 5], 1.0);
    frames[b].radius = std::sqrt(moments.trace());
    if (solid) frames[b].axes = dense::space_eigenpairs(moments).vectors;
    for (int k = 0; k < 3; ++k) {
      const Point axis = frames[b].axes.col(k);
      const double square = moments.trace() - axis.dot(moments * axis);
      frames[b].arms[k] = std::sqrt(std::max(square, 1e-6 * moments.trace()));
    }
  }
  return frames;
}

RigidMotion rigid_part(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                       const BodyFrame& frame, int body, const Eigen::VectorXd& coordinates, const Communicator& comm)
{
  const int dimension = fem::dimension(kinematics);
  const int modes = clusters.modes();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(modes, modes + 1);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    if (subdomain.body != body) continue;
    Eigen::MatrixXd a(modes, modes);
    for (int k = 0; k < modes; ++k)
      a.col(k) = clusters.subdomains()[s]->kernel().transpose() *
                 sample(unit_motion(body, frame, k, kinematics), subdomain.mesh.points, dimension);
    normal.leftCols(modes) += a.transpose() * a;
    normal.rightCols(1) += a.transpose() * clusters.own_coordinates(s, coordinates.segment(clusters.first(s), modes));
  }
  comm.sum_in_place({normal.data(), static_cast<std::size_t>(normal.size())});
  const Eigen::VectorXd amplitudes = dense::solve_symmetric(normal.leftCols(modes), normal.rightCols(1));
  return combine(body, frame, amplitudes, kinematics);
}

namespace {

// Collects the free motions, of one unit after the other and then of several bodies together. Its arguments outlive it.
class FreeMotionSearch {
 public:
  FreeMotionSearch(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts, const Communicator& comm)
      : bodies_(bodies), rows_(rows), contacts_(contacts), comm_(comm), body_count_(static_cast<int>(bodies.frames.size()))
  {
  }

  // Of bodies that move as one. Collective.
  void find(const std::vector<int>& unit, std::span<const constraint::SlidingSurface> sliding_surfaces);
  // The null space of all rows once the motions found so far are stopped. Collective.
  void find_joint();

  std::vector<FreeMotion> found;

 private:
  RigidMotion motion_of(const std::vector<int>& unit, const Eigen::VectorXd& v) const
  {
    return combine(unit.front(), bodies_.frames[static_cast<std::size_t>(unit.front())], v, bodies_.kinematics);
  }
  Eigen::MatrixXd spread(const std::vector<int>& unit) const;
  Eigen::VectorXd fixed(std::span<const constraint::SlidingSurface> sliding_surfaces) const;
  double turning(const FreeMotion& motion) const;
  bool along_surfaces(const Eigen::MatrixXd& rows, const Eigen::VectorXd& v, const RigidMotion& motion,
                      std::span<const constraint::SlidingSurface> sliding_surfaces) const;

  const Bodies& bodies_;
  const BodyRows& rows_;
  const constraint::Contacts& contacts_;
  const Communicator& comm_;
  const int body_count_;
  std::vector<Eigen::VectorXd> amplitudes_;  // of each found motion, over all bodies
};

// From amplitudes of the first body of a unit to those of all its bodies.
Eigen::MatrixXd FreeMotionSearch::spread(const std::vector<int>& unit) const
{
  const int modes = bodies_.modes;
  const auto& frame = bodies_.frames[static_cast<std::size_t>(unit.front())];
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(body_count_ * modes, modes);
  for (const int b : unit)
    for (int k = 0; k < modes; ++k)
      result.block(b * modes, k, modes, 1) = amplitudes_of(unit_motion(unit.front(), frame, k, bodies_.kinematics),
                                                           bodies_.frames[static_cast<std::size_t>(b)], bodies_.kinematics);
  return result;
}

// 1 for each row whose resistance is no matter of facets: of supports, bonds, and the cuts of a sector, which are no surfaces
// that slide past each other. 0 for those of the contacts that `sliding_surfaces` speak of.
Eigen::VectorXd FreeMotionSearch::fixed(std::span<const constraint::SlidingSurface> sliding_surfaces) const
{
  Eigen::VectorXd result = rows_.fixed;
  for (const auto& node : contacts_.nodes)
    if (std::ranges::none_of(sliding_surfaces, [&](const auto& surface) { return surface.contact == node.contact; }))
      result[rows_.first_contact + static_cast<Local>(node.row)] = 1;
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
bool FreeMotionSearch::along_surfaces(const Eigen::MatrixXd& rows, const Eigen::VectorXd& v, const RigidMotion& motion,
                                      std::span<const constraint::SlidingSurface> sliding_surfaces) const
{
  constexpr double flat = 1e-12, felt = 1e-6;
  std::map<int, double> tilts;  // of contacts
  for (const auto& surface : sliding_surfaces) {
    auto& tilt = tilts[surface.contact];
    tilt = std::max(tilt, surface.tilt_with_kinks);
  }
  double worst = 0;
  for (std::size_t i = 0; i < contacts_.nodes.size(); ++i) {
    if (contacts_.bonded[i]) continue;
    const auto& node = contacts_.nodes[i];
    const double here = std::abs(rows.row(rows_.first_contact + static_cast<Local>(node.row)).dot(v));
    if (!(here > felt)) continue;
    const auto tilt = tilts.find(node.contact);
    const bool is_flat = tilt != tilts.end() && tilt->second < flat;
    worst =
        is_flat ? std::numeric_limits<double>::infinity() : std::max(worst, here / std::max(motion.at(node.at).norm(), 1e-12));
  }
  return comm_.max(worst) <= 3 * nearly;
}

void FreeMotionSearch::find(const std::vector<int>& unit, std::span<const constraint::SlidingSurface> sliding_surfaces)
{
  // Bodies of which one moves by itself are left to the joint motions.
  if (unit.size() > 1 && std::any_of(found.begin(), found.end(), [&](const FreeMotion& motion) {
        return std::find(unit.begin(), unit.end(), motion.motions.front().body) != unit.end();
      }))
    return;
  const Eigen::MatrixXd spread_unit = spread(unit);
  double force = 0;
  for (const int b : unit) force += bodies_.force[b];
  const Eigen::MatrixXd rows = rows_.weight.asDiagonal() * Eigen::MatrixXd(rows_.values * spread_unit.sparseView(1.0, 1e-14));
  const Eigen::VectorXd drives = spread_unit.transpose() * bodies_.generalised;
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
    amplitudes_.emplace_back(spread_unit * v);
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
      sliding_modes.free(unfelt_by(fixed(sliding_surfaces), rows, complement(taken), exactly * support_weight, comm_), taken);
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
    if (along_surfaces(rows, v, motion_of(unit, v), sliding_surfaces) && worst <= 3 * nearly) add(v, worst, false);
  }
}

void FreeMotionSearch::find_joint()
{
  constexpr int dense_limit = 3000;
  const int modes = bodies_.modes;
  if (body_count_ < 2 || body_count_ * modes > dense_limit) return;
  Eigen::MatrixXd gram = Eigen::MatrixXd(SparseMatrix(rows_.values.transpose() * rows_.values));
  comm_.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  const double weight = std::max(gram.diagonal().maxCoeff(), 1.0);
  for (const auto& v : amplitudes_) gram += weight * v * v.transpose();
  const auto eigen = dense::symmetric_eigenpairs(gram);
  Eigen::Index together = 0;
  while (together < gram.cols() && eigen.values[together] < exactly * exactly * weight * 100) ++together;
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

}  // namespace

std::vector<FreeMotion> find_free_motions(const partition::Decomposition& decomposition, const JumpOperator& jump,
                                          const Clusters& clusters, fem::Kinematics kinematics, const SparseMatrix& g,
                                          const constraint::Constraints& constraints, std::span<const Unknown> unknowns,
                                          std::span<const constraint::SlidingSurface> sliding_surfaces,
                                          const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  Bodies bodies = loaded_bodies(decomposition, clusters, kinematics, load, comm);
  const BodyRows rows = body_rows(jump, bodies, g, constraints, unknowns, comm);
  FreeMotionSearch search(bodies, rows, constraints.contacts, comm);
  for (const auto& unit : units(rows, constraints.contacts, constraints.contacts.bonded, bodies, comm))
    search.find(unit, sliding_surfaces);
  search.find_joint();
  return std::move(search.found);
}

std::vector<FreeMotion> motions_of_unit(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts,
                                        const std::vector<int>& unit,
                                        std::span<const constraint::SlidingSurface> sliding_surfaces, const Communicator& comm)
{
  FreeMotionSearch search(bodies, rows, contacts, comm);
  search.find(unit, sliding_surfaces);
  return std::move(search.found);
}

FreeMotion loaded_by(FreeMotion motion, const partition::Decomposition& decomposition, const std::vector<Eigen::VectorXd>& load,
                     const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  std::array<double, 2> sums{0, 0};  // work, sum of |nodal forces|
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (const auto& part : motion.motions) {
      if (part.body != subdomain.body) continue;
      sums[0] += load[s].dot(sample(part, subdomain.mesh.points, dimension));
      sums[1] += load[s].reshaped(dimension, load[s].size() / dimension).colwise().norm().sum();
    }
  }
  comm.sum_in_place(sums);
  motion.force = sums[1];
  motion.work = sums[1] > 0 ? std::abs(sums[0]) / sums[1] : 0;
  return motion;
}

}  // namespace mortise::feti
