#include "contact_patches.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace mortise::post {

namespace {

constexpr double presses = 1e-3;  // of the largest force of the contact's points

struct Moments {
  double force = 0, stuck = 0, shear = 0;
  Point normal = Point::Zero(), first = Point::Zero();  // times the force, as all that follows
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};
static_assert(sizeof(Moments) == sizeof(double) * 18);

Patch patch_of(const Moments& moments, int dimension)
{
  if (!(moments.force > 0)) return {};
  const Point n = moments.normal.normalized(), centre = moments.first / moments.force;
  Patch patch{moments.force, moments.stuck, moments.shear, n, centre};
  if (dimension == 2) {
    patch.directions = {Point(-n[1], n[0], 0)};
    return patch;
  }
  const Eigen::Matrix3d spread = moments.second / moments.force - centre * centre.transpose(),
                        along = Eigen::Matrix3d::Identity() - n * n.transpose();
  const double larger = 2 * spread.cwiseAbs().sum() + 1;
  const Eigen::Matrix3d axes =
      dense::space_eigenpairs(Eigen::Matrix3d(along * spread * along + larger * n * n.transpose())).vectors;
  patch.directions = {axes.col(0), axes.col(1)};  // the last one is the normal
  return patch;
}

// The faces that the rows of a point with a force act on. Of second-order sides rows have more nodes than one of the secondary's
// own, too.
void take_faces(const constraint::Contacts& contacts, const constraint::ContactNode& point, double force,
                const std::unordered_map<Global, Nodal>& nodes, std::array<Facets, 2>& sides)
{
  constexpr double much = 0.3;  // of the row: nodes of the primary side that it is near
  const auto own = nodes.find(point.node);
  if (own == nodes.end()) return;
  sides[0].take(own->second);
  sides[0].normals += force * own->second.normal();
  for (const auto& entry : contacts.rows[point.row]) {
    const double n = point.normal[entry.component];
    const auto found = nodes.find(entry.node);
    if (found == nodes.end() || found->second.body == own->second.body) continue;
    sides[1].body = std::max(sides[1].body, found->second.body);
    sides[1].normals -= force * entry.coefficient * n / point.weight * found->second.normal();
    if (entry.coefficient * n < -much * point.weight * n * n) sides[1].take(found->second);
  }
}

}  // namespace

std::vector<Patch> pressing_patches(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                    std::span<const contact::ContactNodeState> states,
                                    const std::unordered_map<Global, Nodal>& nodes, int dimension, const Communicator& comm)
{
  std::vector<double> largest(pairs.size(), 0.0);
  const auto for_each_point = [&](const auto& visit) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const auto c = static_cast<std::size_t>(states[i].contact);
      if (touches(pairs, states[i]) && states[i].force > presses * largest[c]) visit(c, contacts.nodes[i], states[i]);
    }
  };
  for_each_point([&](std::size_t c, const auto&, const auto& state) { largest[c] = std::max(largest[c], state.force); });
  for (auto& force : largest) force = comm.max(force);
  std::vector<Moments> moments(pairs.size());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, const contact::ContactNodeState& state) {
    const double force = state.force;
    moments[c].force += force;
    if (state.status == contact::Status::stick) moments[c].stuck += force;
    moments[c].shear += (state.force_on_secondary - state.force_on_secondary.dot(point.normal) * point.normal).norm();
    moments[c].normal += force * point.normal;
    moments[c].first += force * point.at;
    moments[c].second += force * point.at * point.at.transpose();
  });
  comm.sum_in_place({reinterpret_cast<double*>(moments.data()), moments.size() * 18});
  std::vector<Patch> result;
  for (const auto& sums : moments) result.push_back(patch_of(sums, dimension));
  std::vector<std::array<double, 4>> ends(pairs.size());  // of each direction minus the least place and the largest
  for (auto& end : ends) end.fill(-std::numeric_limits<double>::infinity());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, const contact::ContactNodeState& state) {
    for (std::size_t k = 0; k < result[c].directions.size(); ++k) {
      const double along = result[c].directions[k].dot(point.at - result[c].centre);
      ends[c][2 * k] = std::max(ends[c][2 * k], -along);
      ends[c][2 * k + 1] = std::max(ends[c][2 * k + 1], along);
    }
    take_faces(contacts, point, state.force, nodes, result[c].sides);
  });
  for (std::size_t c = 0; c < result.size(); ++c) {
    for (std::size_t k = 0; k < result[c].directions.size(); ++k)
      result[c].widths.push_back(comm.max(ends[c][2 * k]) + comm.max(ends[c][2 * k + 1]));
    for (auto& side : result[c].sides) {
      side.flattest = -comm.max(-side.flattest);
      side.radius = -comm.max(-side.radius);
      side.round = !comm.any(!side.round);
      side.size = comm.max(side.size);
      side.body = static_cast<int>(comm.max(static_cast<double>(side.body)));
      comm.sum_in_place({side.normals.data(), 3});
    }
  }
  return result;
}

}  // namespace mortise::post
