// Sets of numbers that are joined pair by pair (union-find). The root of a set is its smallest member.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tumble {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count = 0) { reset(count); }
    /// Makes each number a set of its own.
    void reset(std::size_t count) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// Makes the number a set of its own. Precondition: all members of its set become so, before the next root().
    void separate(std::size_t i) { parent_[i] = std::uint32_t(i); }
    /// Returns false if both are in one set already.
    bool join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::uint32_t(std::min(a, b));
        return a != b;
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace tumble
