#include "elements.hpp"

namespace mortise::fem {

Element hex8()
{
  return make_element<8, 3>(
      gauss2(3),
      multilinear(3, {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}));
}

}  // namespace mortise::fem
