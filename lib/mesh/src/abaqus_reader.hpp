// The cards of an Abaqus or CalculiX input file, and the mesh that they make; see abaqus_file.cpp.
#pragma once

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "gmsh_file.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

/// In capitals.
std::string upper(std::string text);
/// Without blanks and quotes round it.
std::string trimmed(const std::string& text);

/// One card: its name, its parameters, and the line that it stands in.
struct Card {
  std::string name;
  std::map<std::string, std::string> parameters;
  int line = 0;
  bool has(const std::string& key) const { return parameters.contains(key); }
};

class AbaqusReader {
 public:
  AbaqusReader(const Options& options, int dimension) : options_(options), dimension_(dimension) {}
  RawMesh read();

 private:
  using Numbers = std::vector<long long>;
  struct Face {
    std::string of;  // element or set
    std::string side;
    int line;
  };
  [[noreturn]] void report_error(int line, const std::string& what) const
  {
    fail(fmt::format("{}:{}", options_.file, line), what);
  }
  long long number(const std::string& word, int line) const;
  double value(const std::string& word, int line) const;
  void begin(const std::string& line);
  bool is_ours();
  void need(const char* key);
  void begin_node() const;
  void begin_surface();
  void begin_elements();
  void data(const std::string& line);
  void finish_element();
  void take_members(long long count);
  void add_to_set(std::map<std::string, Numbers>& sets, const std::vector<std::string>& words);
  const std::string& known_name(const std::string& name);
  std::vector<std::string> bodies() const;
  void add_cells(RawMesh& raw);
  void add_element_sets(RawMesh& raw) const;
  void add_surfaces(RawMesh& raw) const;
  void add_node_sets(RawMesh& raw) const;

  struct Element {
    CellType type;
    std::vector<Local> nodes;  // in our order
  };

  const Options& options_;
  int dimension_;
  int line_ = 0;
  Card card_;
  bool over_ = false;                     // at *STEP
  Numbers pending_;                       // the element that is being read
  std::optional<CellType> pending_type_;  // of the card
  std::size_t pending_nodes_ = 0;         // 0: elements of this card are left out
  std::unordered_map<long long, Local> node_;
  std::vector<Point> points_;
  std::map<long long, Element> elements_;
  std::map<std::string, Numbers> element_sets_, node_sets_, sets_of_cards_;  // the last: by ELSET= of *ELEMENT alone
  std::map<std::string, std::vector<Face>> surfaces_;
  std::vector<std::string> sections_;
  std::map<std::string, std::string> spelling_;  // names are the same in capitals
  std::set<std::string> left_out_;
  std::string open_surface_;
  long long members_ = 0, most_members_ = 0;  // of sets that lines name by ranges and by other sets
};

}  // namespace mortise::mesh
