// What a program under test has to offer: a world that steps.
#pragma once

#include "harness/scene.h"

#include <cstddef>

namespace tumble::bench {

class Simulator {
public:
    virtual ~Simulator() = default;
    virtual void step() = 0;
    virtual Motion motion(std::size_t body) const = 0;  // by the scene's numbering; of bodies that move
};

}  // namespace tumble::bench
