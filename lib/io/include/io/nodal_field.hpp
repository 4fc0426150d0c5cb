// Values at the nodes of some other mesh, or at loose points, from a file of another program.
#pragma once

#include <memory>
#include <string>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise::io {

/// A scalar field, known all over the mesh or the cloud of points of its file. The same on all ranks.
class NodalField {
 public:
  /// A .vtu file: a point field of one component on cells; or a .csv file: a first line of names, x, y, z (plane models: x, y; as
  /// ParaView writes them, Points:0, Points:1, Points:2) among them, and a point a line. `name`: of the field; empty: the only
  /// one, or `temperature`. Throws Error(bad_input), with the line of a .csv, on all ranks. Collective.
  NodalField(const std::string& path, const std::string& name, int dimension, const Communicator& comm);

  /// In a cell by its shape functions, beside all cells as at the nearest place of one. Among points by a linear function that
  /// is fitted to those around x, the nearer the more (Lancaster and Salkauskas 1981): what the file says at a point of it, and
  /// exact for linear fields. Throws Error(bad_input) where x is too far away to tell.
  double operator()(const Point& x) const;

  /// How far x lies outside what the file covers, where operator() guesses: beside all cells, by more than a tenth of the nearest
  /// one; beside the box round all points, by more than a tenth of what those next to it span. Else 0.
  double outside(const Point& x) const;

  struct Content;

  std::size_t size() const;         ///< how many nodes or points the file has
  const std::string& name() const;  ///< of the field
  const std::string& path() const;  ///< of the file

 private:
  struct Source;
  std::shared_ptr<Source> source_;
};

}  // namespace mortise::io
