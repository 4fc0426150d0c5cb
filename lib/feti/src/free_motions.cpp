#include "feti/free_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "sliding_modes.hpp"

namespace mortise::feti {

namespace {

// A motion is nearly free if the rows feel at most this of it in the root mean square, and three times it anywhere. The normals
// of a faceted cylinder are wrong by about half the difference of neighbouring facet angles.
constexpr double nearly = 0.02;
constexpr double exactly = 1e-7;
// Facets excuse the normal rows of contacts alone: what supports, bonds and friction feel of a motion counts this often.
constexpr double support_weight = 1e3;

Eigen::VectorXd sample(const RigidMotion& motion, const std::vector<Point>& points, int dimension)
{
  Eigen::VectorXd v(static_cast<Eigen::Index>(points.size()) * dimension);
  for (std::size_t n = 0; n < points.size(); ++n)
    v.segment(static_cast<Eigen::Index>(n) * dimension, dimension) = motion.at(points[n]).head(dimension);
  return v;
}

// Everything body-wise: A maps the amplitudes of the bodies' motions to kernel coordinates of the clusters.
struct Bodies {
  fem::Kinematics kinematics;
  int modes;  // of each body
  std::vector<BodyFrame> frames;
  SparseMatrix aggregate;       // A: kernels x (bodies * modes)
  Eigen::VectorXd force;        // sum of |nodal forces| of each body
  Eigen::VectorXd generalised;  // work of the loads on each unit motion
};

Bodies aggregate(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                 const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  Bodies bodies;
  const int dimension = fem::dimension(kinematics);
  bodies.kinematics = kinematics;
  bodies.modes = fem::rigid_motion_count(kinematics);
  bodies.frames = body_frames(decomposition, comm);
  const auto body_count = static_cast<Eigen::Index>(bodies.frames.size());
  struct Entry {
    int row, column;
    double value;
  };
  std::vector<Entry> entries;
  bodies.force = Eigen::VectorXd::Zero(body_count);
  bodies.generalised = Eigen::VectorXd::Zero(body_count * bodies.modes);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (int k = 0; k < bodies.modes; ++k) {
      const auto v =
          sample(unit_motion(subdomain.body, bodies.frames[subdomain.body], k, kinematics), subdomain.mesh.points, dimension);
      const Eigen::VectorXd coordinates = clusters.coordinates(s, v);
      for (int i = 0; i < coordinates.size(); ++i)
        entries.push_back({clusters.first(s) + i, subdomain.body * bodies.modes + k, coordinates[i]});
      bodies.generalised[subdomain.body * bodies.modes + k] += load[s].dot(v);
    }
    for (Eigen::Index n = 0; n < load[s].size() / dimension; ++n)
      bodies.force[subdomain.body] += load[s].segment(n * dimension, dimension).norm();
  }
  comm.sum_in_place({bodies.force.data(), static_cast<std::size_t>(bodies.force.size())});
  comm.sum_in_place({bodies.generalised.data(), static_cast<std::size_t>(bodies.generalised.size())});
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& entry : comm.all_gather(entries)) triplets.emplace_back(entry.row, entry.column, entry.value);
  bodies.aggregate.resize(clusters.kernel_dimension(), body_count * bodies.modes);
  bodies.aggregate.setFromTriplets(triplets.begin(), triplets.end());
  return bodies;
}

// Near-null vectors of the rows of one body, unit in the amplitudes; `rows` is (rows of this rank) x modes.
std::vector<Eigen::VectorXd> unfelt(const Eigen::MatrixXd& rows, double tolerance, const Communicator& comm)
{
  const auto modes = rows.cols();
  Eigen::MatrixXd gram = rows.transpose() * rows;
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  double count = 0;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) count += rows.row(r).squaredNorm() > 0;
  count = std::max(comm.sum(count), 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index k = 0; k < modes; ++k) {
    if (eigen.eigenvalues()[k] > tolerance * tolerance * count) break;
    result.emplace_back(eigen.eigenvectors().col(k));
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

// The bodies that bonded contacts join, with the others alone: each body by itself first, then the sets of several.
std::vector<std::vector<int>> units(const SparseMatrix& row_values, const constraint::Contacts& contacts, Local first_contact,
                                    int bodies, int modes, const Communicator& comm)
{
  struct BodyPair {
    int one, other;
  };
  std::vector<BodyPair> pairs;
  const Eigen::SparseMatrix<double, Eigen::RowMajor, int> rows(row_values);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    if (!contacts.bonded[i]) continue;
    int before = -1;
    for (decltype(rows)::InnerIterator entry(rows, first_contact + static_cast<Local>(contacts.nodes[i].row)); entry; ++entry) {
      const int body = static_cast<int>(entry.col()) / modes;
      if (std::abs(entry.value()) < 1e-9 || body == before) continue;
      if (before >= 0 && (pairs.empty() || pairs.back().one != before || pairs.back().other != body))
        pairs.push_back({before, body});
      before = body;
    }
  }
  std::vector<int> root(static_cast<std::size_t>(bodies));
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
  for (int b = 0; b < bodies; ++b) {
    result.push_back({b});
    sets[find(b)].push_back(b);
  }
  for (auto& [first, set] : sets)
    if (set.size() > 1) result.push_back(std::move(set));
  return result;
}

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
  nearest = gram.ldlt().solve(nearest).eval();
  row_values -= SparseMatrix(parts * SparseMatrix(nearest.sparseView(1.0, 1e-12)));
  for (Eigen::Index k = 0; k < count; ++k) {
    const double force = group[static_cast<std::size_t>(k)].force;
    const Eigen::VectorXd motion = nearest.row(k);
    bodies.generalised += force * motion;
    for (Eigen::Index b = 0; b < bodies.force.size(); ++b)
      if (motion.segment(b * bodies.modes, bodies.modes).norm() > 1e-6) bodies.force[b] += std::abs(force);
  }
}

// Turns an orthonormal basis so that the loads drive its first vector alone, and in its own sense: of many motions together, that
// is the one to tell.
void align_with_loads(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised)
{
  if (basis.cols() == 0) return;
  const Eigen::VectorXd work = basis.transpose() * generalised;
  if (!(work.norm() > 0)) return;
  Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(work).householderQ();
  if (q.col(0).dot(work) < 0) q.col(0) *= -1;
  basis *= q;
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
    if (solid) frames[b].axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
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
  const Eigen::VectorXd amplitudes = normal.leftCols(modes).ldlt().solve(normal.rightCols(1));
  return combine(body, frame, amplitudes, kinematics);
}

std::vector<FreeMotion> find_free_motions(const partition::Decomposition& decomposition, const JumpOperator& jump,
                                          const Clusters& clusters, fem::Kinematics kinematics, const SparseMatrix& g,
                                          const constraint::Constraints& constraints, std::span<const Unknown> unknowns,
                                          std::span<const constraint::SlidingSurface> sliding_surfaces,
                                          const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  const auto& contacts = constraints.contacts;
  Bodies bodies = aggregate(decomposition, clusters, kinematics, load, comm);
  const int modes = bodies.modes;
  // Rows x amplitudes, in length units again: the support and contact rows that this rank owns.
  const Local first = jump.ranges().dirichlet, count = jump.ranges().extra - first;
  Eigen::VectorXd unscale(count);
  for (Local row = 0; row < count; ++row) unscale[row] = 1 / jump.scaled(first + row, 1);
  SparseMatrix row_values =
      unscale.asDiagonal() * SparseMatrix(SparseMatrix(g.middleCols(first, count)).transpose() * bodies.aggregate);
  const Local first_contact = jump.ranges().contacts - first;
  for (std::size_t begin = 0, end = 0; begin < unknowns.size(); begin = end) {
    while (end < unknowns.size() && unknowns[end].group == unknowns[begin].group) ++end;
    release(unknowns.subspan(begin, end - begin), first, bodies, row_values, comm);
  }
  Eigen::VectorXd weight_of_row = Eigen::VectorXd::Constant(count, support_weight);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i]) weight_of_row[first_contact + static_cast<Local>(contacts.nodes[i].row)] /= support_weight;
  Eigen::VectorXd fixed_row = (weight_of_row.array() > 1).cast<double>();
  // What acts along normals of a surface feels facets, too, of motions that let it slide along itself.
  const auto skew = static_cast<Local>(constraints.prescribed.size());
  for (std::size_t i = 0; i < constraints.skew_supports.size(); ++i)
    if (constraints.skew_supports[i].along_normals) fixed_row[skew + static_cast<Local>(i)] = 0;
  const auto& springs = constraints.springs;
  for (std::size_t i = 0; i < springs.own.size(); ++i)
    if (springs.rows[springs.own[i]].along_normal) fixed_row[jump.ranges().springs - first + static_cast<Local>(i)] = 0;
  // Whether the normal rows feel no more of a motion than the angles of facets explain: a small part of the velocity there.
  const auto along_surfaces = [&](const Eigen::MatrixXd& rows, const Eigen::VectorXd& v, const RigidMotion& motion) {
    double worst = 0;
    for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
      if (contacts.bonded[i]) continue;
      const double here = std::abs(rows.row(first_contact + static_cast<Local>(contacts.nodes[i].row)).dot(v));
      if (here > 1e-6) worst = std::max(worst, here / std::max(motion.at(contacts.nodes[i].at).norm(), 1e-12));
    }
    return comm.max(worst) <= 3 * nearly;
  };
  const auto body_count = static_cast<int>(bodies.frames.size());

  std::vector<FreeMotion> found;
  std::vector<Eigen::VectorXd> amplitudes;  // of each found motion, over all bodies
  for (const auto& unit : units(row_values, contacts, first_contact, body_count, modes, comm)) {
    // Bodies of which one moves by itself are left to the joint motions below.
    if (unit.size() > 1 && std::any_of(found.begin(), found.end(), [&](const FreeMotion& motion) {
          return std::find(unit.begin(), unit.end(), motion.motions.front().body) != unit.end();
        }))
      continue;
    const auto& frame = bodies.frames[static_cast<std::size_t>(unit.front())];
    // From amplitudes of the first body to those of all bodies that move with it.
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(body_count * modes, modes);
    double force = 0;
    for (const int b : unit) {
      for (int k = 0; k < modes; ++k)
        spread.block(b * modes, k, modes, 1) = amplitudes_of(unit_motion(unit.front(), frame, k, kinematics),
                                                             bodies.frames[static_cast<std::size_t>(b)], kinematics);
      force += bodies.force[b];
    }
    const Eigen::MatrixXd rows = weight_of_row.asDiagonal() * Eigen::MatrixXd(row_values * spread.sparseView(1.0, 1e-14));
    const Eigen::VectorXd drives = spread.transpose() * bodies.generalised;
    const auto add = [&](const Eigen::VectorXd& v, double motion_felt, bool sliding) {
      FreeMotion motion;
      motion.resistance = motion_felt;
      motion.sliding = sliding;
      for (const int b : unit) {
        motion.motions.push_back(combine(unit.front(), frame, v, kinematics));
        motion.motions.back().body = b;
      }
      motion.work = force > 0 ? std::abs(drives.dot(v)) / force : 0;
      amplitudes.emplace_back(spread * v);
      found.push_back(std::move(motion));
    };
    // Three kinds, each in what the ones before leave: what rows do not feel at all; what lets surfaces slide along themselves;
    // what rows hardly feel.
    Eigen::MatrixXd taken(modes, 0);
    for (const auto& v : unfelt(rows, nearly, comm)) {
      if (largest(rows * v, comm) >= 1e-6) continue;
      taken.conservativeResize(Eigen::NoChange, taken.cols() + 1);
      taken.rightCols(1) = v;
    }
    align_with_loads(taken, drives);
    for (const auto& v : taken.colwise()) add(v, largest(rows * v, comm), false);

    const SlidingModes sliding_modes(unit, frame, kinematics, sliding_surfaces);
    Eigen::MatrixXd sliding = sliding_modes.free(unfelt_by(fixed_row, rows, complement(taken), exactly * support_weight, comm));
    align_with_loads(sliding, drives);
    for (const auto& v : sliding.colwise()) add(v, sliding_modes.resistance(v), true);

    Eigen::MatrixXd all(modes, taken.cols() + sliding.cols());
    all << taken, sliding;
    const Eigen::MatrixXd rest = complement(all);
    if (rest.cols() == 0) continue;
    const Eigen::MatrixXd rows_of_rest = rows * rest;
    for (const auto& amplitude : unfelt(rows_of_rest, nearly, comm)) {
      const Eigen::VectorXd v = rest * amplitude;
      const double worst = largest(rows * v, comm);
      if (along_surfaces(rows, v, combine(unit.front(), frame, v, kinematics)) && worst <= 3 * nearly) add(v, worst, false);
    }
  }

  // Several bodies together: the null space of all rows once the motions found so far are stopped.
  constexpr int dense_limit = 3000;
  if (body_count < 2 || body_count * modes > dense_limit) return found;
  Eigen::MatrixXd gram = Eigen::MatrixXd(SparseMatrix(row_values.transpose() * row_values));
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  const double weight = std::max(gram.diagonal().maxCoeff(), 1.0);
  for (const auto& v : amplitudes) gram += weight * v * v.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  Eigen::Index together = 0;
  while (together < gram.cols() && eigen.eigenvalues()[together] < exactly * exactly * weight * 100) ++together;
  Eigen::MatrixXd basis = eigen.eigenvectors().leftCols(together);
  align_with_loads(basis, bodies.generalised);
  for (const auto& v : basis.colwise()) {
    FreeMotion motion;
    motion.resistance = largest(row_values * v, comm);
    double force = 0;
    for (int b = 0; b < body_count; ++b) {
      if (v.segment(b * modes, modes).norm() < 1e-6) continue;
      motion.motions.push_back(combine(b, bodies.frames[b], v.segment(b * modes, modes), kinematics));
      force += bodies.force[b];
    }
    motion.work = force > 0 ? std::abs(bodies.generalised.dot(v)) / force : 0;
    found.push_back(std::move(motion));
  }
  return found;
}

double work(const FreeMotion& motion, const partition::Decomposition& decomposition, const std::vector<Eigen::VectorXd>& load,
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
  return sums[1] > 0 ? std::abs(sums[0]) / sums[1] : 0;
}

SubdomainRow gauge(const FreeMotion& motion, const partition::Decomposition& decomposition,
                   const std::vector<std::vector<double>>& nodal_stiffness, const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  SubdomainRow row;
  double square = 0;  // in D^-1
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    row.coefficients.emplace_back();
    for (const auto& part : motion.motions) {
      if (part.body != subdomain.body) continue;
      Eigen::VectorXd v = sample(part, subdomain.mesh.points, dimension);
      for (Eigen::Index i = 0; i < v.size(); ++i) {
        const double stiffness = nodal_stiffness[s][static_cast<std::size_t>(i / dimension)];
        square += stiffness * v[i] * v[i];
        v[i] *= stiffness;
      }
      row.coefficients.back() = std::move(v);
    }
  }
  const double norm = std::sqrt(comm.sum(square));
  for (auto& coefficients : row.coefficients) coefficients /= norm;
  return row;
}

}  // namespace mortise::feti
