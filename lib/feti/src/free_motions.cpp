#include "feti/free_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace mortise::feti {

namespace {

// A motion is nearly free if the rows feel at most this of it in the root mean square, and three times it anywhere. The normals
// of a faceted cylinder are wrong by about half the difference of neighbouring facet angles.
constexpr double nearly = 0.02;
constexpr double exactly = 1e-7;
// Facets excuse the normal rows of contacts alone: what supports, bonds and friction feel of a motion counts this often.
constexpr double support_weight = 1e3;

// v of the rigid motions of one body, scaled so that |v| is about 1 on it: 3 translations and 3 rotations about its principal
// axes, each by the nodes' distance from that axis (the spin of a slender bar has a short arm), or 2 and 1, or 1 along the axis
// of revolution.
RigidMotion unit_motion(int body, const BodyFrame& frame, int index, fem::Kinematics kinematics)
{
  RigidMotion motion{body, frame.centre};
  const int dimension = fem::dimension(kinematics);
  if (kinematics == fem::Kinematics::axisymmetric)
    motion.translation[1] = 1;
  else if (index < dimension)
    motion.translation[index] = 1;
  else
    motion.rotation = frame.axes.col(dimension == 2 ? 2 : index - dimension) / frame.arms[dimension == 2 ? 2 : index - dimension];
  return motion;
}

Eigen::VectorXd sample(const RigidMotion& motion, const std::vector<Point>& points, int dimension)
{
  Eigen::VectorXd v(static_cast<Eigen::Index>(points.size()) * dimension);
  for (std::size_t n = 0; n < points.size(); ++n)
    v.segment(static_cast<Eigen::Index>(n) * dimension, dimension) = motion.at(points[n]).head(dimension);
  return v;
}

RigidMotion combine(int body, const BodyFrame& frame, const Eigen::Ref<const Eigen::VectorXd>& amplitudes,
                    fem::Kinematics kinematics)
{
  RigidMotion motion{body, frame.centre};
  for (int k = 0; k < amplitudes.size(); ++k) {
    const auto unit = unit_motion(body, frame, k, kinematics);
    motion.translation += amplitudes[k] * unit.translation;
    motion.rotation += amplitudes[k] * unit.rotation;
  }
  return motion;
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

// The part of a space of amplitudes, columns orthonormal, that is orthogonal to `taken`, whose columns are so too.
Eigen::MatrixXd complement(const Eigen::MatrixXd& taken)
{
  const auto modes = taken.rows();
  if (taken.cols() == 0) return Eigen::MatrixXd::Identity(modes, modes);
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(taken).householderQ();
  return q.rightCols(modes - taken.cols());
}

// Of the rows that `counts` marks with 1 the mean of what they feel, squared, as a form; no row is no form. Collective.
Eigen::MatrixXd mean_square(const Eigen::MatrixXd& rows, const Eigen::VectorXd& counts, const Communicator& comm)
{
  const Eigen::MatrixXd marked = counts.asDiagonal() * rows;
  Eigen::MatrixXd gram = marked.transpose() * marked;
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  double count = 0;
  for (Eigen::Index r = 0; r < marked.rows(); ++r) count += marked.row(r).squaredNorm() > 0;
  return gram / std::max(comm.sum(count), 1.0);
}

// What the surfaces in contact of one body, and those that they touch, say of its motions.
class Slideways {
 public:
  Slideways(int body, const BodyFrame& frame, fem::Kinematics kinematics, std::span<const constraint::Slide> slides)
  {
    std::vector<int> contacts;
    for (const auto& slide : slides)
      if (slide.body == body) contacts.push_back(slide.contact);
    for (const auto& slide : slides) {
      if (std::find(contacts.begin(), contacts.end(), slide.contact) == contacts.end()) continue;
      const int modes = fem::rigid_motion_count(kinematics);
      Eigen::MatrixXd there(6, modes);  // the body's unit motions at the slide's centre
      for (int k = 0; k < modes; ++k) {
        const auto motion = unit_motion(body, frame, k, kinematics);
        there.col(k) << motion.at(slide.centre), motion.rotation * slide.length;
      }
      auto& side = slide.body == body ? own_[slide.contact] : other_[slide.contact];
      side.push_back({there.transpose() * slide.whole * there, there.transpose() * slide.smooth * there,
                      there.transpose() * slide.speed * there, slide.tilt});
    }
  }

  // Motions in the space of `basis` that surfaces let slide along themselves, orthonormal; `fixed` are mean squares of what
  // supports, bonds and friction feel.
  Eigen::MatrixXd free(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& fixed) const
  {
    Eigen::MatrixXd found(basis.rows(), 0);
    if (own_.empty()) return found;
    for (const auto* sides : {&own_, &other_}) {
      const Eigen::MatrixXd rest = basis * complement(basis.transpose() * found);
      if (rest.cols() == 0) break;
      Eigen::MatrixXd felt = fixed / (exactly * exactly), speed = 1e-12 * Eigen::MatrixXd::Identity(fixed.rows(), fixed.cols());
      for (const auto& [contact, parts] : *sides)
        for (const auto& part : parts) {
          felt += part.smooth / std::pow(part.tolerance(), 2);
          speed += part.speed;
        }
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest.transpose() * felt * rest,
                                                                            rest.transpose() * speed * rest);
      Eigen::MatrixXd accepted = found;
      for (Eigen::Index k = 0; k < rest.cols(); ++k) {
        const Eigen::VectorXd v = rest * eigen.eigenvectors().col(k).normalized();
        if (v.dot(fixed * v) > exactly * exactly || !slides(v)) continue;
        accepted.conservativeResize(Eigen::NoChange, accepted.cols() + 1);
        accepted.rightCols(1) = v;
      }
      if (accepted.cols() == found.cols()) continue;
      const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(accepted).householderQ();
      found = q.leftCols(accepted.cols());
    }
    return found;
  }

  // The root mean square of what the surfaces feel of a motion, facets left out.
  double felt(const Eigen::VectorXd& v) const
  {
    double result = 0;
    for (const auto& [contact, parts] : own_) {
      const auto side = [&](const std::vector<Part>& all) {
        double worst = 0;
        for (const auto& part : all) worst = std::max(worst, v.dot(part.smooth * v));
        return worst;
      };
      const auto facing = other_.find(contact);
      result = std::max(result, facing == other_.end() ? side(parts) : std::min(side(parts), side(facing->second)));
    }
    return std::sqrt(std::max(result, 0.0));
  }

 private:
  struct Part {
    Eigen::MatrixXd whole, smooth, speed;
    double tilt;
    // Polygons differ from the curve by the square of the angle between their edges.
    double tolerance() const { return 0.4 * tilt + exactly; }
    bool slides(const Eigen::VectorXd& v) const
    {
      const double square = v.dot(speed * v) + 1e-12;
      return v.dot(smooth * v) <= tolerance() * tolerance() * square &&
             v.dot(whole * v) <= (tilt_share * tilt + exactly * exactly) * square;
    }
    static constexpr double tilt_share = 2;  // of n . v squared that may be due to tilts: teeth are more
  };
  using Sides = std::map<int, std::vector<Part>>;  // by contact

  // Whether at each contact one of the two surfaces slides along itself.
  bool slides(const Eigen::VectorXd& v) const
  {
    const auto all = [&](const std::vector<Part>& parts) {
      return std::all_of(parts.begin(), parts.end(), [&](const Part& part) { return part.slides(v); });
    };
    return std::all_of(own_.begin(), own_.end(), [&](const auto& contact) {
      const auto facing = other_.find(contact.first);
      return all(contact.second) || (facing != other_.end() && all(facing->second));
    });
  }

  Sides own_, other_;
};

// Takes out of `felt` what a cut that is tightened to a force gives way to, part * s with the s that is nearest to each motion,
// and adds what the force works on it. `first`: the first contact row of `felt`.
void release(const constraint::Cut& cut, Local first, Bodies& bodies, SparseMatrix& felt, const Communicator& comm)
{
  SparseMatrix parts(felt.rows(), 1);
  for (const auto& [row, part] : cut.rows) parts.insert(first + static_cast<Local>(row), 0) = part;
  Eigen::VectorXd shortening = Eigen::MatrixXd(felt.transpose() * parts);
  comm.sum_in_place({shortening.data(), static_cast<std::size_t>(shortening.size())});
  shortening /= comm.sum(parts.squaredNorm());
  felt -= SparseMatrix(parts * SparseMatrix(shortening.sparseView(1.0, 1e-12)).transpose());
  bodies.generalised += *cut.preload.force * shortening;
  for (Eigen::Index b = 0; b < bodies.force.size(); ++b)
    if (shortening.segment(b * bodies.modes, bodies.modes).norm() > 1e-6) bodies.force[b] += *cut.preload.force;
}

// Turns an orthonormal basis so that the loads drive its first vector alone, and in its own sense: of many motions together, that
// is the one to tell.
void turn_to_loads(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised)
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
  const double turning = motion.rotation.norm() * size;
  if (turning < 1e-2 * motion.translation.norm() || turning == 0)
    return "moves along " + print(clean(motion.translation.normalized()));
  if (turning < 0.5 * motion.translation.norm())
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
                                          const constraint::Contacts& contacts, std::span<const constraint::Cut> cuts,
                                          std::span<const constraint::Slide> slides, const std::vector<Eigen::VectorXd>& load,
                                          const Communicator& comm)
{
  Bodies bodies = aggregate(decomposition, clusters, kinematics, load, comm);
  const int modes = bodies.modes;
  // Rows x amplitudes, in length units again: the support and contact rows that this rank owns.
  const Local first = jump.ranges().held, count = jump.ranges().extra - first;
  const Eigen::VectorXd unscale = jump.scale().segment(first, count).cwiseInverse();
  SparseMatrix felt =
      unscale.asDiagonal() * SparseMatrix(SparseMatrix(g.middleCols(first, count)).transpose() * bodies.aggregate);
  const Local first_contact = jump.ranges().contacts - first;
  for (const auto& cut : cuts)
    if (cut.preload.force) release(cut, first_contact, bodies, felt, comm);
  Eigen::VectorXd weight_of_row = Eigen::VectorXd::Constant(count, support_weight);
  for (std::size_t i = 0; i < contacts.points.size(); ++i)
    if (!contacts.bonded[i]) weight_of_row[first_contact + static_cast<Local>(contacts.points[i].row)] /= support_weight;
  const Eigen::VectorXd fixed_row = (weight_of_row.array() > 1).cast<double>();
  // Whether the normal rows feel no more of a motion than the angles of facets explain: a small part of the velocity there.
  const auto along_surfaces = [&](const Eigen::MatrixXd& rows, const Eigen::VectorXd& v, const RigidMotion& motion) {
    double worst = 0;
    for (std::size_t i = 0; i < contacts.points.size(); ++i) {
      if (contacts.bonded[i]) continue;
      const double here = std::abs(rows.row(first_contact + static_cast<Local>(contacts.points[i].row)).dot(v));
      if (here > 1e-6) worst = std::max(worst, here / std::max(motion.at(contacts.points[i].at).norm(), 1e-12));
    }
    return comm.max(worst) <= 3 * nearly;
  };
  const auto body_count = static_cast<int>(bodies.frames.size());

  std::vector<FreeMotion> found;
  std::vector<Eigen::VectorXd> amplitudes;  // of each found motion, over all bodies
  const auto add = [&](int b, const Eigen::VectorXd& v, double motion_felt, bool slideway) {
    FreeMotion motion;
    motion.felt = motion_felt;
    motion.slideway = slideway;
    motion.motions.push_back(combine(b, bodies.frames[b], v, kinematics));
    motion.work = bodies.force[b] > 0 ? std::abs(bodies.generalised.segment(b * modes, modes).dot(v)) / bodies.force[b] : 0;
    amplitudes.emplace_back(Eigen::VectorXd::Zero(body_count * modes));
    amplitudes.back().segment(b * modes, modes) = v;
    found.push_back(std::move(motion));
  };
  for (int b = 0; b < body_count; ++b) {
    const Eigen::MatrixXd rows = weight_of_row.asDiagonal() * Eigen::MatrixXd(felt.middleCols(b * modes, modes));
    const auto drives = bodies.generalised.segment(b * modes, modes);
    // Three kinds, each in what the ones before leave: what rows do not feel at all; what lets surfaces slide along themselves;
    // what rows hardly feel.
    Eigen::MatrixXd taken(modes, 0);
    for (const auto& v : unfelt(rows, nearly, comm)) {
      if (largest(rows * v, comm) >= 1e-6) continue;
      taken.conservativeResize(Eigen::NoChange, taken.cols() + 1);
      taken.rightCols(1) = v;
    }
    turn_to_loads(taken, drives);
    for (const auto& v : taken.colwise()) add(b, v, largest(rows * v, comm), false);

    const Slideways slideways(b, bodies.frames[b], kinematics, slides);
    Eigen::MatrixXd sliding = slideways.free(complement(taken), mean_square(rows, fixed_row, comm));
    turn_to_loads(sliding, drives);
    for (const auto& v : sliding.colwise()) add(b, v, slideways.felt(v), true);

    Eigen::MatrixXd all(modes, taken.cols() + sliding.cols());
    all << taken, sliding;
    const Eigen::MatrixXd rest = complement(all);
    if (rest.cols() == 0) continue;
    const Eigen::MatrixXd rows_of_rest = rows * rest;
    for (const auto& amplitude : unfelt(rows_of_rest, nearly, comm)) {
      const Eigen::VectorXd v = rest * amplitude;
      const double worst = largest(rows * v, comm);
      if (along_surfaces(rows, v, combine(b, bodies.frames[b], v, kinematics)) && worst <= 3 * nearly) add(b, v, worst, false);
    }
  }

  // Several bodies together: the null space of all rows once the motions found so far are stopped.
  constexpr int dense_limit = 3000;
  if (body_count < 2 || body_count * modes > dense_limit) return found;
  Eigen::MatrixXd gram = Eigen::MatrixXd(SparseMatrix(felt.transpose() * felt));
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  const double weight = std::max(gram.diagonal().maxCoeff(), 1.0);
  for (const auto& v : amplitudes) gram += weight * v * v.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  Eigen::Index together = 0;
  while (together < gram.cols() && eigen.eigenvalues()[together] < exactly * exactly * weight * 100) ++together;
  Eigen::MatrixXd basis = eigen.eigenvectors().leftCols(together);
  turn_to_loads(basis, bodies.generalised);
  for (const auto& v : basis.colwise()) {
    FreeMotion motion;
    motion.felt = largest(felt * v, comm);
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
