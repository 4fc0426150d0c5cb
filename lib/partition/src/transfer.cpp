#include "transfer.hpp"

#include <cstring>
#include <numeric>
#include <type_traits>

namespace mortise::partition {

namespace {

template <class T>
void put(const std::vector<T>& values, std::vector<char>& bytes)
{
  const auto count = static_cast<unsigned long long>(values.size());
  const auto at = bytes.size();
  bytes.resize(at + sizeof count + count * sizeof(T));
  std::memcpy(bytes.data() + at, &count, sizeof count);
  if (count > 0) std::memcpy(bytes.data() + at + sizeof count, static_cast<const void*>(values.data()), count * sizeof(T));
}

template <class T>
void get(std::vector<T>& values, const std::vector<char>& bytes, std::size_t& at)
{
  unsigned long long count = 0;
  std::memcpy(&count, bytes.data() + at, sizeof count);
  at += sizeof count;
  values.resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
}

// Visits every vector of a mesh in one fixed order.
template <class M, class Visit>
void for_each_part(M& mesh, const Visit& visit)
{
  visit(mesh.node_id);
  visit(mesh.points);
  for (auto* cells : {&mesh.cells, &mesh.facets.cells}) {
    visit(cells->type);
    visit(cells->offset);
    visit(cells->nodes);
  }
  visit(mesh.cell_id);
  visit(mesh.cell_body);
  visit(mesh.cell_volume);
  visit(mesh.facets.parent);
  visit(mesh.facets.boundary);
}

}  // namespace

std::vector<Global> deal(const std::vector<long long>& weight, const std::vector<Global>& clusters, int ranks)
{
  const auto total = static_cast<double>(std::accumulate(weight.begin(), weight.end(), 0LL));
  const auto weight_of = [&](std::size_t cluster) {
    return static_cast<double>(std::accumulate(weight.begin() + clusters[cluster], weight.begin() + clusters[cluster + 1], 0LL));
  };
  std::vector<Global> first{0};
  double sum = 0;
  std::size_t next = 0;
  for (int r = 1; r < ranks; ++r) {
    const double aim = total * r / ranks;
    while (next + 1 < clusters.size() && sum + 0.5 * weight_of(next) < aim) sum += weight_of(next++);
    first.push_back(clusters[next]);
  }
  first.push_back(clusters.back());
  return first;
}

void pack(const Subdomain& subdomain, std::vector<char>& bytes)
{
  put(std::vector<Global>{subdomain.id, subdomain.body, subdomain.skin ? 1 : 0}, bytes);
  for (const auto* mesh : {&subdomain.mesh, &subdomain.inside}) for_each_part(*mesh, [&](const auto& part) { put(part, bytes); });
}

std::vector<Subdomain> unpack(const std::vector<char>& bytes)
{
  std::vector<Subdomain> result;
  for (std::size_t at = 0; at < bytes.size();) {
    Subdomain subdomain;
    std::vector<Global> head;
    get(head, bytes, at);
    subdomain.id = head[0];
    subdomain.body = static_cast<int>(head[1]);
    subdomain.skin = head[2] != 0;
    for (auto* mesh : {&subdomain.mesh, &subdomain.inside}) for_each_part(*mesh, [&](auto& part) { get(part, bytes, at); });
    result.push_back(std::move(subdomain));
  }
  return result;
}

}  // namespace mortise::partition
