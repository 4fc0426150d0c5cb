#include "elements.hpp"

namespace mortise::fem {

Element hex8()
{
  return tabulate(3, 8, gauss2(3),
                  multilinear(3, {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}));
}

}  // namespace mortise::fem
