#include "elements.hpp"

namespace mortise::fem {

Element quad4()
{
  return make_element<4, 2>(gauss2(2), multilinear(2, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}));
}

}  // namespace mortise::fem
