#include "elements.hpp"

namespace mortise::fem {

Element line2()
{
  return make_element<2, 1>(gauss2(1), multilinear(1, {{-1, 0, 0}, {1, 0, 0}}));
}

}  // namespace mortise::fem
