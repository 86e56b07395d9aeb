// Splits the bodies of islands into blocks of neighbors, one thread each: large islands are cut at the median along the
// longest side of their box, recursively, until each block is small enough (k-d tree, Bentley 1975); small islands
// share a block. The cuts of an island depend on its own bodies alone.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/math/kd_split.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class BodyBlocks {
public:
    /// `most`: largest number of bodies of a block.
    explicit BodyBlocks(std::size_t most) : most_(most) {}

    void clear();
    /// Adds an island. Precondition: its bodies are ascending.
    void add(std::span<const std::uint32_t> island, const std::vector<Body>& bodies);

    /// All bodies, block by block.
    const std::vector<std::uint32_t>& order() const { return order_; }
    std::size_t size() const { return first_.size() - 1; }
    /// Position in the order where a block begins; for size(), the end.
    std::size_t first(std::size_t block) const { return first_[block]; }

private:
    void cut(std::span<PlacedBody> items);

    std::size_t most_;
    std::vector<std::uint32_t> order_;
    std::vector<std::size_t> first_{0};
    bool open_ = false;  // the last block accepts further small islands
    std::vector<PlacedBody> items_, halves_;
};

}  // namespace tumble
