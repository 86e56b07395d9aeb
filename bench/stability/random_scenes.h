// Random scenes and the invariants of mechanics, checked after each step.
#pragma once

#include "stability/program.h"

#include <string>
#include <vector>

namespace tumble::bench {

/// Kinds of scenes; each invariant applies to some of them.
enum class Kin { pair, crowd, pit, mirror };
/// pair: two smooth bodies that meet, and no others; crowd: 3 to 10 that meet in one place, without external forces;
/// pit: 3 to 12 thrown into a walled pit; mirror: one or two in that pit, beside their mirror images.
inline constexpr const char* kin_names[] = {"pair", "crowd", "pit", "mirror"};

/// Number of scenes that violated each invariant.
struct Count {
    std::string invariant, pass_line;
    std::vector<long> failed;  // by kind
    std::vector<long> scenes;
};

/// Scenes seed = first, first + stride, ... below `last`; kind seed % 4.
std::vector<Count> run_random_scenes(const StabilityWay& way, double rate, long first, long stride, long last);

}  // namespace tumble::bench
