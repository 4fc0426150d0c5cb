#include "file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "gmsh_file.hpp"
#include "script_check.hpp"

namespace mortise::mesh {

const char* const known_endings = ".msh, .geo, .step, .stp, .brep, .stl or .inp";

FileKind kind_of(const std::string& file)
{
  auto ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::map<std::string, FileKind> table{
      {".msh", FileKind::msh},   {".geo", FileKind::geo}, {".step", FileKind::step}, {".stp", FileKind::step},
      {".brep", FileKind::brep}, {".stl", FileKind::stl}, {".inp", FileKind::abaqus}};
  const auto found = table.find(ending);
  return found == table.end() ? FileKind::none : found->second;
}

bool is_cad(FileKind kind)
{
  return kind == FileKind::step || kind == FileKind::brep;
}

bool is_geometry(FileKind kind)
{
  return kind == FileKind::geo || is_cad(kind);
}

namespace {

// Up to `size` bytes from the place `at`; from the end if that is negative.
std::string piece(std::ifstream& stream, long long at, std::size_t size)
{
  stream.clear();
  stream.seekg(0, std::ios::end);
  const auto all = static_cast<long long>(stream.tellg());
  stream.seekg(at < 0 ? std::max(0LL, all + at) : at);
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

// Every shape of a .brep file ends with an asterisk, and the last line says which of them the file is about. OpenCASCADE reads on
// for ever where that is missing.
void check_brep_end(const std::string& file, std::ifstream& stream)
{
  stream.clear();
  stream.seekg(0);
  long long shapes = -1, ended = 0;
  bool root = false;
  for (std::string word; stream >> word;) {
    if (word == "TShapes") {
      if (!(stream >> shapes)) break;
      continue;
    }
    if (shapes < 0) continue;
    if (word == "*") ++ended;
    root = ended == shapes && word.size() > 1 && (word[0] == '+' || word[0] == '-');
    if (root) break;
  }
  if (shapes < 0) fail(file, "is cut off or damaged: it holds no shapes (\"TShapes\"); write it anew");
  if (!root)
    fail(file, fmt::format("is cut off or damaged: it is to hold {} shapes, of which {} are whole; write it anew", shapes,
                           std::min(ended, shapes)));
}

// gmsh reads as many lines of nodes and elements as the file says there are, and leaves out the rest without a word. Texts only:
// in binary files what follows is out of step and is noticed.
void check_msh_counts(const std::string& file, std::ifstream& stream)
{
  stream.clear();
  stream.seekg(0);
  double version = 0;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const bool format = line.starts_with("$MeshFormat"), nodes = line.starts_with("$Nodes");
    if (!format && !nodes && !line.starts_with("$Elements")) continue;
    const auto section = line.substr(0, line.find_last_not_of(" \r\t") + 1);
    if (!std::getline(stream, line)) break;
    ++number;
    std::istringstream words(line);
    if (format) {
      int binary = 0;
      words >> version >> binary;
      if (binary != 0) return;
      continue;
    }
    if (version < 2 || (version >= 3 && version < 4.1)) continue;
    long long blocks = 0, count = -1, lines = 0;
    if (version >= 4) words >> blocks;
    words >> count;
    const int first = number;
    while (std::getline(stream, line) && !line.starts_with('$')) {
      ++number;
      if (line.find_first_not_of(" \r\t") != std::string::npos) ++lines;
    }
    ++number;
    const auto expected = version >= 4 ? blocks + (nodes ? 2 : 1) * count : count;
    if (lines != expected)
      fail(file, fmt::format("line {}: {} is to have {} lines after this one, and has {}; the file is cut off or damaged", first,
                             section, expected, lines));
  }
}

// Texts end with "endsolid"; of others the length follows from the number of triangles behind each head of 80 bytes, whatever
// that says. gmsh writes several solids one behind the other.
void check_stl(const std::string& file, std::ifstream& stream)
{
  const auto length = static_cast<long long>(std::filesystem::file_size(file));
  long long place = 0, solids = 0;
  while (place + 84 <= length && solids < 10000) {
    const auto count = piece(stream, place + 80, 4);
    std::uint32_t triangles = 0;
    if (count.size() == 4) std::memcpy(&triangles, count.data(), sizeof triangles);  // little-endian, as this machine
    place += 84 + 50LL * triangles;
    ++solids;
  }
  if (solids > 0 && place == length) return;
  if (!piece(stream, 0, 5).starts_with("solid"))
    fail(file, fmt::format(
                   "is no .stl file, or it is cut off: it does not begin with \"solid\" as a text, and the numbers of triangles "
                   "in it do not fit its {} bytes; write it anew",
                   length));
  if (piece(stream, -1024, 1024).find("endsolid") == std::string::npos)
    fail(file, "is cut off: \"endsolid\" is missing at its end; write it anew");
}

void check_content(const std::string& file, std::ifstream& stream, FileKind kind)
{
  if (kind == FileKind::abaqus) return;  // our own reader says more
  const auto head = piece(stream, 0, 1024);
  if (head.empty()) fail(file, "is empty");
  const auto has = [&](const char* words) { return head.find(words) != std::string::npos; };
  if (kind == FileKind::msh && !head.starts_with("$MeshFormat") && !head.starts_with("$Comments") && !head.starts_with("$NOD"))
    fail(file, "is no .msh file: its first line must be $MeshFormat; a geometry must have the ending .geo, .step or .brep");
  if (kind == FileKind::msh) check_msh_counts(file, stream);
  if (kind == FileKind::step && !has("ISO-10303-21")) fail(file, "is no STEP file: it does not begin with ISO-10303-21");
  if (kind == FileKind::step && piece(stream, -4096, 4096).find("END-ISO-10303-21") == std::string::npos)
    fail(file, "is cut off: END-ISO-10303-21 is missing at its end; write it anew");
  if (kind == FileKind::brep && !has("CASCADE Topology V"))
    fail(file, "is no .brep file: \"CASCADE Topology V\" is missing in its head (binary ones are not understood)");
  if (kind == FileKind::brep) check_brep_end(file, stream);
  if (kind == FileKind::stl) check_stl(file, stream);
  if (kind == FileKind::geo) check_script(file, stream);
}

}  // namespace

void check_file(const std::string& file)
{
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) fail(file, "there is no such file");
  if (std::filesystem::is_directory(status)) fail(file, fmt::format("is a directory; expected a file {}", known_endings));
  if (error) fail(file, "cannot be read: " + error.message());
  if (!std::filesystem::is_regular_file(status)) fail(file, "is no file that can be read more than once");
  const auto kind = kind_of(file);
  if (kind == FileKind::none) fail(file, fmt::format("has an ending that says nothing; expected {}", known_endings));
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, fmt::format("cannot be read: {}", std::strerror(errno)));
  check_content(file, stream, kind);
}

}  // namespace mortise::mesh
