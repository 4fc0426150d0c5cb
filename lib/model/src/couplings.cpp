#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "fem/loads.hpp"
#include "model/model.hpp"
#include "points.hpp"
#include "sectors.hpp"

namespace mortise::model {

namespace {

constexpr double rounding_of_mean = 1e-9;  // of the largest coefficient of a mean motion: smaller ones are none
constexpr double beside_axis = 1e-3;       // of a boundary's distance: a point that is nearer to the axis of sectors lies on it
constexpr double across_axis = 1e-9;       // of a load or a motion

}  // namespace

// Of a coupling's boundary: area, centre, and the inverse of its second moment of area about the centre (of a plane: about z
// alone). Where sectors have the coupling's point in common, on their axis, those of the boundaries of all of them: the centre is
// on the axis, and moves along it and turns about it alone.
struct Model::Area {
  double size = 0;
  Point point = Point::Zero();  // the coupling's
  Point centre = Point::Zero();
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  double arm = 1;                                       // from the coupling's point, root mean square
  Eigen::Matrix3d moves = Eigen::Matrix3d::Identity();  // projects on the directions in which it does

  bool moves_along(int direction) const { return moves(direction, direction) > 0.5; }
};

Model::Area Model::area_of(const constraint::CouplingOptions& coupling, const Communicator& comm) const
{
  const auto [boundary, on_body] = select(coupling.boundary);
  const auto moments_about = [&, &boundary = boundary, &on_body = on_body](const Point& origin) {
    fem::Moments sum;
    for (const auto& subdomain : decomposition_.subdomains) {
      if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      const auto own = fem::moments(subdomain.mesh, boundary, deck_.kinematics, origin);
      sum.area += own.area, sum.first += own.first, sum.second += own.second;
    }
    comm.sum_in_place({&sum.area, 1});
    comm.sum_in_place({sum.first.data(), 3});
    comm.sum_in_place({sum.second.data(), 9});
    return sum;
  };
  Area area;
  area.point = place(coupling.point);
  const auto about_point = moments_about(area.point);
  area.size = about_point.area;
  if (!(area.size > 0)) throw Error(ExitStatus::bad_input, "the coupled boundary \"" + coupling.boundary + "\" has no area");
  area.centre = area.point + about_point.first / area.size;
  const auto axis = sector_axis(deck_);
  const double near = beside_axis * std::sqrt(about_point.second.trace() / area.size);
  const bool of_all_sectors = axis && (axis->has(area.point) || (area.point - axis->foot(area.point)).norm() < near);
  if (of_all_sectors) {
    area.point = axis->foot(area.point);
    area.centre = axis->foot(area.centre);
  }
  const Eigen::Matrix3d about_centre = moments_about(area.centre).second;
  const Eigen::Matrix3d inertia = about_centre.trace() * Eigen::Matrix3d::Identity() - about_centre;
  if (of_all_sectors) {
    area.moves = axis->projector();
    area.inverse = area.moves / axis->along.dot(inertia * axis->along);
  } else if (deck_.dimension() == 3)
    area.inverse = inertia.inverse();
  else
    area.inverse(2, 2) = 1 / inertia(2, 2);
  area.arm = std::sqrt(about_centre.trace() / area.size + (area.centre - area.point).squaredNorm());
  return area;
}

void Model::add_distributed(const std::vector<constraint::Coupling>& couplings, std::vector<Eigen::VectorXd>& f,
                            const Communicator& comm) const
{
  const int dimension = deck_.dimension();
  for (const auto& coupling : couplings) {
    if (coupling.rigid) continue;  // what its point balances
    const auto& options = deck_.couplings.at(coupling.name);
    const auto area = area_of(options, comm);
    const auto selection = select(options.boundary);
    const Point force(coupling.load[0], coupling.load[1], coupling.load[2]);
    const Point moment(coupling.load[3], coupling.load[4], coupling.load[5]);
    const Point turn = area.inverse * (moment + (coupling.point - area.centre).cross(force));
    for (std::size_t s = 0; s < f.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      if (!selection.on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      const auto moments = fem::nodal_moments(subdomain.mesh, selection.boundary, deck_.kinematics, area.centre);
      for (Eigen::Index n = 0; n < moments.cols(); ++n) {
        const Point arm = moments.col(n).tail<3>();
        f[s].segment(n * dimension, dimension) += (moments(0, n) / area.size * force + turn.cross(arm)).head(dimension);
      }
    }
  }
}

std::vector<constraint::Coupling> Model::couplings(const LoadState& state, const Communicator& comm) const
{
  std::vector<constraint::Coupling> result;
  for (const auto& [name, options] : deck_.couplings) {
    const auto area = area_of(options, comm);
    constraint::Coupling coupling{name, options.kind == "rigid", area.point, {}, {}, area.arm};
    for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
      const auto& support = deck_.supports[i];
      if (support.coupling != name || !state.acting[i]) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        if (support.displacement[c]) coupling.motion[c] = state.support[i] * support.displacement[c]->constant();
        if (support.rotation[c]) coupling.motion[3 + c] = state.support[i] * *support.rotation[c];
      }
    }
    for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
      const auto& load = deck_.loads[i];
      if (load.coupling != name) continue;
      const Point force = along_model(load, load.force), moment = along_model(load, load.moment);
      for (std::size_t c = 0; c < 3; ++c) {
        coupling.load[c] += state.load[i] * force[static_cast<int>(c)];
        coupling.load[3 + c] += state.load[i] * moment[static_cast<int>(c)];
      }
    }
    keep_along(area, coupling);
    result.push_back(std::move(coupling));
  }
  return result;
}

// Of a point on the axis of sectors, which may stand a little beside it in the deck.
void Model::keep_along(const Area& area, constraint::Coupling& coupling)
{
  const bool moved = coupling.rigid || std::ranges::any_of(coupling.motion, [](const auto& m) { return m.has_value(); });
  if (moved && area.moves.cwiseAbs().maxCoeff() < 1 - across_axis)
    throw Error(
        ExitStatus::bad_input,
        fmt::format("coupling \"{}\": its point is on the axis of the sectors; turn the model until that is along x, y or z",
                    coupling.name));
  for (const auto part : {0, 3}) {
    Point load, motion = Point::Zero();
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(part + c);
      load[c] = coupling.load[k];
      motion[c] = coupling.motion[k].value_or(0);
      if (coupling.rigid && !area.moves_along(c)) coupling.motion[k] = 0;
    }
    for (const Point& v : {load, motion})
      if ((v - area.moves * v).norm() > across_axis * v.norm())
        throw Error(
            ExitStatus::bad_input,
            fmt::format("coupling \"{}\": its point is on the axis of the sectors, and what acts or moves across that axis "
                        "would turn with them and cancel; load and move it along the axis, or model the whole",
                        coupling.name));
  }
}

std::vector<mesh::Surface> Model::coupling_surfaces() const
{
  std::vector<mesh::Surface> surfaces;
  for (const auto& [name, coupling] : deck_.couplings) {
    surfaces.emplace_back();
    if (coupling.kind != "rigid") continue;
    const auto [boundary, on_body] = select(coupling.boundary);
    surfaces.back() = partition::boundary_surface(decomposition_, boundary, on_body);
  }
  return surfaces;
}

std::vector<constraint::MeanMotion> Model::mean_motions(const std::vector<constraint::Coupling>& couplings,
                                                        const Communicator& comm) const
{
  std::vector<constraint::MeanMotion> rows;
  const int dimension = deck_.dimension();
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    const auto& coupling = couplings[i];
    const bool prescribed =
        std::any_of(coupling.motion.begin(), coupling.motion.end(), [](const auto& m) { return m.has_value(); });
    if (coupling.rigid || !prescribed) continue;
    const auto& options = deck_.couplings.at(coupling.name);
    const auto area = area_of(options, comm);
    const auto selection = select(options.boundary);
    struct Share {
      Global node;
      std::array<double, 4> moments;
    };
    std::vector<std::vector<Share>> send(static_cast<std::size_t>(comm.size()));
    for (const auto& subdomain : decomposition_.subdomains) {
      if (!selection.on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      const auto moments = fem::nodal_moments(subdomain.mesh, selection.boundary, deck_.kinematics, area.centre);
      for (Eigen::Index n = 0; n < moments.cols(); ++n)
        if (!moments.col(n).isZero(0))
          send[0].push_back({subdomain.mesh.node_id[static_cast<std::size_t>(n)],
                             {moments(0, n), moments(1, n), moments(2, n), moments(3, n)}});
    }
    std::map<Global, Eigen::Vector4d> nodes;
    for (const auto& part : comm.exchange(send))
      for (const auto& share : part) {
        auto& sum = nodes.try_emplace(share.node, Eigen::Vector4d::Zero()).first->second;
        sum += Eigen::Map<const Eigen::Vector4d>(share.moments.data());
      }
    if (!comm.root()) continue;
    const Point offset = coupling.point - area.centre;
    for (int k = 0; k < 6; ++k) {
      if (!coupling.motion[static_cast<std::size_t>(k)] || !area.moves_along(k % 3)) continue;
      const double length = k < 3 ? 1 : coupling.arm;  // so that every row is a length
      constraint::MeanMotion row{static_cast<int>(i), k, length * *coupling.motion[static_cast<std::size_t>(k)], {}};
      // The mean motion is linear in u: its gradient is what a unit force or moment at the point spreads over the boundary.
      const Point force = k < 3 ? Point(Point::Unit(k)) : Point(Point::Zero());
      const Point moment = k < 3 ? Point(offset.cross(force)) : Point(Point::Unit(k - 3));
      const Point turn = area.inverse * moment;
      for (const auto& [node, moments] : nodes) {
        const Point arm = moments.tail<3>();
        const Point at_node = moments[0] / area.size * force + turn.cross(arm);
        for (int c = 0; c < dimension; ++c) row.entries.push_back({node, c, length * at_node[c]});
      }
      double largest = 0;
      for (const auto& entry : row.entries) largest = std::max(largest, std::abs(entry.coefficient));
      for (auto& entry : row.entries)
        if (std::abs(entry.coefficient) < rounding_of_mean * largest) entry.coefficient = 0;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::vector<std::array<double, 6>> Model::motions_of_points(const std::vector<Eigen::VectorXd>& displacement,
                                                            const Communicator& comm) const
{
  std::vector<std::array<double, 6>> result;
  const int dimension = deck_.dimension();
  for (const auto& [name, options] : deck_.couplings) {
    const auto area = area_of(options, comm);
    const auto selection = select(options.boundary);
    std::vector<double> sums(6, 0.0);  // of u, and of (x - centre) x u
    for (std::size_t s = 0; s < displacement.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      if (!selection.on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      const auto moments = fem::nodal_moments(subdomain.mesh, selection.boundary, deck_.kinematics, area.centre);
      for (Eigen::Index n = 0; n < moments.cols(); ++n) {
        Point u = Point::Zero();
        u.head(dimension) = displacement[s].segment(n * dimension, dimension);
        const Point turned = moments.col(n).tail<3>().cross(u);
        for (int c = 0; c < 3; ++c) {
          sums[static_cast<std::size_t>(c)] += moments(0, n) * u[c];
          sums[static_cast<std::size_t>(3 + c)] += turned[c];
        }
      }
    }
    comm.sum_in_place(sums);
    const Point turn = area.inverse * Point(sums[3], sums[4], sums[5]);
    const Point mean = area.moves * Point(sums[0], sums[1], sums[2]) / area.size + turn.cross(area.point - area.centre);
    result.push_back({mean[0], mean[1], mean[2], turn[0], turn[1], turn[2]});
  }
  return result;
}

}  // namespace mortise::model
