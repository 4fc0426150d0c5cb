#include "feti/row_distribution.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>
#include <utility>

namespace mortise::feti {

namespace {

using Vector3 = std::array<double, 3>;

template <class T>
using ByRank = std::vector<std::vector<T>>;

// The rank of each entry's row.
template <class T>
std::vector<std::size_t> ranks_of(std::span<const T> entries, const partition::Decomposition& decomposition,
                                  const partition::NodeDirectory& directory, const Communicator& comm)
{
  std::vector<Global> nodes;
  for (const auto& entry : entries) nodes.push_back(entry.node);
  const auto copies = directory.find(nodes, comm);
  std::vector<std::size_t> ranks;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    assert(!copies[i].empty());  // boundaries lie on surfaces
    ranks.push_back(static_cast<std::size_t>(decomposition.rank_of(copies[i][0].subdomain)));
  }
  return ranks;
}

template <class T>
std::vector<T> deliver(std::span<const T> entries, const partition::Decomposition& decomposition,
                       const partition::NodeDirectory& directory, const Communicator& comm)
{
  const auto ranks = ranks_of(entries, decomposition, directory, comm);
  ByRank<T> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) send[ranks[i]].push_back(entries[i]);
  std::vector<T> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  return result;
}

Vector3 array(const Point& p)
{
  return {p[0], p[1], p[2]};
}
Point point(const Vector3& v)
{
  return {v[0], v[1], v[2]};
}

// A contact node on its way.
struct SentNode {
  int contact, tangent_count;
  bool bonded, in_surface;
  Global node;
  double area, weight, gap, cover, prescribed_share;
  Vector3 normal, at, across;
  std::array<Vector3, 2> tangents;
  std::size_t parts, images;
};

struct SentPart {
  Global node;
  double part;
  Vector3 normal;
};

struct SentImage {
  int contact;
  Global node;
  double part;
  std::array<Vector3, 3> axes;  // the rotation's columns
};

struct SentRow {
  double bound;
  std::size_t entries;
};

SentNode pack(const constraint::ContactNode& from, bool bonded)
{
  SentNode to{};
  to.contact = from.contact;
  to.tangent_count = static_cast<int>(from.tangents.size());
  to.bonded = bonded;
  to.node = from.node;
  to.area = from.area;
  to.weight = from.weight;
  to.gap = from.gap;
  to.cover = from.cover;
  to.prescribed_share = from.prescribed_share;
  to.in_surface = from.in_surface;
  to.across = array(from.across);
  to.normal = array(from.normal);
  to.at = array(from.at);
  std::transform(from.tangents.begin(), from.tangents.end(), to.tangents.begin(), array);
  to.parts = from.parts.size();
  to.images = from.images.size();
  return to;
}

SentImage pack(const constraint::Image& from)
{
  const auto& r = from.rotation;
  return {from.contact, from.node, from.part, {array(r.col(0)), array(r.col(1)), array(r.col(2))}};
}

constraint::Image unpack(const SentImage& from)
{
  constraint::Image to{from.contact, from.node, from.part, {}};
  for (Eigen::Index c = 0; c < 3; ++c) to.rotation.col(c) = point(from.axes[static_cast<std::size_t>(c)]);
  return to;
}

constraint::ContactNode unpack(const SentNode& from, std::size_t row)
{
  constraint::ContactNode to{from.contact, from.node,   from.area, point(from.normal), {},
                             row,          from.weight, from.gap,  point(from.at),     from.cover};
  to.prescribed_share = from.prescribed_share;
  to.in_surface = from.in_surface;
  to.across = point(from.across);
  for (int t = 0; t < from.tangent_count; ++t) to.tangents.push_back(point(from.tangents[static_cast<std::size_t>(t)]));
  return to;
}

}  // namespace

std::vector<constraint::PrescribedDof> distribute_rows(std::span<const constraint::PrescribedDof> prescribed,
                                                       const partition::Decomposition& decomposition,
                                                       const partition::NodeDirectory& directory, const Communicator& comm)
{
  auto result = deliver(prescribed, decomposition, directory, comm);
  std::sort(result.begin(), result.end(), [](const constraint::PrescribedDof& a, const constraint::PrescribedDof& b) {
    return std::tie(a.node, a.component) < std::tie(b.node, b.component);
  });
  return result;
}

std::vector<constraint::SkewSupport> distribute_rows(std::span<const constraint::SkewSupport> skew_supports,
                                                     const partition::Decomposition& decomposition,
                                                     const partition::NodeDirectory& directory, const Communicator& comm)
{
  auto result = deliver(skew_supports, decomposition, directory, comm);
  std::stable_sort(result.begin(), result.end(),
                   [](const constraint::SkewSupport& a, const constraint::SkewSupport& b) { return a.node < b.node; });
  return result;
}

constraint::Contacts distribute_rows(const constraint::Contacts& contacts, const partition::Decomposition& decomposition,
                                     const partition::NodeDirectory& directory, const Communicator& comm)
{
  const auto size = static_cast<std::size_t>(comm.size());
  const auto ranks = ranks_of(std::span(contacts.nodes), decomposition, directory, comm);
  ByRank<SentNode> points(size);
  ByRank<SentPart> parts(size);
  ByRank<SentImage> images(size);
  ByRank<SentRow> rows(size);
  ByRank<constraint::Entry> entries(size);
  ByRank<constraint::PrescribedEntry> prescribed(size);  // their rows are counted among those that go to the same rank
  std::vector<std::pair<std::size_t, std::size_t>> position_of(contacts.rows.size());  // rank, row among those that go there
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const auto& p = contacts.nodes[i];
    const auto to = ranks[i];
    points[to].push_back(pack(p, contacts.bonded[i]));
    for (const auto& part : p.parts) parts[to].push_back({part.node, part.part, array(part.normal)});
    for (const auto& image : p.images) images[to].push_back(pack(image));
    for (std::size_t r = p.row; r <= p.row + p.tangents.size(); ++r) {
      const auto row = contacts.rows[r];
      position_of[r] = {to, rows[to].size()};
      rows[to].push_back({contacts.rows.bound[r], row.size()});
      entries[to].insert(entries[to].end(), row.begin(), row.end());
    }
  }
  for (auto entry : contacts.prescribed) {
    const auto [to, row] = position_of[entry.row];
    entry.row = row;
    prescribed[to].push_back(entry);
  }

  const auto points_in = comm.exchange(points);
  const auto parts_in = comm.exchange(parts);
  const auto images_in = comm.exchange(images);
  const auto rows_in = comm.exchange(rows);
  const auto entries_in = comm.exchange(entries);
  const auto prescribed_in = comm.exchange(prescribed);
  constraint::Contacts result;
  result.without_rows = contacts.without_rows;
  for (std::size_t from = 0; from < size; ++from) {
    for (auto entry : prescribed_in[from]) {
      entry.row += result.rows.size();
      result.prescribed.push_back(entry);
    }
    auto row = rows_in[from].begin();
    auto entry = entries_in[from].begin();
    auto part = parts_in[from].begin();
    auto image = images_in[from].begin();
    for (const auto& p : points_in[from]) {
      auto& node = result.nodes.emplace_back(unpack(p, result.rows.size()));
      for (std::size_t k = 0; k < p.parts; ++k, ++part) node.parts.push_back({part->node, part->part, point(part->normal)});
      for (std::size_t k = 0; k < p.images; ++k, ++image) node.images.push_back(unpack(*image));
      result.bonded.push_back(p.bonded);
      for (int r = 0; r <= p.tangent_count; ++r, ++row) {
        const auto end = entry + static_cast<std::ptrdiff_t>(row->entries);
        result.rows.entries.insert(result.rows.entries.end(), entry, end);
        result.rows.close(row->bound);
        entry = end;
      }
    }
  }
  return result;
}

std::vector<std::size_t> rows_here(std::span<const constraint::SpringRow> rows, const partition::Decomposition& decomposition,
                                   const partition::NodeDirectory& directory, const Communicator& comm)
{
  std::vector<constraint::Entry> first;
  for (const auto& row : rows) first.push_back(row.entries.front());
  const auto ranks = ranks_of(std::span<const constraint::Entry>(first), decomposition, directory, comm);
  std::vector<std::size_t> here;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    if (ranks[i] == static_cast<std::size_t>(comm.rank())) here.push_back(i);
  return here;
}

}  // namespace mortise::feti
