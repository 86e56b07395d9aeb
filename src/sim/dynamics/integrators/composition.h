// Symmetric compositions of a symmetric method of second order: of order 4 with five stages (Suzuki 1990) and of
// order 8 with seventeen (Kahan and Li 1997, Math. Comp. 66).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tumble {

/// The lengths of the stages as shares of the step.
inline std::vector<double> composition_stages(int order) {
    // The first half and the middle stage.
    static constexpr std::array<double, 1> single{1.0};
    static constexpr std::array<double, 3> suzuki_4{0.41449077179437573714, 0.41449077179437573714,
                                                    -0.65796308717750294857};
    static constexpr std::array<double, 9> kahan_li_8{
        0.13020248308889008087881763, 0.56116298177510838456196441,  -0.38947496264484728640807860,
        0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
        0.25837438768632204729397911, 0.29501172360931029887096624,  -0.60550853383003451169892108};
    std::span<const double> half = single;
    if (order == 4) half = suzuki_4;
    if (order == 8) half = kahan_li_8;
    std::vector<double> stages(half.begin(), half.end());
    for (std::size_t k = half.size() - 1; k-- > 0;) stages.push_back(half[k]);
    return stages;
}

}  // namespace tumble
