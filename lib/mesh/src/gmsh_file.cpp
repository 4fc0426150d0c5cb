#include "gmsh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include "base/error.hpp"
#include "cad_surfaces.hpp"
#include "child.hpp"
#include "file_kind.hpp"
#include "gmsh_library.hpp"
#include "msh2_tags.hpp"
#include "script_check.hpp"

namespace mortise::mesh {

void fail(const std::string& file, const std::string& what)
{
  auto text = what.substr(0, 1000);  // damaged files have long words, and such that a terminal obeys
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  throw Error(ExitStatus::bad_input, file + ": " + text);
}

GmshSession::GmshSession(const std::map<std::string, double>& constants)
{
  std::vector<std::string> words{"mortise", "-nopopup", "-v", "2"};
  for (const auto& [name, value] : constants) {
    words.insert(words.end(), {"-setnumber", name, fmt::format("{:.17g}", value)});
  }
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  library().initialize(static_cast<int>(arguments.size()), arguments.data(), false);
  library().setNumber("General.Terminal", 0);
  library().setNumber("General.NumThreads", 1);
  library().setNumber("Mesh.SaveAll", 1);  // what is in no group is to be seen, and refused
  library().startLogger();
}

namespace {

// The first error that gmsh logged, which is the cause of those that follow; "" if there is none. Where it says no more than that
// there was one, the first warning says more.
std::string logged_error()
{
  std::vector<std::string> log;
  library().getLog(log);
  std::string first, warning;
  std::size_t more = 0;
  const auto text = [](const std::string& line) {
    return line.substr(std::min(line.find_first_not_of(": ", line.find(':')), line.size()));
  };
  for (const auto& line : log) {
    if (line.starts_with("Warning") && warning.empty()) warning = text(line);
    if (!line.starts_with("Error")) continue;
    if (first.empty())
      first = text(line);
    else
      ++more;
  }
  if (first.starts_with("Error loading"))
    return warning.empty() ? "cannot load it: the file is cut off or damaged" : "cannot load it: " + warning;
  return more == 0 ? first : fmt::format("{} (and {} more errors)", first, more);
}

// Runs a call of gmsh and throws what it threw or logged.
template <class Call>
void checked(const std::string& file, const char* otherwise, const Call& call)
{
  bool thrown = false;
  try {
    call();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    thrown = true;
  }
  const auto error = logged_error();
  if (!error.empty()) fail(file, "gmsh: " + error);
  if (thrown) fail(file, otherwise);
}

// The last part of gmsh's label of an entity, "Shapes/assembly/part"; "" if it has none that somebody gave it. What the names of
// a deck keep for themselves is replaced.
std::string label_of(int dimension, int tag)
{
  std::string label;
  library().getEntityName(dimension, tag, label);
  label = label.substr(label.find_last_of('/') + 1);
  for (const char* standard : {"Open CASCADE", "SOLID", "COMPOUND", "SHELL", "FACE"})
    if (label.rfind(standard, 0) == 0) return "";
  std::replace_if(
      label.begin(), label.end(), [](char c) { return c == ':' || c == '*'; }, '_');
  return label;
}

// A physical group for each label of the solids (plane models: faces) of a CAD file; those without one are called solid.1,
// solid.2, .. by their place, `word` being "solid". Faces of solids have no labels: gmsh does not ask OpenCASCADE for the names
// of subshapes.
void name_by_labels(int dimension, const std::string& word)
{
  gmsh::vectorpair solids;
  library().getEntities(solids, dimension);
  std::map<std::string, std::vector<int>> named;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    auto label = label_of(dimension, solids[i].second);
    if (label.empty()) label = fmt::format("{}.{}", word, i + 1);
    named[label].push_back(solids[i].second);
  }
  for (const auto& [label, tags] : named)
    library().setPhysicalName(dimension, library().addPhysicalGroup(dimension, tags, -1), label);
}

// Whether the deck speaks of a surface of this name.
bool is_wanted(const Options& options, const std::string& name)
{
  return std::any_of(options.surfaces.begin(), options.surfaces.end(), [&](const auto& body) {
    return body.first == name || std::find(body.second.begin(), body.second.end(), name) != body.second.end();
  });
}

// The solids of an .stl file are surfaces of their names. A file of one solid may be called by its own name as well: what stands
// behind the word "solid" is often that of the program that wrote it.
void name_stl_solids(const Options& options)
{
  gmsh::vectorpair solids;
  library().getEntities(solids, 2);
  const auto stem = std::filesystem::path(options.file).stem().string();
  if (solids.size() == 1 && !is_wanted(options, label_of(2, solids[0].second)) && is_wanted(options, stem))
    library().setPhysicalName(2, library().addPhysicalGroup(2, {solids[0].second}, -1), stem);
  else
    name_by_labels(2, "solid");
}

// Entities of the physical groups of options.surfaces, but for bodies that are physical volumes: nothing stands in for those.
std::set<int> wanted_surfaces(Options options, int dimension)
{
  std::set<int> result;
  gmsh::vectorpair groups;
  library().getPhysicalGroups(groups, dimension + 1);
  for (const auto& [dim, tag] : groups) {
    std::string name;
    library().getPhysicalName(dim, tag, name);
    options.surfaces.erase(name);
  }
  library().getPhysicalGroups(groups, dimension);
  for (const auto& [dim, tag] : groups) {
    std::string name;
    std::vector<int> entities;
    library().getPhysicalName(dim, tag, name);
    if (!is_wanted(options, name)) continue;
    library().getEntitiesForPhysicalGroup(dim, tag, entities);
    result.insert(entities.begin(), entities.end());
  }
  return result;
}

// Volumes in no physical group, those that touch together.
std::vector<gmsh::vectorpair> nameless_volumes(int dimension)
{
  gmsh::vectorpair volumes;
  library().getEntities(volumes, dimension);
  struct Part {
    gmsh::vectorpair volumes;
    std::set<int> sides;
  };
  std::vector<Part> parts;
  for (const auto& volume : volumes) {
    std::vector<int> physical, above, sides;
    library().getPhysicalGroupsForEntity(volume.first, volume.second, physical);
    if (!physical.empty()) continue;
    library().getAdjacencies(volume.first, volume.second, above, sides);
    Part joined{{volume}, {sides.begin(), sides.end()}};
    std::erase_if(parts, [&](const Part& part) {
      const bool touches = std::any_of(sides.begin(), sides.end(), [&](int side) { return part.sides.contains(side); });
      if (touches) {
        joined.volumes.insert(joined.volumes.end(), part.volumes.begin(), part.volumes.end());
        joined.sides.insert(part.sides.begin(), part.sides.end());
      }
      return touches;
    });
    parts.push_back(std::move(joined));
  }
  std::vector<gmsh::vectorpair> result;
  for (auto& part : parts) result.push_back(std::move(part.volumes));
  return result;
}

// Volumes without a name that the surfaces of bodies enclose need no cells.
void leave_out_enclosed(const Options& options, int dimension)
{
  const auto wanted = wanted_surfaces(options, dimension - 1);
  for (const auto& volumes : nameless_volumes(dimension)) {
    gmsh::vectorpair border;
    library().getBoundary(volumes, border, true, false, false);
    if (!border.empty() &&
        std::all_of(border.begin(), border.end(), [&](const auto& side) { return wanted.contains(side.second); }))
      library().removeEntities(volumes, false);
  }
}

}  // namespace

void GmshSession::set_sizes(const Options& options)
{
  if (options.size.max) library().setNumber("Mesh.MeshSizeMax", *options.size.max / options.scale);
  if (options.size.min) library().setNumber("Mesh.MeshSizeMin", *options.size.min / options.scale);
  if (options.size.curvature) library().setNumber("Mesh.MeshSizeFromCurvature", *options.size.curvature);
  if (!options.order) return;
  library().setNumber("Mesh.ElementOrder", *options.order);
  library().setNumber("Mesh.HighOrderOptimize", 1);  // cells that curved surfaces turn inside out
}

void GmshSession::open(const std::string& file) const
{
  checked(file, "gmsh cannot load it: the file is cut off or damaged", [&] { library().open(file); });
}

void GmshSession::mesh(const Options& options, int dimension) const
{
  checked(options.file, "gmsh gave up meshing it without a word", [&] {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates, parameters;
    library().getNodes(tags, coordinates, parameters, -1, -1, false, true);
    if (is_cad(kind_of(options.file))) name_by_labels(dimension, dimension == 3 ? "solid" : "surface");
    if (!tags.empty()) return;
    if (!options.surfaces.empty()) leave_out_enclosed(options, dimension);
    library().generate(options.dimension.value_or(dimension));
    mark_curved_surfaces(dimension);
  });
}

namespace {

// Seconds of processor time in which any file whose reading takes time by its length alone is read many times over.
double reading_seconds(double file_size)
{
  return 5 + 20e-6 * file_size;
}
// And bytes for reading a mesh.
double reading_memory(double file_size)
{
  return 1e9 + 100 * file_size;
}
double size_of(const std::string& file)
{
  std::error_code ignored;
  return static_cast<double>(std::filesystem::file_size(file, ignored));
}

constexpr const char* remedy = " (SystemCall, Save, Printf >> file and the like); if you trust it, run with --allow-scripts";

bool has_word(const std::string& text, const std::string& word)
{
  const auto is_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const auto end = at + word.size();
    if ((at == 0 || !is_of_name(text[at - 1])) && (end == text.size() || !is_of_name(text[end]))) return true;
  }
  return false;
}

// A constant whose name stands nowhere in a geometry is a slip of the pen, which gmsh passes over, as it does one that the
// geometry sets anew. What a geometry includes from elsewhere is not looked into: then any name may be right.
void require_constants(const Options& options)
{
  std::ifstream stream(options.file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const char* elsewhere : {"Include", "Merge", "Open"})
    if (has_word(text, elsewhere)) return;
  for (const auto& [name, value] : options.constants) {
    if (!has_word(text, name))
      fail(options.file,
           fmt::format("has no constant \"{}\", which mesh.constants sets; expected a name of its DefineConstant", name));
    std::istringstream script(text);
    if (const auto line = overwritten_at(name, script))
      fail(options.file, fmt::format("line {0}: gives \"{1}\" a value of its own, whatever mesh.constants.{1} says; write "
                                     "DefineConstant[ {1} = ... ]; there",
                                     *line, name));
  }
}

void work(const Options& options, int dimension, Sender& sender)
{
  const auto kind = kind_of(options.file);
  const GmshSession session(options.constants);
  GmshSession::set_sizes(options);
  if (!options.allow_scripts && !confine_child() && kind == FileKind::geo)
    fail(options.file, std::string("this system cannot keep a geometry from starting programs") + remedy);
  if (kind != FileKind::geo) limit_processor_time(reading_seconds(size_of(options.file)));
  if (kind == FileKind::geo) require_constants(options);
  if (kind == FileKind::msh) require_own_entities(options.file);
  session.open(options.file);
  limit_processor_time(0);
  if (is_geometry(kind)) GmshSession::set_sizes(options);  // again: what the deck says outweighs what a script has set
  if (is_geometry(kind)) session.mesh(options, dimension);
  if (kind == FileKind::stl) name_stl_solids(options);
  send(take_from_gmsh(options, dimension), sender);
}

}  // namespace

RawMesh read_gmsh(const Options& options, int dimension)
{
  const bool geometry = is_geometry(kind_of(options.file));
  Task task;
  task.file = options.file;
  task.doing = geometry ? "mesh" : "read";
  task.seconds = options.time_limit;
  task.longer = "; mesh.time_limit allows more";
  task.after_crash = geometry ? "try it in gmsh itself, with another mesh algorithm or size, or write it anew if it is damaged"
                              : "the file is likely damaged; write it anew";
  task.remedy = remedy;
  if (!geometry) task.memory = reading_memory(size_of(options.file));
  Child child(task, [&](Sender& sender) { work(options, dimension, sender); });
  return receive(child);
}

}  // namespace mortise::mesh
