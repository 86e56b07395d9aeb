// Random scenes and the invariants of mechanics, looked at after each step.
#pragma once

#include "stability/program.h"

#include <string>
#include <vector>

namespace tumble::bench {

/// Which kind of scene, in which each invariant can be told.
enum class Kin { pair, crowd, pit, mirror };
/// pair: two smooth bodies that meet, nothing else; crowd: 3 to 10 that meet in one place, nothing external;
/// pit: 3 to 12 thrown into a walled pit; mirror: one or two in that pit, beside their mirror images.
inline constexpr const char* kin_names[] = {"pair", "crowd", "pit", "mirror"};

/// How many scenes failed each invariant.
struct Count {
    std::string invariant, pass_line;
    std::vector<long> failed;  // by kin
    std::vector<long> scenes;
};

/// Scenes seed = first, first + stride, ... below `last`; kind seed % 4.
std::vector<Count> run_random_scenes(const StabilityWay& way, double rate, long first, long stride, long last);

}  // namespace tumble::bench
