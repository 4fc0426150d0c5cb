#include "qp/options.hpp"
