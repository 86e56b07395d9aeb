// A cause of a difference between two images.
#pragma once

#include <string>

namespace tumble {

struct Cause {
    std::string text;     // "crate.17 moved by 3 px (first differing frame 41)"
    double pixels = 0.0;  // estimate of the pixels that it changes: the order of causes
};

}  // namespace tumble
