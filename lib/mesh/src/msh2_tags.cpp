#include "msh2_tags.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "gmsh_file.hpp"

namespace mortise::mesh {

namespace {

// By gmsh's numbers of element types, from 1 on.
constexpr std::array<int, 19> msh2_nodes{2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
constexpr std::array<int, 19> msh2_dimensions{1, 2, 2, 3, 3, 3, 3, 1, 2, 2, 3, 3, 3, 3, 0, 2, 3, 3, 3};

// The elements of one entity in one physical group: how many, and a sum over their nodes that does not ask for their order.
struct ElementsOfGroup {
  long long count = 0;
  std::uint64_t sum = 0;
  bool operator==(const ElementsOfGroup&) const = default;
};
using GroupsOfEntity = std::map<int, ElementsOfGroup>;                 // by physical tag
using GroupsByEntity = std::map<std::pair<int, int>, GroupsOfEntity>;  // by dimension and elementary tag

// One element after its number: type, tags (physical, elementary, ..), nodes.
void note_element(GroupsByEntity& entities, int type, const int* tags, int tag_count, const int* nodes)
{
  if (tag_count < 2) return;
  const auto kind = static_cast<std::size_t>(type - 1);
  auto& elements = entities[{msh2_dimensions[kind], tags[1]}][tags[0]];
  ++elements.count;
  std::uint64_t hash = 1469598103934665603U;  // FNV-1a
  for (int i = 0; i < msh2_nodes[kind]; ++i) hash = (hash ^ static_cast<std::uint64_t>(nodes[i])) * 1099511628211U;
  elements.sum += hash;
}

bool is_known_type(int type)
{
  return type >= 1 && type <= static_cast<int>(msh2_nodes.size());
}

// Elements in lines of text; nothing more from one on that is not understood.
void read_text_elements(std::string_view text, GroupsByEntity& entities)
{
  const char *at = text.data(), *const end = at + text.size();
  const auto next = [&](int& value) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n')) ++at;
    const auto [stop, error] = std::from_chars(at, end, value);
    at = stop;
    return error == std::errc();
  };
  int count = 0, number = 0, type = 0, tag_count = 0;
  if (!next(count)) return;
  std::vector<int> tags, nodes;
  for (int e = 0; e < count; ++e) {
    if (!next(number) || !next(type) || !next(tag_count) || !is_known_type(type) || tag_count < 0 || tag_count > 1000) return;
    tags.resize(static_cast<std::size_t>(tag_count));
    nodes.resize(static_cast<std::size_t>(msh2_nodes[static_cast<std::size_t>(type - 1)]));
    for (auto* list : {&tags, &nodes})
      for (int& value : *list)
        if (!next(value)) return;
    note_element(entities, type, tags.data(), tag_count, nodes.data());
  }
}

// The same in blocks of numbers of this machine's kind.
void read_binary_elements(std::string_view bytes, GroupsByEntity& entities)
{
  int count = 0;
  const auto [stop, error] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), count);
  if (error != std::errc()) return;
  bytes.remove_prefix(std::min(static_cast<std::size_t>(stop - bytes.data()) + 1, bytes.size()));
  std::vector<int> values;
  const auto take = [&](std::size_t size) {
    if (bytes.size() < size * sizeof(int)) return false;
    values.resize(size);
    std::memcpy(values.data(), bytes.data(), size * sizeof(int));
    bytes.remove_prefix(size * sizeof(int));
    return true;
  };
  for (long long read = 0; read < count;) {
    if (!take(3)) return;
    const int type = values[0], block = values[1], tag_count = values[2];
    if (!is_known_type(type) || block < 1 || tag_count < 0 || tag_count > 1000) return;
    const int nodes = msh2_nodes[static_cast<std::size_t>(type - 1)];
    for (int e = 0; e < block; ++e, ++read) {
      if (!take(static_cast<std::size_t>(1 + tag_count + nodes))) return;
      note_element(entities, type, values.data() + 1, tag_count, values.data() + 1 + tag_count);
    }
  }
}

// What follows the line of a section's name.
std::optional<std::string_view> section_of(const std::string& text, const std::string& name)
{
  const auto at = text.find(name);
  const auto end = at == std::string::npos ? at : text.find('\n', at);
  if (end == std::string::npos) return {};
  return std::string_view(text).substr(end + 1);
}

}  // namespace

void require_own_entities(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto format = section_of(text, "$MeshFormat"), elements = section_of(text, "$Elements");
  if (!format || !elements || !format->starts_with("2")) return;
  const bool binary = format->substr(format->find(' ') + 1).starts_with("1");
  GroupsByEntity entities;
  binary ? read_binary_elements(*elements, entities) : read_text_elements(*elements, entities);
  for (const auto& [entity, groups] : entities)
    for (const auto& [physical, found] : groups)
      if (found != groups.begin()->second)
        fail(file,
             fmt::format(
                 "elements of the physical groups {} and {} have the same elementary tag {} (the second tag of an element), "
                 "so that each would be in both groups; give each group elementary tags of its own, as gmsh writes them",
                 groups.begin()->first, physical, entity.second));
}

}  // namespace mortise::mesh
