#include "post/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::post {

std::vector<Found> largest_of_ranks(const std::vector<Found>& mine, const Communicator& comm)
{
  struct Sent {
    std::size_t body;
    double value, x, y, z;
    int on;
  };
  std::vector<Sent> send;
  for (std::size_t b = 0; b < mine.size(); ++b)
    if (std::isnan(mine[b].value) || mine[b].value > -std::numeric_limits<double>::infinity())
      send.push_back({b, mine[b].value, mine[b].at[0], mine[b].at[1], mine[b].at[2], mine[b].body});
  std::vector<Found> result(mine.size());
  for (const auto& s : comm.all_gather(send)) result[s.body].take(s.value, {s.x, s.y, s.z}, s.on);
  return result;
}

std::vector<double> body_sizes(const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                               const Communicator& comm)
{
  const auto count = decomposition.catalogue.bodies.size();
  std::vector<Found> ends(6 * count);  // for each body the largest x, y, z, -x, -y, -z
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& p : subdomain.mesh.points)
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = p[static_cast<Eigen::Index>(c)];
        const auto first = 6 * static_cast<std::size_t>(subdomain.body);
        ends[first + c].take(x, p);
        ends[first + 3 + c].take(kinematics == fem::Kinematics::axisymmetric && c == 0 ? x : -x, p);
      }
  ends = largest_of_ranks(ends, comm);
  std::vector<double> result;
  for (std::size_t b = 0; b < count; ++b) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) square += std::pow(ends[6 * b + c].value + ends[6 * b + 3 + c].value, 2);
    result.push_back(std::sqrt(square));
  }
  return result;
}

std::vector<std::vector<int>> bodies_of_contacts(std::span<const contact::Pair> pairs, const Communicator& comm)
{
  struct Side {
    int contact, body;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  const auto make_unique = [&] {
    std::ranges::sort(sides);
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  };
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    for (const int body : pairs[c].secondary.body) sides.push_back({static_cast<int>(c), body});
    if (pairs[c].primary)
      for (const int body : pairs[c].primary->body) sides.push_back({static_cast<int>(c), body});
  }
  make_unique();
  sides = comm.all_gather(sides);
  make_unique();
  std::vector<std::vector<int>> result(pairs.size());
  for (const auto& side : sides) result[static_cast<std::size_t>(side.contact)].push_back(side.body);
  return result;
}

}  // namespace mortise::post
