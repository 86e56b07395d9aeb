// A measured figure of a case.
#pragma once

#include <string>

namespace tumble::bench {

struct Quantity {
    std::string name;
    double value = 0.0;
    std::string unit;
};

}  // namespace tumble::bench
