#include "gmsh_file.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <vector>

#include "base/error.hpp"
#include "cad_surfaces.hpp"

namespace mortise::mesh {

void fail(const std::string& file, const std::string& what)
{
  throw Error(ExitStatus::bad_input, file + ": " + what);
}

GmshSession::GmshSession(const std::map<std::string, double>& constants)
{
  std::vector<std::string> words{"mortise", "-nopopup", "-v", "0"};
  for (const auto& [name, value] : constants) {
    words.insert(words.end(), {"-setnumber", name, fmt::format("{:.17g}", value)});
  }
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  gmsh::initialize(static_cast<int>(arguments.size()), arguments.data(), false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.SaveAll", 1);  // what is in no group is to be seen, and refused
  gmsh::logger::start();
}

GmshSession::~GmshSession()
{
  gmsh::finalize();
}

namespace {

// The last error that gmsh logged, if any.
std::string logged_error()
{
  std::vector<std::string> log;
  gmsh::logger::get(log);
  const auto found = std::find_if(log.rbegin(), log.rend(), [](const std::string& line) { return line.rfind("Error", 0) == 0; });
  return found == log.rend() ? std::string() : *found;
}

bool is_geometry(const std::string& file)
{
  const auto extension = std::filesystem::path(file).extension();
  return extension == ".geo" || is_cad(file);
}

// The last part of gmsh's label of an entity, "Shapes/assembly/part"; "" if it has none that somebody gave it. What the names of
// a deck keep for themselves is replaced.
std::string label_of(int dimension, int tag)
{
  std::string label;
  gmsh::model::getEntityName(dimension, tag, label);
  label = label.substr(label.find_last_of('/') + 1);
  for (const char* standard : {"Open CASCADE", "SOLID", "COMPOUND", "SHELL", "FACE"})
    if (label.rfind(standard, 0) == 0) return "";
  std::replace_if(
      label.begin(), label.end(), [](char c) { return c == ':' || c == '*'; }, '_');
  return label;
}

// A physical group for each label of the solids (plane models: faces) of a CAD file; those without one are called solid.1,
// solid.2, .. by their place. Faces of solids have no labels: gmsh does not ask OpenCASCADE for the names of subshapes.
void name_by_labels(int dimension)
{
  gmsh::vectorpair solids;
  gmsh::model::getEntities(solids, dimension);
  std::map<std::string, std::vector<int>> named;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    auto label = label_of(dimension, solids[i].second);
    if (label.empty()) label = fmt::format("{}.{}", dimension == 3 ? "solid" : "surface", i + 1);
    named[label].push_back(solids[i].second);
  }
  for (const auto& [label, tags] : named)
    gmsh::model::setPhysicalName(dimension, gmsh::model::addPhysicalGroup(dimension, tags), label);
}

}  // namespace

bool is_cad(const std::string& file)
{
  const auto extension = std::filesystem::path(file).extension();
  return extension == ".step" || extension == ".stp" || extension == ".STEP" || extension == ".STP" || extension == ".brep";
}

bool is_abaqus(const std::string& file)
{
  return std::filesystem::path(file).extension() == ".inp";
}

void GmshSession::set_sizes(const Options& options)
{
  if (options.size.max) gmsh::option::setNumber("Mesh.MeshSizeMax", *options.size.max / options.scale);
  if (options.size.min) gmsh::option::setNumber("Mesh.MeshSizeMin", *options.size.min / options.scale);
  if (options.size.curvature) gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", *options.size.curvature);
  if (!options.order) return;
  gmsh::option::setNumber("Mesh.ElementOrder", *options.order);
  gmsh::option::setNumber("Mesh.HighOrderOptimize", 1);  // cells that curved surfaces turn inside out
}

std::string GmshSession::load(const std::string& file, int dimension) const
{
  try {
    gmsh::open(file);
    if (is_geometry(file) && logged_error().empty()) {
      std::vector<std::size_t> tags;
      std::vector<double> coordinates, parameters;
      gmsh::model::mesh::getNodes(tags, coordinates, parameters);
      if (is_cad(file)) name_by_labels(dimension);
      if (tags.empty()) {
        gmsh::model::mesh::generate(dimension);
        mark_curved_surfaces(dimension);
      }
    }
  } catch (...) {
    const std::string logged = logged_error();
    return logged.empty() ? "gmsh cannot read it" : logged;
  }
  return logged_error();
}

namespace {

// Where tell_and_exit() writes.
int error_pipe = -1;

// gmsh throws strings through its own parallel loops, which ends the process: what it had to say is kept.
[[noreturn]] void tell_and_exit()
{
  std::string text = "it gave up without a word";
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::string& said) {
    text = said;
  } catch (const std::exception& said) {
    text = said.what();
  } catch (...) {
  }
  _exit(write(error_pipe, text.data(), text.size()) < 0 ? 2 : 0);
}

// Meshes a geometry in a process of its own and leaves the mesh in the file `target`, for gmsh's meshers crash on some faulty
// geometries.
void mesh_apart(const Options& options, int dimension, const std::string& target)
{
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) throw Error(ExitStatus::machine, "cannot open a pipe");
  const pid_t child = fork();
  if (child < 0) throw Error(ExitStatus::machine, "cannot start a process for gmsh");
  if (child == 0) {
    for (const int signal_number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE}) std::signal(signal_number, SIG_DFL);
    error_pipe = pipe_ends[1];
    std::set_terminate(tell_and_exit);
    const GmshSession gmsh_session(options.constants);
    GmshSession::set_sizes(options);
    std::string error = gmsh_session.load(options.file, dimension);
    if (error.empty()) {
      try {
        gmsh::option::setNumber("Mesh.Binary", 1);
        gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
        gmsh::write(target);
      } catch (...) {
        error = "gmsh cannot write " + target;
      }
    }
    if (!error.empty() && write(pipe_ends[1], error.data(), error.size()) < 0) _exit(2);
    _exit(0);
  }
  close(pipe_ends[1]);
  std::string error;
  char buffer[512];
  for (ssize_t n = 0; (n = ::read(pipe_ends[0], buffer, sizeof buffer)) > 0;) error.append(buffer, static_cast<std::size_t>(n));
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    error = "gmsh crashed while it meshed this geometry; try it in gmsh itself, with another mesh algorithm or size";
  if (!error.empty()) fail(options.file, "gmsh: " + error);
}

}  // namespace

MeshFile::MeshFile(const Options& options, int dimension)
{
  if (!std::filesystem::exists(options.file)) fail(options.file, "there is no such file");
  path_ = options.file;
  if (!is_geometry(options.file)) return;
  path_ = (std::filesystem::temp_directory_path() / fmt::format("mortise_{}.msh", getpid())).string();
  temporary_ = true;
  try {
    mesh_apart(options, dimension, path_);
  } catch (...) {
    remove();
    throw;
  }
}

void MeshFile::remove() const
{
  std::error_code ignored;
  if (temporary_) std::filesystem::remove(path_, ignored);
}

}  // namespace mortise::mesh
