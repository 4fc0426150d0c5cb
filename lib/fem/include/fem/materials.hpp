// What the cells of a piece of the mesh are made of: one material, or several of which each cell has one.
#pragma once

#include <utility>
#include <vector>

#include "fem/options.hpp"

namespace mortise::fem {

class Materials {
 public:
  /// One for all cells. A material stands for itself wherever materials are asked for.
  Materials(const Material& material) : materials_{material} {}
  /// materials[of_cell[c]] for cell c.
  Materials(std::vector<Material> materials, std::vector<int> of_cell)
      : materials_(std::move(materials)), of_cell_(std::move(of_cell))
  {
  }

  /// How many there are; operator[] has them.
  std::size_t count() const { return materials_.size(); }
  /// Which of them a cell is of.
  std::size_t index(std::size_t cell) const { return of_cell_.empty() ? 0 : static_cast<std::size_t>(of_cell_[cell]); }
  const Material& operator[](std::size_t index) const { return materials_[index]; }

 private:
  std::vector<Material> materials_;
  std::vector<int> of_cell_;
};

}  // namespace mortise::fem
