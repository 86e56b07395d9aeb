// Adaptive integration by Gauss's rule of ten points.
#pragma once

#include <array>

namespace tumble {

/// Nodes and weights on [0, 1], half of them: the others are 1 - node (Abramowitz and Stegun 1964, table 25.4).
inline constexpr std::array<double, 5> gauss_nodes{0.0130467357414141399610179939578, 0.0674683166555077446339516557883,
                                                   0.160295215850487796882836317443, 0.283302302935376404600367028417,
                                                   0.425562830509184394557586999435};
inline constexpr std::array<double, 5> gauss_weights{
    0.0333356721543440687967844049467, 0.0747256745752902965728881698288, 0.109543181257991021997767467114,
    0.134633359654998177545613460784, 0.147762112357376435086946497325};

template <class Value, class Function>
Value gauss(double from, double to, const Function& f) {
    Value sum = Value::Zero();
    const double h = to - from;
    for (std::size_t k = 0; k < gauss_nodes.size(); ++k)
        sum += gauss_weights[k] * (f(from + gauss_nodes[k] * h) + f(to - gauss_nodes[k] * h));
    return h * sum;
}

/// Halves the span until halves agree with the whole to `tolerance` in every component, `depth` times at most.
template <class Value, class Function>
Value adaptive_gauss(double from, double to, const Value& whole, double tolerance, int depth, const Function& f) {
    const double middle = 0.5 * (from + to);
    const Value low = gauss<Value>(from, middle, f), high = gauss<Value>(middle, to, f), both = low + high;
    if (depth == 0 || (both - whole).cwiseAbs().maxCoeff() <= tolerance) return both;
    return adaptive_gauss<Value>(from, middle, low, tolerance, depth - 1, f) +
           adaptive_gauss<Value>(middle, to, high, tolerance, depth - 1, f);
}

}  // namespace tumble
