#include "elements.hpp"

namespace mortise::fem {

Element quad4() { return tabulate(2, 4, gauss2(2), multilinear(2, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})); }

}  // namespace mortise::fem
