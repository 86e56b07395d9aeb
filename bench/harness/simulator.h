// Interface of a program under test: a world that steps.
#pragma once

#include "harness/scene.h"

#include <cstddef>

namespace tumble::bench {

class Simulator {
public:
    virtual ~Simulator() = default;
    virtual void step() = 0;
    virtual Motion motion(std::size_t body) const = 0;  // index in the scene; for moving bodies
};

}  // namespace tumble::bench
